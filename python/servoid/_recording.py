"""A recording, from arrays or from a file."""

from collections.abc import Sequence
from os import PathLike
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _servoid
from ._motor import Facts, motor_toml
from ._servoid import UsageError


class Recording:
    """What a motor was commanded, what its encoder read, and what is known of the motor.

    Parameters
    ----------
    t : times of the samples, s (`time_unit`: "s", "ms", "us"); they must increase.
    voltage : armature voltage from each time until the next, V; or `duty`, a share of `supply_v`; or `current_command`, A, of
        a drive that closes a current loop. One of the three.
    counts : the encoder's counter as read: whole, rounded down, cumulative; or `angle`, in `angle_unit` ("rad", "deg", "rev").
    current : armature current, A.
    temperature : temperature of the motor, °C; NaN where a sample does not tell it.
    enabled : False while the bridge is open and the motor coasts.
    counts_per_rev : counts per revolution of the encoder, all edges counted.
    supply_v : supply voltage, V; or as measured, one a sample: then a `duty` is a share of that.
    known : facts about the motor, as in `{"resistance_ohm": (1.2, 0.05), "kt_equals_kb": True}`; a pair is a value and its
        relative tolerance.
    name : the motor's name.

    Columns are numpy arrays, pandas or polars series, or lists; they are copied once, into double precision.
    """

    __slots__ = ("_own",)

    def __init__(
        self,
        t: ArrayLike,
        *,
        voltage: ArrayLike | None = None,
        duty: ArrayLike | None = None,
        current_command: ArrayLike | None = None,
        counts: ArrayLike | None = None,
        angle: ArrayLike | None = None,
        angle_unit: str = "rad",
        current: ArrayLike | None = None,
        temperature: ArrayLike | None = None,
        enabled: ArrayLike | None = None,
        counts_per_rev: float | None = None,
        supply_v: float | ArrayLike | None = None,
        time_unit: str = "s",
        known: Facts | None = None,
        name: str | None = None,
        source: str = "arrays",
    ) -> None:
        commanded, (command, unit) = _one_of(
            "what the motor was commanded",
            {"voltage": (voltage, "V"), "duty": (duty, "duty"), "current_command": (current_command, "A")},
        )
        sensed, (read, angle_unit) = _one_of(
            "what the encoder read", {"counts": (counts, "counts"), "angle": (angle, angle_unit)}
        )
        measured = supply_v is not None and np.ndim(supply_v) > 0
        motor = motor_toml(
            name=name,
            counts_per_rev=counts_per_rev,
            supply_v=None if measured else cast("float | None", supply_v),
            units={"time": time_unit, "voltage": unit, "angle": angle_unit},
            drive="current" if unit == "A" else "voltage",
            known=known,
        )
        self._own = _servoid.Recording(
            numbers("t", t),
            numbers(commanded, command),
            numbers(sensed, read),
            current=None if current is None else numbers("current", current),
            temperature=None if temperature is None else numbers("temperature", temperature),
            supply=numbers("supply_v", supply_v) if measured else None,
            enabled=None if enabled is None else switches("enabled", enabled),
            motor=motor,
            source=source,
        )

    @classmethod
    def _of(cls, own: "_servoid.Recording") -> "Recording":
        made = cls.__new__(cls)
        made._own = own
        return made

    @property
    def t(self) -> NDArray[np.float64]:
        """Times, s."""
        return self._own.time

    @property
    def command(self) -> NDArray[np.float64]:
        """Commands, V (A of a drive with a current loop)."""
        return self._own.command

    @property
    def counts(self) -> NDArray[np.float64]:
        """Readings, counts."""
        return self._own.counts

    @property
    def counts_per_rev(self) -> float:
        """Counts per revolution of the encoder."""
        return self._own.counts_per_rev

    @property
    def source(self) -> str:
        """The file that it was read from, or what it was called."""
        return self._own.source

    @property
    def remarks(self) -> list[str]:
        """What its reader took, repaired or left out, a sentence each."""
        return self._own.remarks

    @property
    def motor(self) -> str | None:
        """The motor's name, if its owner gave one."""
        return self._own.motor

    def between(self, start_s: float, end_s: float) -> "Recording":
        """The part from one time to another, s after the first sample."""
        return Recording._of(self._own.between(start_s, end_s))

    def __len__(self) -> int:
        return len(self._own)

    def __repr__(self) -> str:
        return repr(self._own)


def read(path: str | PathLike[str], *, motor: str | PathLike[str] | None = None) -> Recording:
    """Reads a log of any format that `servoid open` knows, with the `motor.toml` that lies beside it unless `motor` names another."""
    return Recording._of(_servoid.read(path, motor_file=motor))


def some(recordings: Recording | Sequence[Recording]) -> list["_servoid.Recording"]:
    """One recording or several as a list, one at least."""
    listed = several(recordings)
    if not listed:
        raise UsageError("no recording is given to fit")
    return listed


def several(recordings: Recording | Sequence[Recording] | None) -> list["_servoid.Recording"]:
    """One recording, several or none as a list."""
    if recordings is None:
        return []
    listed = [recordings] if isinstance(recordings, Recording) else list(recordings)
    for one in listed:
        if not isinstance(one, Recording):
            raise UsageError(f"a servoid.Recording is wanted, not {type(one).__name__}; make it with Recording(...) or read(...)")
    return [one._own for one in listed]


def numbers(name: str, values: Any) -> NDArray[np.float64]:
    """A column as a row of doubles."""
    try:
        column = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise UsageError(f"{name}: a column of numbers is wanted: {error}") from None
    if column.ndim != 1:
        raise UsageError(f"{name}: one number a sample is wanted, not an array of shape {column.shape}")
    return column


def switches(name: str, values: Any) -> NDArray[np.bool_]:
    """A column as a row of switches."""
    column = np.asarray(values)
    if column.ndim != 1 or not np.isin(column, (0, 1)).all():
        raise UsageError(f"{name}: one of 0, 1, False and True a sample is wanted")
    return np.ascontiguousarray(column, dtype=np.bool_)


def _one_of(what: str, choices: dict[str, tuple[Any, str]]) -> tuple[str, tuple[Any, str]]:
    given = [name for name, (values, _) in choices.items() if values is not None]
    if len(given) != 1:
        names = ", ".join(f"{name}=" for name in choices)
        raise UsageError(f"give {what} by one of {names}" + (f"; {' and '.join(given)} are given" if given else ""))
    return given[0], choices[given[0]]
