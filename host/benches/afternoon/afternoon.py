"""What an engineer writes in an afternoon: a linear motor with Coulomb friction, offset and delay by least squares.

The model, per volt of drive (u = command, f = offset, c = Coulomb friction, T = delay):

    a dv/dt = u(t - T) + f - b v - c sign(v),    dq/dt = v

stepped exactly between samples; a motor that stops within a step rests where friction holds it. `fit` minimises the errors of
free runs over windows of half a second, each started from the smoothed angle and speed.

    python afternoon.py fitted.csv [held_out.csv] [--window 0.5] [--counts-per-rev N]

reads `motor.toml` beside the first recording, and prints JSON: parameters, and errors in counts RMS on both recordings, in windows
and over the whole run (with the best start angle, as `servoid` scores it).
"""

import argparse
import json
import pathlib
import tomllib

import numpy as np
from scipy.optimize import least_squares
from scipy.signal import butter, filtfilt

SMOOTHING_HZ = 30.0
TERMS = ("a", "b", "c", "offset", "delay")


class Recording:
    """Time in s, command in V, angle in rad, and the angle smoothed with its speed."""

    def __init__(self, path, facts, part=(0.0, 1.0)):
        path = pathlib.Path(path)
        header = path.open().readline().strip().split(",")
        table = np.genfromtxt(path, delimiter=",", skip_header=1)
        begin, end = (int(p * len(table)) for p in part)
        table = table[begin:end]
        columns = facts.get("columns", {})

        def column(what, guesses):
            names = [columns[what]] if what in columns else guesses
            return next(table[:, header.index(name)] for name in names if name in header)

        self.time = column("time", ["t_s"])
        self.command = column("voltage", ["voltage_V"])
        # The count that a row has was there at its time; a command holds until the next row.
        self.angle = column("angle", ["angle_rad", "angle_rad_derived"])
        self.step = np.diff(self.time)
        self.counts_per_rad = facts["counts_per_rev"] / (2 * np.pi)
        even = np.arange(self.time[0], self.time[-1], np.median(self.step))
        b, a = butter(4, min(SMOOTHING_HZ * 2 * np.median(self.step), 0.9))
        smooth = filtfilt(b, a, np.interp(even, self.time, self.angle))
        self.smooth = np.interp(self.time, even, smooth)
        self.speed = np.interp(self.time, even, np.gradient(smooth, even[1] - even[0]))
        if np.ptp(self.angle[:5]) == 0:
            self.speed[0] = 0.0
        self.integral = np.concatenate(([0.0], np.cumsum(self.command[:-1] * self.step)))

    def delayed(self, delay):
        """The mean of the delayed command over each step."""
        when = self.time - delay
        before = (when - self.time[0]) * self.command[0]
        integral = np.where(when < self.time[0], before, np.interp(when, self.time, self.integral))
        return np.diff(integral) / self.step

    def windows(self, length):
        """First samples of the windows; one window where there is no length."""
        if length is None:
            return np.array([0])
        starts = np.searchsorted(self.time, np.arange(self.time[0], self.time[-1] - 0.5 * length, length) - 1e-9)
        return np.unique(starts)


def step(q, v, drive, h, a, b, c):
    """One exact step of all windows: slides, may stop, and rests or slides the other way for what is left."""
    tau = a / b
    left = np.full_like(q, h)
    for _ in range(2):
        resting = (v == 0.0) & (np.abs(drive) <= c)
        way = np.where(v != 0.0, np.sign(v), np.sign(drive))
        final = (drive - c * way) / b
        end = final + (v - final) * np.exp(-left / tau)
        stops = (v != 0.0) & (end * way < 0.0)
        ratio = np.where(stops, (v - final) / np.where(final == 0.0, 1.0, -final), 1.0)
        span = np.where(stops, np.minimum(tau * np.log(np.maximum(ratio, 1.0)), left), left)
        span = np.where(resting, left, span)
        decay = np.exp(-span / tau)
        q = np.where(resting, q, q + final * span + (v - final) * tau * (1.0 - decay))
        v = np.where(resting | stops, 0.0, final + (v - final) * decay)
        left = left - span
    return q, v


