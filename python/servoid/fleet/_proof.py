"""A proof on many processes or machines: random motors with hidden physics, or the coverage of standard errors.

The program `servoid` does the cases. They are cut into parts of some cases each, whatever the engine, and each part is a file of its
own: a proof that was killed goes on with the same command, on any number of machines.
"""

import hashlib
import json
import os
import shutil
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from .._batch import Done
from .._servoid import Error, UsageError, __version__
from ._engine import Name
from ._progress import Progress
from ._spread import spread_shards
from ._task import Outcome, check_place, mark

#: Cases of a part: some seconds of work, so that little is lost and a part is worth its process.
CASES = 20


@dataclass(frozen=True, slots=True)
class Proven:
    """The joint result of a proof."""

    #: The table, as `servoid prove --merge` prints it.
    text: str
    #: `servoid.prove/1` or `servoid.coverage/1`, as it writes it.
    json: str

    def to_dict(self) -> dict[str, Any]:
        """The result as a dictionary of its own."""
        document: dict[str, Any] = json.loads(self.json)
        return document


@dataclass(frozen=True, slots=True)
class Part:
    """A part of a proof: what every task is told."""

    out: str
    mark: str
    version: str
    program: str
    arguments: tuple[str, ...]
    coverage: bool
    cases: int
    threads: int | None

    def file(self, name: str) -> str:
        """The file of a shard. Cases of other options or versions are in other files."""
        told = json.dumps([self.version, self.coverage, self.cases, *self.arguments])
        key = hashlib.sha256(told.encode()).hexdigest()[:12]
        kind, end = ("coverage", "json") if self.coverage else ("prove", "jsonl")
        return os.path.join(self.out, f"{kind}-{key}-{name.replace('/', '-of-')}.{end}")

    def __call__(self, name: str) -> Outcome:
        """Does a shard."""
        try:
            check_place(self.out, self.mark, self.version)
            index, count = (int(number) for number in name.split("/"))
            cases = len(range(index - 1, self.cases, count))
            path = self.file(name)
            there = os.path.exists(path + ".done")
            if not there:
                self._run(name, path)
            return Outcome(name, Done(cases, cases if there else 0, 0 if there else cases, 0, False))
        except Error as error:
            return Outcome(name, None, error.cause, str(error))

    def _run(self, name: str, path: str) -> None:
        common = [self.program, "prove", *self.arguments, "--cases", str(self.cases), "--shard", name, "--quiet"]
        if self.coverage:
            own = f"{path}.{os.getpid()}"
            _called([*common, "--coverage", "--json", own], self.threads)
            os.replace(own, path)
        else:
            _called([*common, "--resume" if os.path.exists(path) else "--out", path], self.threads)
        with open(path + ".done", "w", encoding="ascii"):
            pass


def prove(
    out: str | os.PathLike[str],
    arguments: Sequence[str] = (),
    *,
    cases: int = 100,
    coverage: bool = False,
    engine: Name = "local",
    address: str | None = None,
    workers: int | None = None,
    program: str | None = None,
    progress: bool = False,
) -> Proven:
    """Proves `cases` with an engine, and returns the joint result.

    Parameters
    ----------
    out : folder of the finished cases, on storage that all machines share; what is in it is not done again.
    arguments : further arguments of `servoid prove`, as in `["--hidden", "one", "--seed", "7"]`.
    coverage : in place of diagnoses, how often the standard errors of fits hold the truth.
    program : the program `servoid`, at the same path on all machines; the one on the path if not given.
    engine, address, workers, progress : as of `run`.
    """
    if cases < 1:
        raise UsageError(f"cases={cases}: it is at least 1")
    taken = {"--cases", "--shard", "--out", "--resume", "--merge", "--only", "--json", "--plot", "--coverage"}
    for argument in arguments:
        if argument.split("=")[0] in taken:
            raise UsageError(f"{argument}: is set by the proof itself; leave it out")
    found = shutil.which(program or "servoid")
    if found is None:
        raise UsageError(f"{program or 'servoid'}: there is no such program; name it by program=")
    found = os.path.abspath(found)
    said = _called([found, "--version"], None).split()
    if said[-1:] != [__version__]:
        raise Error(f"{found} is version {' '.join(said[-1:])}, this package {__version__}; install one version of both")
    folder = os.path.abspath(os.fspath(out))
    parts = -(-cases // CASES)
    # In this process one part after the other takes all cores; a task of an engine takes one.
    threads = workers if engine == "local" else 1
    work = Part(folder, mark(folder), __version__, found, tuple(arguments), coverage, cases, threads)
    names = [f"{index}/{parts}" for index in range(1, parts + 1)]
    shown = Progress(progress, cases, parts, "cases")
    if engine == "local":
        with shown:
            _locally(work, names, shown)
    else:
        done = spread_shards(work, lambda _: names, engine, address, workers, shown)
        if done.interrupted:
            raise KeyboardInterrupt
    files = [work.file(name) for name in names]
    kind = ["--coverage"] if coverage else []
    with tempfile.TemporaryDirectory() as own:
        path = os.path.join(own, "merged.json")
        table = _called([found, "prove", *kind, "--merge", *files, "--json", path], None)
        with open(path, encoding="utf-8") as file:
            return Proven(table, file.read())


def _locally(work: Part, names: Sequence[str], shown: Progress) -> None:
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

