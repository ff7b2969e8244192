"""A comparison of search methods over many seeds, on many processes or machines."""

import hashlib
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from .._servoid import Error, UsageError
from ._engine import Name
from ._parts import Joint, Parts, Place, do_parts, refuse

#: Seeds of a part: some seconds of work.
SEEDS = 20
#: What is set here, and what would make parts differ from those before them.
TAKEN = {"--seeds", "--seed", "--budget", "--motor", "--out", "-o", "--merge", "--json", "--plot", "--report", "--write-motor"}
#: Whose values are files.
FILES = {"--effects"}


@dataclass(frozen=True, slots=True)
class Task:
    """The comparison on one recording."""

    recording: str
    motor: str | None
    arguments: tuple[str, ...]
    budget: int
    #: What its files hold.
    content: str

    def command(self) -> list[str]:
        motor = ["--motor", self.motor] if self.motor else []
        return ["compare", self.recording, *motor, *self.arguments, "--budget", str(self.budget)]


@dataclass(frozen=True, slots=True)
class Comparison(Parts):
    """The runs. A part is some seeds in a row on one recording, so that more seeds later on are further parts."""

    place: Place
    tasks: tuple[Task, ...]
    first: int
    seeds: int
    part: int

    def names(self) -> list[str]:
        return [name for index in range(len(self.tasks)) for name in self.names_of(index)]

    def names_of(self, index: int) -> list[str]:
        """The parts of one recording: which recording, first seed and number of seeds."""
        end = self.first + self.seeds
        firsts = range(self.first, end, self.part)
        return [f"{index}/{first}/{min(self.part, end - first)}" for first in firsts]

    def cases(self, name: str) -> int:
        return int(name.split("/")[2])

    def file(self, name: str) -> str:
        index, first, seeds = (int(number) for number in name.split("/"))
        task = self.tasks[index]
        return self.place.file("compare", [task.content, task.budget, *task.arguments], f"{first}-{seeds}.json")

    def make(self, name: str) -> None:
        index, first, seeds = name.split("/")
        own = ["--seed", first, "--seeds", seeds, "--out", self.file(name), "--quiet"]
        self.place.call(*self.tasks[int(index)].command(), *own)

    def joint(self, index: int) -> Joint:
        """The table of one recording."""
        files = [self.file(name) for name in self.names_of(index)]
        return self.place.joint(*self.tasks[index].command(), "--merge", *files)


def compare(
    out: str | os.PathLike[str],
    recordings: Iterable[str | os.PathLike[str]],
    arguments: Sequence[str] = (),
    *,
    seeds: int = 30,
    seed: int = 1,
    budget: int = 5000,
    motor: str | os.PathLike[str] | None = None,
    engine: Name = "local",
    address: str | None = None,
    workers: int | None = None,
    program: str | None = None,
    progress: bool = False,
) -> list[Joint]:
    """Compares search methods on each of `recordings` with an engine.

    Returns for each recording what `servoid compare` gives with the same arguments: its table, and `servoid.compare/1`.

    Parameters
    ----------
    out : folder of the finished runs, on storage that all machines share; what is in it is not done again.
    recordings : each as `servoid compare` takes it, on storage that all machines share.
    arguments : further arguments of `servoid compare`, as in `["--algorithm", "lm,pso", "--with", "coulomb"]`.
    seeds, seed : runs of each method, and the seed of the first; each run has the next seed.
    budget : model evaluations of each run.
    motor : what is known of the motors; else `motor.toml` beside each recording.
    program : the program `servoid`, at the same path on all machines; the one on the path if not given.
    engine, address, workers, progress : as of `run`.
    """
    if seeds < 1 or budget < 1:
        raise UsageError(f"seeds={seeds}, budget={budget}: each is at least 1")
    if seed < 0 or seed + seeds > 2**64:
        raise UsageError(f"seed={seed}: seeds are from 0 to 2^64 - 1")
    refuse(arguments, TAKEN)
    place = Place.of(out, program, engine, workers)
    known = None if motor is None else os.path.abspath(os.fspath(motor))
    given, files = _with_files(arguments)
    tasks = tuple(_task(os.fspath(one), known, given, files, budget) for one in recordings)
    if not tasks:
        raise UsageError("there is no recording")
    comparison = Comparison(place, tasks, seed, seeds, SEEDS)
    do_parts(comparison, engine, address, workers, progress, "seeds")
    return [comparison.joint(index) for index in range(len(tasks))]


def _with_files(arguments: Sequence[str]) -> tuple[tuple[str, ...], list[str]]:
    """The arguments with whole paths, since a task may run in another folder, and the files that they name."""
    given, files = list(arguments), []
    for place, argument in enumerate(arguments):
        flag, equals, value = argument.partition("=")
        at = place if equals else place + 1
        if flag in FILES and at < len(given):
            files.append(os.path.abspath(value if equals else given[at]))
            given[at] = flag + equals + files[-1] if equals else files[-1]
    return tuple(given), files


def _task(recording: str, motor: str | None, arguments: tuple[str, ...], named: Sequence[str], budget: int) -> Task:
    # `FILE#PART` is a part of a file.
    path, hash_sign, part = recording.rpartition("#")
    if not hash_sign or os.path.exists(recording):
        path, part = recording, ""
    path = os.path.abspath(path)
    if not os.path.exists(path):
        raise Error(f"{path}: there is no such file or folder")
    beside = os.path.join(os.path.dirname(path), "motor.toml")
    files = [path, *([motor or beside] if motor or os.path.exists(beside) else []), *named]
    digest = hashlib.sha256("\0".join([os.path.basename(path), part, *map(_digest, files)]).encode())
    return Task(path + hash_sign + part if part else path, motor, arguments, budget, digest.hexdigest())


def _digest(path: str) -> str:
    """Of a file, or of all files of a folder."""
    if os.path.isdir(path):
        inside = sorted(os.path.join(folder, name) for folder, _, names in os.walk(path) for name in names)
        told = "\0".join(f"{os.path.relpath(one, path)}\0{_digest(one)}" for one in inside)
        return hashlib.sha256(told.encode()).hexdigest()
    try:
        with open(path, "rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise Error(f"{path}: {error.strerror}") from error
