"""Dask. It starts a task again, elsewhere if need be, when its process or its machine dies, or when it raised."""

import contextlib
import importlib
import logging
import os
import signal
from collections.abc import Iterator, Sequence
from multiprocessing import resource_tracker
from typing import Any

from ._engine import lost, package, unexpected
from ._task import Outcome, Work

#: Workers that may die at a task before Dask gives the task up. The scheduler sets it, so it counts for one that starts here.
LOST = 100
#: Times that a task which raised is tried again.
AGAIN = 3
#: Seconds that it has to end what was interrupted.
ENDING = 15.0


class Dask:
    """The engine."""

    def __init__(self, address: str | None, workers: int | None) -> None:
        self._distributed = distributed = package("dask", "distributed", "distributed>=2026.8")
        self._under_way: dict[Any, str] = {}
        self._cluster: Any = None
        try:
            if address is None:
                importlib.import_module("dask").config.set({"distributed.scheduler.allowed-failures": LOST})
                with _uninterrupted():
                    self._cluster = distributed.LocalCluster(
                        n_workers=workers or os.cpu_count() or 1,
                        threads_per_worker=1,
                        processes=True,
                        dashboard_address=None,
                        silence_logs=logging.CRITICAL,
                    )
            self._client = distributed.Client(address or self._cluster)
        except Exception as why:
            raise lost("dask", why) from why
        self.cpus = max(1, sum(self._client.nthreads().values()))

    def outcomes(self, work: Work, shards: Sequence[str]) -> Iterator[Outcome]:
        for name in shards:
            self._under_way[self._client.submit(work, name, pure=False, retries=AGAIN)] = name
        for one in self._distributed.as_completed(list(self._under_way)):
            yield self._take(one)

    def _take(self, one: Any) -> Outcome:
        name = self._under_way.pop(one)
        try:
            outcome: Outcome = one.result()
            return outcome
        except Exception as why:
            return unexpected(name, why)

    def stop(self) -> None:
        # A thread that computes cannot be stopped: on a cluster that is not ours, a shard that has begun goes on to its end.
        self._client.cancel(list(self._under_way))

    def close(self) -> None:
        with contextlib.suppress(TimeoutError):
            self._client.close(timeout=ENDING)
            if self._cluster is not None:
                self._cluster.close(timeout=ENDING)


@contextlib.contextmanager
def _uninterrupted() -> Iterator[None]:
    """A terminal sends Ctrl-C to every process: those that start herein leave it to this one."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    # Python starts it with the first process, and then lets the signal in again.
    resource_tracker.ensure_running()
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
