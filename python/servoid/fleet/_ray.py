"""Ray. It starts a task again, elsewhere if need be, when its process or its machine dies."""

import contextlib
import logging
import os
import signal
import threading
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any

from .._servoid import UsageError
from ._engine import lost, package, unexpected
from ._task import Outcome, Work

#: Memory for results of tasks, bytes: they are a few numbers.
STORE = 100_000_000
#: Times that a task is started again. A recording may kill its process each time.
AGAIN = 20


class Ray:
    """The engine."""

    def __init__(self, address: str | None, workers: int | None) -> None:
        self._ray = ray = package("ray", "ray", "ray>=2.60")
        self._under_way: dict[Any, str] = {}
        self._own = not ray.is_initialized()
        if self._own:
            where = address or os.environ.get("RAY_ADDRESS") or "local"
            settings: dict[str, Any] = {"log_to_driver": False, "logging_level": logging.ERROR}
            if where == "local":
                settings |= {"num_cpus": workers, "object_store_memory": STORE, "include_dashboard": False}
            with _terminated_as_before():
                try:
                    ray.init(address=where, **settings)
                except Exception as why:
                    raise lost("ray", why) from why
        elif address is not None:
            raise UsageError("address: this process is connected to Ray already; leave the address out, or ray.shutdown() first")
        self.cpus = max(1, int(ray.cluster_resources().get("CPU", 1)))

    def outcomes(self, work: Work, shards: Sequence[str]) -> Iterator[Outcome]:
        task = self._ray.remote(num_cpus=1, max_retries=AGAIN)(_do)
        waiting = deque(shards)
        # What is submitted cannot be taken back (`stop`): in a session that goes on after us, no task waits there for a CPU.
        most = len(shards) if self._own else self.cpus
        while waiting or self._under_way:
            while waiting and len(self._under_way) < most:
                name = waiting.popleft()
                self._under_way[task.options(name=f"servoid {name}").remote(work, name)] = name
            ended, _ = self._ray.wait(list(self._under_way), num_returns=1)
            for one in ended:
                yield self._take(one)

    def _take(self, one: Any) -> Outcome:
        name = self._under_way.pop(one)
        try:
            outcome: Outcome = self._ray.get(one)
            return outcome
        except Exception as why:
            return unexpected(name, getattr(why, "cause", None) or why)

    def stop(self) -> None:
        # Ray 2.60 aborts this process where a task ends just as it is cancelled (a race like that of its pull request 54798), so
        # none is. With a session of ours its workers end; in another one, a shard that has begun goes on to its end.
        self._under_way.clear()

    def close(self) -> None:
        if self._own:
            self._ray.shutdown()


def _do(work: Work, name: str) -> Outcome:
    return work(name)


@contextlib.contextmanager
def _terminated_as_before() -> Iterator[None]:
    """Puts back the handler of SIGTERM, which Ray replaces."""
    before = signal.getsignal(signal.SIGTERM)
    yield
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, before)
