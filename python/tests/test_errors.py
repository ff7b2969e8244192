"""What cannot be used is refused in words, with the cause by which programs tell errors apart."""

import os
import signal
import subprocess
import sys
import textwrap

import numpy as np
import pytest
import servoid as sv

TIME = np.arange(200) * 1e-3
VOLTS = np.where(TIME < 0.1, 5.0, -5.0)
COUNTS = np.floor(1000 * TIME)


def recording(**changes):
    columns = {"voltage": VOLTS, "counts": COUNTS, "counts_per_rev": 2048, **changes}
    return sv.Recording(columns.pop("t", TIME), **columns)


WARM = "warm: torque = -c*w*temperature; c in [0, 1] V*s/rad/degC"


def hole(column, value=np.nan):
    changed = column.copy()
    changed[7] = value
    return changed


REFUSED = [
    (lambda: recording(voltage=hole(VOLTS)), "recording", "arrays:7:2: column `command`"),
    (lambda: recording(counts=hole(COUNTS, np.inf)), "recording", "arrays:7:3: column `angle`"),
    (lambda: recording(counts=COUNTS + 0.5), "recording", "arrays:0:3: column `angle`"),
    (lambda: recording(t=TIME[::-1]), "recording", "column `time`"),
    (lambda: recording(t=TIME[:9]), "recording", "command has 200 samples, time has 9"),
    (lambda: recording(t=[], voltage=[], counts=[]), "recording", "two samples"),
    (lambda: recording(counts_per_rev=None), "recording", "counts_per_rev"),
    (lambda: recording(counts_per_rev=float("nan")), "motor", "counts_per_rev"),
    (lambda: recording(counts_per_rev=-5), "motor", "counts_per_rev"),
    (lambda: recording(time_unit="hours"), "motor", "hours"),
    (lambda: recording(known={"resistence_ohm": 1.0}), "motor", "did you mean `resistance_ohm`"),
    (lambda: recording(duty=VOLTS), "usage", "voltage and duty are given"),
    (lambda: recording(voltage=None), "usage", "give what the motor was commanded"),
    (lambda: recording(voltage="fast"), "usage", "voltage"),
    (lambda: recording(voltage=np.stack([VOLTS, VOLTS])), "usage", "shape (2, 200)"),
    (lambda: recording(enabled=VOLTS), "usage", "enabled"),
    (lambda: recording(temperature=TIME[:9]), "recording", "temperature has 9 samples, time has 200"),
    (lambda: sv.fit(recording(), effects=[WARM]), "model", "warm depends on the temperature"),
    (lambda: sv.read("nothing.csv"), "recording", "nothing.csv"),
    (lambda: sv.read("."), "recording", "folder"),
    (lambda: sv.fit(recording(), effects=["colomb"]), "usage", "did you mean `coulomb`"),
    (lambda: sv.fit(recording(), effects=["coulomb", "coulomb"]), "usage", "named twice"),
    (lambda: sv.fit(recording(), cost="money"), "usage", "known are squared"),
    (lambda: sv.fit(recording(), algorithm="luck"), "usage", "luck"),
    (lambda: sv.fit([]), "usage", "no recording"),
    (lambda: sv.fit("rec.csv"), "usage", "Recording"),
    (lambda: sv.fit(recording(counts=0 * TIME)), "recording", "it never moved"),
    (lambda: sv.diagnose([]), "usage", "no recording"),
    (lambda: sv.read("rec.csv").between(3.0, 2.0), "usage", "longer span"),
]


@pytest.mark.parametrize(("call", "cause", "said"), REFUSED, ids=[said for _, _, said in REFUSED])
def test_it_is_refused(call, cause, said):
    with pytest.raises(sv.Error) as caught:
        call()
    assert said in str(caught.value)
    assert caught.value.cause == cause
    assert isinstance(caught.value, sv.UsageError) == (cause == "usage")


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_ctrl_c_stops_with_the_best_so_far(desk):
    program = textwrap.dedent(
        """
        import signal, warnings, servoid as sv
        # A runner that was started in the background ignores the signal, and its children would, too.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        recordings = [sv.read("rec.csv"), sv.read("other.csv")]
        print("begins", flush=True)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            fit = sv.fit(recordings, effects=["coulomb", "cogging", "stribeck"], algorithm="pso", budget=10**9)
        print(fit.interrupted, fit.rms_counts > 0, "best so far" in str(said[0].message))
        """
    )
    running = subprocess.Popen([sys.executable, "-c", program], cwd=desk.folder, stdout=subprocess.PIPE, text=True)
    assert running.stdout.readline() == "begins\n"
    try:
        running.wait(timeout=2)
    except subprocess.TimeoutExpired:
        running.send_signal(signal.SIGINT)
    said, _ = running.communicate(timeout=120)
    assert said.split() == ["True", "True", "True"]
