"""Work of the program `servoid` in parts: the program does each, and makes the joint result of them all.

The work is cut into the same parts whatever the engine, and each part is a file of its own, which is there when the part is done:
work that was killed goes on with the same command, on any number of machines.
"""

import hashlib
import json
import os
import shutil
import subprocess
import tempfile
from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .._batch import Done
from .._servoid import Error, UsageError, __version__
from ._engine import Name
from ._progress import Progress
from ._spread import spread_shards
from ._task import Outcome, check_place, mark


@dataclass(frozen=True, slots=True)
class Joint:
    """The joint result of all parts."""

    #: The table, as the program prints it.
    text: str
    #: The result, as the program writes it with `--json`.
    json: str

    def to_dict(self) -> dict[str, Any]:
        """The result as a dictionary of its own."""
        document: dict[str, Any] = json.loads(self.json)
        return document


@dataclass(frozen=True, slots=True)
class Place:
    """Where parts are done: what every task is told."""

    out: str
    mark: str
    version: str
    program: str
    threads: int | None

    @classmethod
    def of(cls, out: str | os.PathLike[str], program: str | None, engine: Name, workers: int | None) -> "Place":
        """The folder `out`, and the program if it has this package's version."""
        found = shutil.which(program or "servoid")
        if found is None:
            raise UsageError(f"{program or 'servoid'}: there is no such program; name it by program=")
        found = os.path.abspath(found)
        said = _called([found, "--version"], None).split()
        if said[-1:] != [__version__]:
            raise Error(f"{found} is version {' '.join(said[-1:])}, this package {__version__}; install one version of both")
        folder = os.path.abspath(os.fspath(out))
        # In this process one part after the other takes all cores; a task of an engine takes one.
        return cls(folder, mark(folder), __version__, found, workers if engine == "local" else 1)

    def call(self, *arguments: str) -> None:
        """Has the program do something."""
        _called([self.program, *arguments], self.threads)

    def joint(self, *arguments: str) -> Joint:
        """What the program prints, and writes with `--json`."""
        with tempfile.TemporaryDirectory() as own:
            path = os.path.join(own, "joint.json")
            table = _called([self.program, *arguments, "--json", path], None)
            with open(path, encoding="utf-8") as file:
                return Joint(table, file.read())

    def file(self, kind: str, told: Sequence[object], name: str) -> str:
        """A file whose name has a digest of all that its content depends on."""
        digest = hashlib.sha256(json.dumps([kind, self.version, *told]).encode()).hexdigest()[:12]
        return os.path.join(self.out, f"{kind}-{digest}-{name}")


class Parts(ABC):
    """Work in parts. It goes to the processes of an engine, and does one part at a time there."""

    __slots__ = ()

    place: Place

    @property
    def out(self) -> str:
        """Folder of the parts."""
        return self.place.out

    @abstractmethod
    def names(self) -> list[str]:
        """All parts."""

    @abstractmethod
    def cases(self, name: str) -> int:
        """How much a part is."""

    @abstractmethod
    def file(self, name: str) -> str:
        """The file that is there when a part is done. Other options or versions have other files."""

    @abstractmethod
    def make(self, name: str) -> None:
        """Does a part, and puts its file there whole."""

    def __call__(self, name: str) -> Outcome:
        """Does a part that is not done."""
        try:
            check_place(self.out, self.place.mark, self.place.version)
            cases = self.cases(name)
            there = os.path.exists(self.file(name))
            if not there:
                self.make(name)
            return Outcome(name, Done(cases, cases if there else 0, 0 if there else cases, 0, False))
        except Error as error:
            return Outcome(name, None, error.cause, str(error))


def do_parts(work: Parts, engine: Name, address: str | None, workers: int | None, progress: bool, what: str) -> None:
    """Does all parts with an engine; `what` they are made of is shown."""
    names = work.names()
    shown = Progress(progress, sum(work.cases(name) for name in names), len(names), what)
    if engine == "local":
        with shown:
            _locally(work, names, shown)
    elif spread_shards(work, lambda _: names, engine, address, workers, shown).interrupted:
        raise KeyboardInterrupt


def refuse(arguments: Sequence[str], taken: set[str]) -> None:
    """Arguments of the program that are set here, and cannot be given."""
    for argument in arguments:
        if argument.split("=")[0] in taken:
            raise UsageError(f"{argument}: is set by the work in parts itself; leave it out")


def _locally(work: Parts, names: Sequence[str], shown: Progress) -> None:
    done = 0
    for ended, name in enumerate(names, 1):
        outcome = work(name)
        if outcome.done is None:
            error = (UsageError if outcome.cause == "usage" else Error)(outcome.message)
            error.cause = outcome.cause
            raise error
        done += outcome.done.recordings
        shown.at(done, ended)


def _called(command: Sequence[str], threads: int | None) -> str:
    """Runs the program; its stdout."""
    environment = dict(os.environ)
    if threads is not None:
        environment["RAYON_NUM_THREADS"] = str(threads)
    ran = subprocess.run(command, capture_output=True, text=True, env=environment, check=False)
    if ran.returncode != 0:
        lines = ran.stderr.strip().splitlines()
        said = [line for line in lines if line.startswith(("error", "servoid"))] or lines[-1:]
        last = said[0] if said else f"exit code {ran.returncode}"
        wrong = UsageError if ran.returncode == 2 else Error
        error = wrong(f"{os.path.basename(command[0])} {command[1]}: {last}")
        error.cause = "usage" if ran.returncode == 2 else "failed"
        raise error
    return ran.stdout
