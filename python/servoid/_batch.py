"""Many recordings: each is fitted or diagnosed by itself, and its result is one row of a table."""

import os
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

from . import _servoid


@dataclass(frozen=True, slots=True)
class Done:
    """What a run of a batch did."""

    #: Recordings of its shard.
    recordings: int
    #: Results that were there before.
    there: int
    #: Results that it made.
    made: int
    #: Those of them that are errors.
    errors: int
    #: Whether it was stopped before its end.
    interrupted: bool


def batch(
    input: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    do: Literal["fit", "diagnose"] = "diagnose",
    effects: Sequence[str] = (),
    algorithm: str = "lm",
    cost: str = "squared",
    evaluations: int = 20_000,
    budget: int | None = None,
    seed: int = 1,
    force: bool = False,
    shard: str = "1/1",
    retry_errors: bool = False,
    workers: int | None = None,
    table: str | os.PathLike[str] | None = None,
    progress: Callable[[int], object] | None = None,
) -> Done:
    """Fits or diagnoses every recording of a folder of CSV files, or of a Parquet file with one row a recording.

    The results are Parquet files in the folder `out`, which any `servoid batch` of the same task goes on with: what is done is
    what is wanted less what is there.

    Parameters
    ----------
    do : what is done to each recording.
    effects, algorithm, cost, evaluations : of a fit, as `fit` has them.
    budget : steps of a model that a diagnosis takes at most, in millions; the command line's if not given.
    shard : part i of n of the recordings, as in `"2/8"`: for several processes or machines with one folder.
    retry_errors : do again what gave an error.
    workers : recordings that are done at a time; one a core if not given.
    table : a Parquet file that all results of the folder are written to, ordered by recording.
    progress : is called now and then with how many recordings have a result, those that were there before among them.

    Ctrl-C keeps what was done.
    """
    found = _servoid.batch(
        os.fspath(input),
        os.fspath(out),
        verb=do,
        effects=list(effects),
        algorithm=algorithm,
        cost=cost,
        evaluations=evaluations,
        steps=_servoid.USUAL_STEPS if budget is None else budget * 1_000_000,
        seed=seed,
        force=force,
        shard=shard,
        retry_errors=retry_errors,
        workers=workers,
        table=None if table is None else os.fspath(table),
        progress=progress,
    )
    for remark in found["remarks"]:
        warnings.warn(remark, stacklevel=2)
    return Done(
        found["recordings"], found["there"], found["made"], found["errors"], found["interrupted"]
    )
