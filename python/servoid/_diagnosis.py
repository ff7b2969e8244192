"""Which physical effects recordings show that the linear motor lacks."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from . import _servoid
from ._fit import Parameter, parameters
from ._motor import Facts, known_toml
from ._recording import Recording, several, some
from ._result import Result


@dataclass(frozen=True, slots=True)
class Step:
    """An effect that was added, and what it was chosen from."""

    added: str
    confidence: float | None
    indistinguishable_from: list[str]
    rms_counts: float
    validate_rms_counts: float | None
    evidence: str


class Diagnosis(Result["_servoid.Diagnosis"]):
    """What is missing; made by `diagnose`."""

    __slots__ = ()

    @property
    def verdict(self) -> str:
        """`complete`, `missing_effects`, `unexplained` or `inconclusive`."""
        return str(self._document["verdict"])

    @property
    def named(self) -> list[str]:
        """Effects that were named, in the order in which they were added."""
        return list(self._document["final"]["effects"])

    @property
    def probability(self) -> float | None:
        """Probability of the named set among all that were weighed; None where none were."""
        hypotheses = self._document.get("hypotheses") or []
        own = [one["probability"] for one in hypotheses if sorted(one["effects"]) == sorted(self.named)]
        return own[0] if own else None

    @property
    def steps(self) -> list[Step]:
        """The effects as they were added."""
        return [
            Step(
                one["added"],
                one.get("confidence"),
                list(one.get("indistinguishable_from", [])),
                one["rms_counts"],
                one.get("validate_rms_counts"),
                one.get("evidence", ""),
            )
            for one in self._document["steps"]
        ]

    @property
    def params(self) -> dict[str, Parameter]:
        """Parameters of the last model by their names."""
        return parameters(self._document["final"]["parameters"])

    @property
    def proposed(self) -> list[dict[str, Any]] | None:
        """Laws that were proposed for what the catalogue leaves: `name`, `law`, `explained_percent`, `resembles`, `named`; None where none were
        looked for."""
        return self._document.get("proposed")

    @property
    def advice(self) -> list[str]:
        """What to record next, or to do."""
        return list(self._document["advice"])

    def table(self) -> list[dict[str, Any]]:
        """The error as effects are added, one row a model: `pandas.DataFrame(dia.table())` makes a table of it."""
        base = self._document["base"]
        rows = [{"added": None, **{key: base[key] for key in ("rms_counts", "validate_rms_counts")}, "confidence": None}]
        rows.extend(
            {
                "added": step.added,
                "rms_counts": step.rms_counts,
                "validate_rms_counts": step.validate_rms_counts,
                "confidence": step.confidence,
            }
            for step in self.steps
        )
        return rows

    def __repr__(self) -> str:
        return f"<servoid.Diagnosis {self.verdict}: {', '.join(self.named) or 'nothing missing'}>"


def diagnose(
    recordings: Recording | Sequence[Recording],
    *,
    validate: Recording | Sequence[Recording] | None = None,
    known: Facts | None = None,
    laws: Sequence[str] = (),
    discover: bool = False,
    seed: int = 1,
    steps: int | None = None,
    force: bool = False,
) -> Diagnosis:
    """Names the physical effects that recordings of one motor show and the linear motor lacks.

    Parameters
    ----------
    validate : recordings of the same motor that are never fitted; without them the last of several is held out, or the end of
        the only one.
    known : facts about the motor, see `Recording`; without them those of the first recording.
    laws : laws of your own that are tried beside the catalogue, as in
        `"drag: torque = -c*w*abs(w); c in [0, 1e-3] V*s^2/rad^2"`.
    discover : propose laws for what the catalogue leaves; see `proposed`.
    seed : seed of everything random.
    steps : steps of a model at most; what is best by then is the result.
    force : diagnose recordings that `servoid check` refuses.

    Ctrl-C stops the search: the result is the best so far, with a warning.
    """
    return Diagnosis(
        _servoid.diagnose(
            some(recordings),
            validate=several(validate),
            known=known_toml(known),
            laws=list(laws),
            discover=discover,
            seed=seed,
            steps=steps,
            force=force,
        )
    )
