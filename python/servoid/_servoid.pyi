"""What is compiled. Use the package `servoid`; this is what it is made of."""

from collections.abc import Callable
from os import PathLike

from typing import TypedDict

import numpy as np
from numpy.typing import NDArray

EFFECTS: list[str]
#: Steps of a model that a diagnosis takes at most.
USUAL_STEPS: int
__version__: str

class Error(Exception):
    """Something that servoid could not do, with the remedy."""

    #: The word by which programs tell errors apart.
    cause: str

class UsageError(Error):
    """An argument that cannot be used."""

class BatchDone(TypedDict):
    recordings: int
    there: int
    made: int
    errors: int
    interrupted: bool
    remarks: list[str]

class Recording:
    def __init__(
        self,
        time: NDArray[np.float64],
        command: NDArray[np.float64],
        angle: NDArray[np.float64],
        *,
        current: NDArray[np.float64] | None = None,
        temperature: NDArray[np.float64] | None = None,
        supply: NDArray[np.float64] | None = None,
        enabled: NDArray[np.bool_] | None = None,
        motor: str | None = None,
        source: str = "arrays",
    ) -> None: ...
    @property
    def time(self) -> NDArray[np.float64]: ...
    @property
    def command(self) -> NDArray[np.float64]: ...
    @property
    def counts(self) -> NDArray[np.float64]: ...
    @property
    def counts_per_rev(self) -> float: ...
    @property
    def source(self) -> str: ...
    @property
    def remarks(self) -> list[str]: ...
    @property
    def motor(self) -> str | None: ...
    def between(self, start_s: float, end_s: float) -> Recording: ...
    def __len__(self) -> int: ...

def read(
    path: str | PathLike[str], *, motor_file: str | PathLike[str] | None = None, motor: str | None = None
) -> Recording: ...

class Model:
    @staticmethod
    def from_json(json: str) -> Model: ...
    @property
    def json(self) -> str: ...
    @property
    def counts_per_rev(self) -> float | None: ...
    def simulate(
        self,
        time: NDArray[np.float64],
        command: NDArray[np.float64],
        *,
        enabled: NDArray[np.bool_] | None = None,
        counts_per_rev: float | None = None,
        start_counts: float = 0.0,
        start_speed: float = 0.0,
    ) -> NDArray[np.float64]: ...
    def export(self, format: str) -> str: ...

class Fit:
    @property
    def json(self) -> str: ...
    @property
    def remarks(self) -> list[str]: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def model(self) -> Model: ...
    def summary(self) -> str: ...
    def residual(self) -> NDArray[np.float64]: ...
    def drawing(self) -> str: ...
    def page(self) -> str: ...

def fit(
    recordings: list[Recording],
    *,
    effects: list[str],
    validate: list[Recording],
    known: str | None,
    algorithm: str,
    cost: str,
    seed: int,
    budget: int,
    own: list[str],
    certificate: bool,
    profile: bool,
    force: bool,
) -> Fit: ...

class Diagnosis:
    @property
    def json(self) -> str: ...
    @property
    def interrupted(self) -> bool: ...
    @property
    def model(self) -> Model: ...
    def summary(self) -> str: ...
    def page(self) -> str: ...

def diagnose(
    recordings: list[Recording],
    *,
    validate: list[Recording],
    known: str | None,
    laws: list[str],
    discover: bool,
    seed: int,
    steps: int | None,
    force: bool,
) -> Diagnosis: ...

def batch(
    input: str,
    out: str,
    *,
    verb: str,
    effects: list[str],
    algorithm: str,
    cost: str,
    evaluations: int,
    steps: int,
    seed: int,
    force: bool,
    shard: str,
    retry_errors: bool,
    workers: int | None,
    table: str | None,
    progress: Callable[[int], object] | None,
) -> BatchDone: ...
def fleet(results: str, labels: str | None) -> tuple[str, str]: ...
def population(results: str, labels: str | None) -> str: ...
def draw_motors(population: str, count: int, seed: int) -> dict[str, NDArray[np.float64]]: ...
def batch_table(out: str, table: str) -> None: ...
