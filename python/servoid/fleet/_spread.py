"""Work as the tasks of an engine."""

import os
import warnings
from collections.abc import Callable, Sequence

from .._batch import Done
from .._servoid import Error, UsageError
from ._census import census, usual_tasks
from ._engine import Name, lost, named
from ._progress import Progress
from ._task import Order, Outcome, Work


def spread(order: Order, engine: Name, tasks: int | None, address: str | None, workers: int | None, progress: bool) -> Done:
    """Does every shard of a batch with an engine."""
    total, groups = census(order.input)
    damaged = _damaged(order.out)

    def shards(cpus: int) -> list[str]:
        count = tasks or usual_tasks(cpus, total, groups)
        return [f"{index}/{count}" for index in range(1, count + 1)]

    done = spread_shards(order, shards, engine, address, workers, Progress(progress, total, None))
    for path in sorted(_damaged(order.out) - damaged):
        warnings.warn(f"{path}: this part of the results was damaged and is put aside; its recordings are done again", stacklevel=3)
    return done


def spread_shards(
    work: Work,
    shards_of: Callable[[int], Sequence[str]],
    engine: Name,
    address: str | None,
    workers: int | None,
    progress: Progress,
) -> Done:
    """Does the shards, of which there may be more the more CPUs the engine has."""
    held = named(engine)(address, workers)
    ended: list[Outcome] = []
    interrupted = False
    try:
        shards = shards_of(held.cpus)
        count = len(shards)
        with progress.over(count) as shown:
            try:
                for outcome in held.outcomes(work, shards):
                    ended.append(outcome)
                    shown.at(sum(_recordings(one) for one in ended), len(ended))
            except KeyboardInterrupt:
                interrupted = True
                held.stop()
            except Exception as why:
                raise lost(engine, why) from why
    finally:
        held.close()
    # Ctrl-C ends tasks, too; those did not fail.
    failed = [one for one in ended if one.done is None and not (interrupted and one.cause == "engine")]
    if failed and interrupted:
        warnings.warn(str(_failure(failed, count)), stacklevel=3)
    elif failed:
        raise _failure(failed, count)
    done = [one.done for one in ended if one.done is not None]
    return Done(
        sum(one.recordings for one in done),
        sum(one.there for one in done),
        sum(one.made for one in done),
        sum(one.errors for one in done),
        interrupted or any(one.interrupted for one in done),
    )


def _recordings(one: Outcome) -> int:
    """Recordings of a shard that have a result."""
    return one.done.there + one.done.made if one.done else 0


def _damaged(out: str) -> set[str]:
    """Parts of the results that were found damaged."""
    parts = os.path.join(out, "parts")
    names = os.listdir(parts) if os.path.isdir(parts) else []
    return {os.path.join(parts, name) for name in names if name.endswith(".damaged")}


def _failure(failed: Sequence[Outcome], count: int) -> Error:
    """The errors of shards as one."""
    said: dict[str, list[str]] = {}
    for one in failed:
        said.setdefault(one.message, []).append(one.shard)
    if len(said) == 1 and len(failed) == count:
        text = failed[0].message
    else:
        some = [f"shard {_several(shards)}: {message}" for message, shards in list(said.items())[:3]]
        if len(said) > len(some):
            some.append(f"and {len(said) - len(some)} more messages")
        text = f"{len(failed)} of {count} shards failed; what the others made is kept.\n" + "\n".join(some)
    causes = {one.cause for one in failed}
    error = UsageError(text) if causes == {"usage"} else Error(text)
    error.cause = causes.pop() if len(causes) == 1 else "failed"
    return error


def _several(names: Sequence[str]) -> str:
    return ", ".join(names) if len(names) < 4 else f"{', '.join(names[:2])} and {len(names) - 2} more"
