"""A proof on many processes or machines: random motors with hidden physics, or the coverage of standard errors."""

import os
import uuid
from collections.abc import Sequence
from dataclasses import dataclass

from .._servoid import UsageError
from ._engine import Name
from ._parts import Joint, Parts, Place, do_parts, refuse

#: Cases of a part: some seconds of work, so that little is lost and a part is worth its process.
CASES = 20
#: What is set here.
TAKEN = {"--cases", "--shard", "--out", "-o", "--resume", "--merge", "--only", "--json", "--plot", "--coverage"}


@dataclass(frozen=True, slots=True)
class Proof(Parts):
    """The cases. A part is a shard of them."""

    place: Place
    arguments: tuple[str, ...]
    coverage: bool
    number: int
    shards: int

    def names(self) -> list[str]:
        return [f"{index}/{self.shards}" for index in range(1, self.shards + 1)]

    def cases(self, name: str) -> int:
        index, count = (int(number) for number in name.split("/"))
        return len(range(index - 1, self.number, count))

    def file(self, name: str) -> str:
        kind, end = ("coverage", "json") if self.coverage else ("prove", "jsonl")
        return self.place.file(kind, [self.number, *self.arguments], f"{name.replace('/', '-of-')}.{end}")

    def make(self, name: str) -> None:
        path = self.file(name)
        common = ["prove", *self.arguments, "--cases", str(self.number), "--shard", name, "--quiet"]
        if self.coverage:
            # Of work that was stopped the program writes what there is.
            own = f"{path}.{uuid.uuid4().hex}"
            self.place.call(*common, "--coverage", "--json", own)
        else:
            # The program adds to it case by case, and goes on with it.
            own = f"{path}.begun"
            self.place.call(*common, "--resume" if os.path.exists(own) else "--out", own)
        os.replace(own, path)


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
) -> Joint:
    """Proves `cases` with an engine, and returns the joint result: `servoid.prove/1` or `servoid.coverage/1`.

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
    refuse(arguments, TAKEN)
    place = Place.of(out, program, engine, workers)
    proof = Proof(place, tuple(arguments), coverage, cases, -(-cases // CASES))
    do_parts(proof, engine, address, workers, progress, "cases")
    kind = ["--coverage"] if coverage else []
    return place.joint("prove", *kind, "--merge", *(proof.file(name) for name in proof.names()))
