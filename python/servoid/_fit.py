"""A model fitted to recordings."""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _servoid
from ._motor import Facts, known_toml
from ._recording import Recording, several, some
from ._result import Result


@dataclass(frozen=True, slots=True)
class Parameter:
    """A number of a model and how well it is known."""

    name: str
    value: float | None
    #: Its standard error; None where the recordings do not determine it.
    std: float | None
    unit: str
    identifiable: bool


class Fit(Result["_servoid.Fit"]):
    """A fitted model; made by `fit`."""

    __slots__ = ()

    @property
    def params(self) -> dict[str, Parameter]:
        """The parameters by their names, as in `fit.params["coulomb.torque"]`."""
        return parameters(self._document["parameters"])

    @property
    def effects(self) -> list[str]:
        """Effects beside the linear motor."""
        return list(self._document["effects"])

    @property
    def rms_counts(self) -> float:
        """RMS of model less reading over the fitted recordings, free run, counts."""
        return float(self._document["rms_counts"])

    @property
    def validate_rms_counts(self) -> float | None:
        """The same on what was not fitted."""
        found = self._document["validate_rms_counts"]
        return None if found is None else float(found)

    @property
    def notes(self) -> list[str]:
        """What a user should know of the fit and of the recordings."""
        return [*self._own.remarks, *self._document["notes"]]

    def residual(self) -> NDArray[np.float64]:
        """Model less reading over the fitted recordings, counts, one a sample."""
        return self._own.residual()

    @property
    def covariance(self) -> tuple[list[str], NDArray[np.float64]]:
        """Names of the searched parameters that the recordings determine, and their covariance: torques in volts."""
        joint = self._joint()
        return list(joint["names"]), np.array(joint["covariance"])

    def to_inference_data(self, draws: int = 1000, *, seed: int = 1) -> Any:
        """The searched parameters as draws of the normal distribution around the fit, for arviz.

        One chain: the draws are independent. Torques are in volts, as in `covariance`.
        """
        joint = self._joint()
        random = np.random.default_rng(seed)
        drawn = random.multivariate_normal(joint["values"], np.array(joint["covariance"]), draws)
        posterior = {name: drawn[np.newaxis, :, k] for k, name in enumerate(joint["names"])}
        try:
            arviz = importlib.import_module("arviz")
        except ImportError as missing:
            raise ImportError("to_inference_data needs arviz: pip install arviz") from missing
        # What groups are called changed with version 1.
        if int(arviz.__version__.split(".")[0]) >= 1:
            return arviz.from_dict({"posterior": posterior})
        return arviz.from_dict(posterior=posterior)

    def _joint(self) -> dict[str, Any]:
        joint: dict[str, Any] | None = self._document.get("joint")
        if joint is None:
            raise _servoid.Error("this fit has no covariance: its search has not converged, or nothing is determined (see notes)")
        return joint

    def plot(self) -> "Drawing":
        """Measured against model, as a drawing that a notebook shows."""
        return Drawing(self._own.drawing())

    def __repr__(self) -> str:
        effects = ", ".join(self.effects) or "linear motor"
        return f"<servoid.Fit {effects}: {self.rms_counts:.4g} counts RMS>"


class Drawing(str):
    """A drawing as SVG text."""

    __slots__ = ()

    def _repr_svg_(self) -> str:
        return str(self)


def parameters(entries: Sequence[dict[str, Any]]) -> dict[str, Parameter]:
    """Parameters of a result by their names."""
    return {
        entry["name"]: Parameter(entry["name"], entry["value"], entry["std"], entry["unit"], entry["identifiable"])
        for entry in entries
    }


def fit(
    recordings: Recording | Sequence[Recording],
    *,
    effects: Sequence[str] = (),
    validate: Recording | Sequence[Recording] | None = None,
    known: Facts | None = None,
    algorithm: str = "lm",
    cost: str = "squared",
    seed: int = 1,
    budget: int = 20_000,
    own: Sequence[str] = (),
    certificate: bool = False,
    profile: bool = False,
    force: bool = False,
) -> Fit:
    """Fits a model to one recording, or to several of one motor.

    Parameters
    ----------
    effects : physical effects beside the linear motor, names of `servoid.EFFECTS`, or laws of your own as in
        `"drag: torque = -c*w*abs(w); c in [0, 1e-3] V*s^2/rad^2"`.
    validate : recordings of the same motor that are scored and never fitted.
    known : facts about the motor, see `Recording`; without them those of the first recording.
    algorithm, cost, seed, budget : as `servoid fit` has them: search method, what is minimised, seed, model evaluations at most.
    own : parameters that each of several recordings has for itself, as in `["offset_voltage.voltage"]`.
    certificate : say whether one model reproduces every reading.
    profile : hold each parameter at other values and fit the rest.
    force : fit recordings that `servoid check` refuses.

    Ctrl-C stops the search: the result is the best so far, with a warning.
    """
    return Fit(
        _servoid.fit(
            some(recordings),
            effects=list(effects),
            validate=several(validate),
            known=known_toml(known),
            algorithm=algorithm,
            cost=cost,
            seed=seed,
            budget=budget,
            own=list(own),
            certificate=certificate,
            profile=profile,
            force=force,
        )
    )
