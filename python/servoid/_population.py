"""What a batch says of all motors together: the population that they are a sample of, and motors drawn from it."""

import json
import os
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _servoid


class Population:
    """Means, spreads and correlations of motors' parameters; made by `population`, or read from what the command line wrote."""

    __slots__ = ("_document", "json")

    def __init__(self, text: str) -> None:
        #: `servoid.population/1`, as `servoid population --json` writes it.
        self.json = text
        self._document: dict[str, Any] = json.loads(text)
        if self._document.get("schema") != "servoid.population/1":
            raise _servoid.UsageError("is no servoid.population/1: give what `servoid population RESULTS --json FILE` wrote")

    @property
    def motors(self) -> int:
        """Motors that it is an estimate from."""
        return int(self._document["motors"])

    @property
    def names(self) -> list[str]:
        """The parameters that differ between motors."""
        return [member["name"] for member in self._document["parameters"]]

    @property
    def mean(self) -> dict[str, float]:
        """Mean of each parameter over the motors."""
        return {member["name"]: member["mean"]["value"] for member in self._document["parameters"]}

    @property
    def std(self) -> dict[str, float]:
        """Standard deviation of each parameter between motors, without what each estimate errs by."""
        return {member["name"]: member["std"]["value"] for member in self._document["parameters"]}

    @property
    def covariance(self) -> NDArray[np.float64]:
        """Covariance between motors, in the product of the units; in the order of `names`."""
        return np.array([[entry["value"] for entry in row] for row in self._document["covariance"]])

    def draw(self, motors: int, *, seed: int = 1) -> dict[str, NDArray[np.float64]]:
        """Draws motors: an array a parameter, of all parameters together."""
        return _servoid.draw_motors(self.json, motors, seed)

    def to_dict(self) -> dict[str, Any]:
        """The population as the JSON's dictionary."""
        return json.loads(self.json)  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        return f"<servoid.Population of {self.motors} motors: {', '.join(self.names)}>"


def population(results: str | os.PathLike[str], *, labels: str | os.PathLike[str] | None = None) -> Population:
    """The population of the motors in a folder of results, the `out` of `batch`.

    Parameters
    ----------
    labels : a CSV file with a column `unit` and any of `serial`, `lot`, `station`, `operator`, `time`.
    """
    return Population(_servoid.population(os.fspath(results), None if labels is None else os.fspath(labels)))
