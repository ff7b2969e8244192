"""What an engine is, and how one is found."""

import importlib
from collections.abc import Iterator, Sequence
from typing import Any, Literal, Protocol

from .._servoid import Error, UsageError
from ._task import Outcome, Work

Name = Literal["local", "ray", "dask"]


class Engine(Protocol):
    """Runs tasks."""

    #: Tasks that it runs at a time.
    cpus: int

    def __init__(self, address: str | None, workers: int | None) -> None: ...

    def outcomes(self, work: Work, shards: Sequence[str]) -> Iterator[Outcome]:
        """Does the shards; says how each ended, as it ends."""

    def stop(self) -> None:
        """Lets nothing more begin; what is under way ends as soon as the engine can end it."""

    def close(self) -> None: ...


def named(name: Name) -> type[Engine]:
    """The engine of this name; imports no other."""
    if name == "ray":
        from ._ray import Ray

        return Ray
    from ._dask import Dask

    return Dask


def package(engine: Name, module: str, wanted: str) -> Any:
    """Imports the package of an engine."""
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as missing:
        if missing.name != module:
            raise
        error = UsageError(f'engine {engine}: the package {module} is not installed; pip install "{wanted}"')
        error.cause = "engine"
        raise error from None


def lost(engine: Name, why: BaseException) -> Error:
    """The error of an engine that does not start, or that fails."""
    first = next(iter(str(why).strip().splitlines()), "")
    error = Error(f"engine {engine}: {type(why).__name__}: {first}")
    error.cause = "engine"
    return error


def unexpected(shard: str, why: BaseException) -> Outcome:
    """The outcome of a task that failed otherwise than by an error of servoid."""
    last = next(reversed(str(why).strip().splitlines()), "")
    return Outcome(shard, None, "engine", f"{type(why).__name__}: {last}")
