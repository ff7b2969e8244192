"""A task: one shard of the work, in a process of an engine."""

import contextlib
import os
import tempfile
import time
import uuid
from dataclasses import dataclass
from typing import Any, Protocol

from .._batch import Done, batch
from .._servoid import Error, __version__

#: File in the folder of results by which a task sees that it has the same folder.
MARK = "fleet-id"


class Work(Protocol):
    """Work that is cut into shards. It goes to the processes of an engine, and does one shard at a time there."""

    @property
    def out(self) -> str:
        """Folder of the results."""

    def __call__(self, name: str) -> "Outcome":
        """Does a shard."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """How a shard ended. It carries an error of servoid as text: if the task raised it, the engine would try again."""

    shard: str
    done: Done | None = None
    cause: str = ""
    message: str = ""


@dataclass(frozen=True, slots=True)
class Order:
    """A batch: what every task of it is told."""

    input: str
    out: str
    mark: str
    version: str
    patience: float
    options: dict[str, Any]

    def __call__(self, name: str) -> Outcome:
        """Does a shard."""
        try:
            check_place(self.out, self.mark, self.version)
            return Outcome(name, _patiently(self, name))
        except Error as error:
            return Outcome(name, None, error.cause, str(error))


def mark(out: str) -> str:
    """The folder's mark. Makes it if need be; if two runs do so at once, both get the same."""
    os.makedirs(out, exist_ok=True)
    path = os.path.join(out, MARK)
    if not os.path.exists(path):
        handle, own = tempfile.mkstemp(dir=out, prefix=MARK)
        with os.fdopen(handle, "w", encoding="ascii") as file:
            file.write(uuid.uuid4().hex)
        os.chmod(own, 0o644)
        with contextlib.suppress(FileExistsError):
            os.link(own, path)
        os.unlink(own)
    with open(path, encoding="ascii") as file:
        return file.read()


def check_place(out: str, mark: str, version: str) -> None:
    """This machine must have the version and the folder of whoever started the run. Results of other versions have other names."""
    node = os.uname().nodename if hasattr(os, "uname") else "this machine"
    if version != __version__:
        raise Error(f"{node} has servoid {__version__}, whoever started the run {version}; install one version everywhere")
    try:
        with open(os.path.join(out, MARK), encoding="ascii") as file:
            found = file.read()
    except OSError:
        found = ""
    if found != mark:
        raise Error(f"{out}: {node} sees another folder here, or none; results must be on storage that all machines share")


def _patiently(order: Order, name: str) -> Done:
    """Waits for a shard that is busy: the system takes a while to free what a dead process held."""
    end = time.monotonic() + order.patience
    pause = 0.05
    while True:
        try:
            return batch(order.input, order.out, shard=name, workers=1, **order.options)
        except Error as error:
            if error.cause != "busy" or time.monotonic() + pause > end:
                raise
        time.sleep(pause)
        pause = min(2.0 * pause, 2.0)
