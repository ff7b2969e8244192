"""A batch with an engine."""

import os
import sys
from collections.abc import Sequence
from typing import Any, Literal, get_args

from .. import _servoid
from .._batch import Done, batch
from .._servoid import Error, UsageError, __version__
from ._census import census
from ._engine import Name
from ._progress import Progress
from ._spread import spread
from ._task import Order, mark


def run(
    input: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    engine: Name = "local",
    tasks: int | None = None,
    address: str | None = None,
    workers: int | None = None,
    patience: float = 120.0,
    progress: bool = False,
    do: Literal["fit", "diagnose"] = "diagnose",
    effects: Sequence[str] = (),
    algorithm: str = "lm",
    cost: str = "squared",
    evaluations: int = 20_000,
    budget: int | None = None,
    seed: int = 1,
    force: bool = False,
    retry_errors: bool = False,
    table: str | os.PathLike[str] | None = None,
) -> Done:
    """Does a batch with an engine. `servoid.batch` says what a batch is, and explains the arguments that are not below.

    Parameters
    ----------
    engine : `"local"`, the threads of this process; `"ray"` or `"dask"`, processes of this machine or of a cluster.
    tasks : shards that the batch is cut into; not for `"local"`. If not given, a few for each CPU.
    address : a cluster of the engine. Without it Ray takes the one that this process is connected to, or that the variable
        RAY_ADDRESS names; else the engine starts one on this machine for the time of the run.
    workers : recordings that are done at a time on this machine; one a core if not given. A cluster has as many as it has CPUs.
    patience : seconds that a task waits for a shard on which another process still works.
    progress : show on stderr how far the work is.

    A shard that fails stops no other; the error names those that failed. Ctrl-C keeps what was done. Dask starts processes of its
    own: a script that asks for them needs `if __name__ == "__main__":`.
    """
    if engine not in get_args(Name):
        raise UsageError(f"engine={engine!r}: it is local, ray or dask")
    if engine == "local" and (tasks is not None or address is not None):
        raise UsageError("tasks and address are for the engines ray and dask; local does everything in this process")
    if address is not None and workers is not None:
        raise UsageError("workers is for this machine; the cluster at an address has as many as it has CPUs")
    for name, count in (("tasks", tasks), ("workers", workers)):
        if count is not None and count < 1:
            raise UsageError(f"{name}={count}: it is at least 1")
    place, folder = _absolute(input), _absolute(out)
    if not os.path.exists(place):
        raise Error(f"{place}: there is no such file or folder")
    options = {
        "do": do,
        "effects": tuple(effects),
        "algorithm": algorithm,
        "cost": cost,
        "evaluations": evaluations,
        "budget": budget,
        "seed": seed,
        "force": force,
        "retry_errors": retry_errors,
    }
    if engine == "local":
        done = _local(place, folder, workers, options, progress)
    else:
        order = Order(place, folder, mark(folder), __version__, patience, options)
        done = spread(order, engine, tasks, address, workers, progress)
    if table is not None:
        _servoid.batch_table(folder, _absolute(table))
    return done


def _absolute(path: str | os.PathLike[str]) -> str:
    return os.path.abspath(os.fspath(path))


def _local(place: str, folder: str, workers: int | None, options: dict[str, Any], progress: bool) -> Done:
    """Does everything in this process."""
    drawn = progress and sys.stderr.isatty()
    with Progress(progress, census(place)[0] if drawn else None, None) as shown:
        done = batch(place, folder, workers=workers, progress=shown.at if drawn else None, **options)
        shown.at(done.there + done.made)
    return done