def errors(recording, parameters, window):
    """Model minus reading, counts, of free runs over windows."""
    a, b, c, offset, delay = (parameters[name] for name in TERMS)
    drive = recording.delayed(delay) + offset
    starts = recording.windows(window)
    ends = np.append(starts[1:], len(recording.time))
    out = np.zeros(len(recording.time))
    at = starts.copy()
    whole = window is None
    q = (recording.angle if whole else recording.smooth)[at].copy()
    v = recording.speed[at].copy()
    live = np.arange(len(starts))
    while len(live):
        out[at[live]] = q[live] - recording.angle[at[live]]
        live = live[at[live] + 1 < ends[live]]
        here = at[live]
        q[live], v[live] = step(q[live], v[live], drive[here], recording.step[here], a, b, c)
        at[live] += 1
    return np.nan_to_num(out * recording.counts_per_rad, nan=1e9, posinf=1e9, neginf=-1e9)


def rms(error, free_start):
    return float(np.sqrt(np.mean((error - (np.mean(error) if free_start else 0.0)) ** 2)))


def parameters(x, scale):
    a, b, c, offset, delay = x
    return {
        "a": scale["a"] * np.exp(np.clip(a, -20, 20)),
        "b": scale["b"] * np.exp(np.clip(b, -20, 20)),
        "c": scale["volts"] * abs(c),
        "offset": scale["volts"] * offset,
        "delay": 1e-2 * min(abs(delay), 20.0),
    }


def fit(recordings, window):
    """Least squares over all recordings from several starts; the best."""
    volts = max(np.max(np.abs(r.command)) for r in recordings)
    speed = max(np.max(np.abs(r.speed)) for r in recordings)
    best = None
    for tau in (0.02, 0.1, 0.4):
        scale = {"a": tau * volts / speed, "b": volts / speed, "volts": 0.05 * volts}

        def residuals(x):
            found = parameters(x, scale)
            return np.concatenate([np.clip(errors(r, found, window), -1e8, 1e8) for r in recordings])

        start = [0.0, 0.0, 1.0, 0.0, 0.2]
        result = least_squares(residuals, start, diff_step=1e-3, x_scale=[0.1, 0.1, 1.0, 0.5, 0.2], max_nfev=40)
        if best is None or result.cost < best[0]:
            best = (result.cost, parameters(result.x, scale))
    return best[1]


def facts_of(path, counts_per_rev):
    toml = pathlib.Path(path).parent / "motor.toml"
    facts = tomllib.loads(toml.read_text()) if toml.exists() else {}
    if counts_per_rev:
        facts["counts_per_rev"] = counts_per_rev
    return facts


def compare(fitted, held_out, window, facts):
    """Fits the first, judges by the second."""
    if held_out is None:
        first, second = Recording(fitted, facts, (0.0, 0.75)), Recording(fitted, facts, (0.75, 1.0))
    else:
        first, second = Recording(fitted, facts), Recording(held_out, facts)
    found = fit([first], window)
    return {
        "parameters": found,
        "fitted": {"windowed": rms(errors(first, found, window), False), "whole": rms(errors(first, found, None), True)},
        "held_out": {"windowed": rms(errors(second, found, window), False), "whole": rms(errors(second, found, None), True)},
    }


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("fitted")
    options.add_argument("held_out", nargs="?", help="else the last quarter of the first")
    options.add_argument("--window", type=float, default=0.5, help="length of a window, s")
    options.add_argument("--counts-per-rev", type=float)
    given = options.parse_args()
    facts = facts_of(given.fitted, given.counts_per_rev)
    print(json.dumps(compare(given.fitted, given.held_out, given.window, facts), indent=1))


if __name__ == "__main__":
    main()
