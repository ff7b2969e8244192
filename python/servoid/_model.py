"""A model that runs again."""

import json
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _servoid
from ._recording import numbers, switches
from ._servoid import UsageError

if TYPE_CHECKING:
    import control  # type: ignore[import-untyped]


class Model:
    """A model with all its numbers: of a result, or from the file that one was written to."""

    __slots__ = ("_own",)

    def __init__(self, own: "_servoid.Model") -> None:
        self._own = own

    @classmethod
    def read(cls, path: str | PathLike[str]) -> "Model":
        """The model in the JSON file of a fit, a diagnosis, a verification or a device."""
        return cls(_servoid.Model.from_json(Path(path).read_text(encoding="utf-8")))

    @property
    def json(self) -> str:
        """The model as the `model` of results."""
        return self._own.json

    def to_dict(self) -> dict[str, Any]:
        """The same as a dictionary."""
        document: dict[str, Any] = json.loads(self._own.json)
        return document

    @property
    def effects(self) -> list[str]:
        """Effects beside the linear motor."""
        return list(self.to_dict()["effects"])

    def simulate(
        self,
        t: ArrayLike,
        command: ArrayLike,
        *,
        enabled: ArrayLike | None = None,
        counts_per_rev: float | None = None,
        start_counts: float = 0.0,
        start_speed: float = 0.0,
    ) -> NDArray[np.float64]:
        """The angle at each time, counts before the encoder rounds down.

        `command` (V; A of a drive with a current loop) holds from each time until the next. Of shape (N,), or (B, N) for B
        runs, each from the same start; the result has the same shape. The motor starts at rest unless `start_speed` (rad/s)
        is given.
        """
        time = numbers("t", t)
        commands = np.asarray(command, dtype=np.float64)
        open_too = None if enabled is None else switches("enabled", enabled)
        if commands.ndim not in (1, 2):
            raise UsageError(f"command: shape (N,) or (B, N) is wanted, not {commands.shape}")
        rows = [
            self._own.simulate(
                time,
                np.ascontiguousarray(row),
                enabled=open_too,
                counts_per_rev=counts_per_rev,
                start_counts=start_counts,
                start_speed=start_speed,
            )
            for row in np.atleast_2d(commands)
        ]
        return rows[0] if commands.ndim == 1 else np.stack(rows)

    def export(self, format: str, path: str | PathLike[str] | None = None) -> str:
        """The model in a format of `servoid export` (`c`, `rust`, `mujoco`, `modelica`, …); written to `path` if one is given."""
        text = self._own.export(format)
        if path is not None:
            Path(path).write_text(text, encoding="utf-8")
        return text

    def to_mujoco(self, path: str | PathLike[str] | None = None) -> str:
        """Joint and actuator for MuJoCo (MJCF)."""
        return self.export("mujoco", path)

    def to_control(self) -> "control.StateSpace":
        """The linear motor for python-control: from volts to speed (rad/s) and angle (rad). Effects are left out."""
        import control

        machine = self.to_dict()["machine"]
        kb, damping, inertia, lag = (
            machine[key] for key in ("kb_v_s_rad", "damping_v_s_rad", "inertia_v_s2_rad", "electrical_s")
        )
        # Winding voltage c = R·i: lag·dc/dt = u - kb·w - c and inertia·dw/dt = c - damping·w.
        if lag > 0.0:
            a = [[-1 / lag, -kb / lag, 0], [1 / inertia, -damping / inertia, 0], [0, 1, 0]]
            b = [[1 / lag], [0], [0]]
            c = [[0, 1, 0], [0, 0, 1]]
        else:
            a = [[-(kb + damping) / inertia, 0], [1, 0]]
            b = [[1 / inertia], [0]]
            c = [[1, 0], [0, 1]]
        return control.ss(a, b, c, np.zeros((2, 1)), inputs=["voltage"], outputs=["speed", "angle"])

    def __repr__(self) -> str:
        return f"<servoid.Model {', '.join(self.effects) or 'linear motor'}>"
