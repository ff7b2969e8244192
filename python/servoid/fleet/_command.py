"""The command line, and where its results go."""

import argparse
import contextlib
import json
import os
import signal
import sys
import tempfile
import time
import warnings
from collections.abc import Callable, Sequence
from typing import Any, get_args

from .._batch import Done
from .._servoid import Error, UsageError
from ._comparison import compare
from ._engine import Name
from ._parts import Joint
from ._proof import prove
from ._run import run

EXAMPLES = """examples:
  python -m servoid.fleet run logs results --engine local --do fit --with coulomb --table fits.parquet
  python -m servoid.fleet run lot.parquet results --engine ray
  python -m servoid.fleet run /shared/lot.parquet /shared/results --engine dask --address tcp://head:8786 --tasks 256

exit codes: 0 done, 1 the work failed or was stopped, 2 usage, 130 stopped by a second Ctrl-C"""


PROOFS = """examples:
  python -m servoid.fleet prove cases --cases 100000 --engine ray --hidden one --seed 7
  python -m servoid.fleet prove cover --cases 1000 --coverage --engine dask --address tcp://head:8786"""


COMPARISONS = """examples:
  python -m servoid.fleet compare runs rec.csv --seeds 10000 --engine ray --algorithm lm,pso --json compare.json
  python -m servoid.fleet compare runs logs/*.csv --seeds 1000 --budget 500 --engine dask --with coulomb

With several recordings each table stands under its recording, and the JSON is servoid.fleet_compare/1: what
servoid compare writes of each."""


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"{text!r} is no number from 1")
    return int(text)


def _arguments() -> argparse.ArgumentParser:
    def names(text: str) -> list[str]:
        return [name.strip() for name in text.split(",") if name.strip()]

    parser = argparse.ArgumentParser(prog="servoid.fleet", description="Many recordings, on many processes or machines.")
    verbs = parser.add_subparsers(dest="verb", required=True)
    add = verbs.add_parser(
        "run",
        help="fits or diagnoses every recording",
        description="Fits or diagnoses every recording; what is there already is not done again.",
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    ).add_argument
    add("input", metavar="INPUT", help="a folder with CSV recordings, or a Parquet file with one row a recording")
    add("out", metavar="OUT", help="folder of the results")
    _engine(add)
    add("--tasks", type=_positive, metavar="N", help="shards of the batch; a few for each CPU if not said")
    add("--do", choices=["fit", "diagnose"], default="diagnose", help="what is done to each recording (default: diagnose)")
    add("--with", dest="effects", type=names, default=[], metavar="EFFECT,…", help="effects of a fit beside the linear motor")
    add("--algorithm", default="lm", metavar="NAME", help="search method of a fit (default: lm)")
    add("--cost", default="squared", metavar="NAME", help="what a fit minimises (default: squared)")
    add("--evaluations", type=_positive, default=20_000, metavar="N", help="model evaluations of a fit at most (default: 20000)")
    add("--budget", type=_positive, metavar="MILLIONS", help="steps of a model that a diagnosis takes at most, in millions")
    add("--seed", type=int, default=1, metavar="N", help="seed of whatever is drawn (default: 1)")
    add("--force", action="store_true", help="use recordings that `servoid check` refuses")
    add("--retry", choices=["error"], help="do again what gave an error")
    add("--patience", type=float, default=120.0, metavar="S", help="how long a task waits for a shard that is busy (default: 120)")
    add("--table", metavar="FILE", help="all results of the folder as one Parquet file, ordered by recording")
    add("--json", metavar="FILE", help="the totals as JSON; - for stdout")
    add = verbs.add_parser(
        "prove",
        help="diagnoses random motors with hidden physics, or tells the coverage of standard errors",
        description="Runs `servoid prove` in parts of some cases each. Arguments that this does not know go to it.",
        epilog=PROOFS,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    ).add_argument
    add("out", metavar="OUT", help="folder of the finished cases")
    _engine(add)
    add("--cases", type=_positive, default=100, metavar="N", help="number of cases (default: 100)")
    add("--coverage", action="store_true", help="how often the standard errors of fits hold the truth")
    add("--program", metavar="FILE", help="the program servoid, at the same path everywhere; else the one on the path")
    add("--json", metavar="FILE", help="the joint result as JSON; - for stdout")
    add = verbs.add_parser(
        "compare",
        help="compares search methods over many seeds",
        description="Runs `servoid compare` in parts of some seeds each. Arguments that this does not know go to it.",
        epilog=COMPARISONS,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    ).add_argument
    add("out", metavar="OUT", help="folder of the finished runs")
    add("recordings", metavar="REC", nargs="+", help="the recordings; they stand before arguments that go on")
    _engine(add)
    add("--seeds", type=_positive, default=30, metavar="N", help="runs of each method, each with its own seed (default: 30)")
    add("--seed", type=int, default=1, metavar="N", help="seed of the first run (default: 1)")
    add("--budget", type=_positive, default=5000, metavar="N", help="model evaluations of each run (default: 5000)")
    add("--motor", metavar="FILE", help="what is known of the motors; else motor.toml beside each recording")
    add("--program", metavar="FILE", help="the program servoid, at the same path everywhere; else the one on the path")
    add("--json", metavar="FILE", help="the joint result as JSON; - for stdout")
    return parser


def _engine(add: Callable[..., Any]) -> None:
    """What every verb takes of an engine."""
    add("--engine", choices=get_args(Name), default="local", help="who runs the work (default: this process)")
    add("--address", metavar="ADDRESS", help="a cluster of the engine; else it starts one on this machine")
    add("--workers", type=_positive, metavar="N", help="tasks at a time on this machine; one a core if not said")
    add("--quiet", action="store_true", help="no progress")


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line; returns its exit code."""
    parser = _arguments()
    asked, further = parser.parse_known_args(arguments)
    if further and asked.verb == "run":
        parser.error(f"unrecognized arguments: {' '.join(further)}")
    for name in ("SIGTERM", "SIGHUP"):
        # `nohup` ignores SIGHUP, and so does this then.
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, signal.default_int_handler)
    started = time.monotonic()
    try:
        # Ray writes to stdout what it lost; stdout is for results.
        with warnings.catch_warnings(), contextlib.redirect_stdout(sys.stderr):
            warnings.showwarning = lambda message, *_: print(f"servoid.fleet: {message}", file=sys.stderr)
            warnings.simplefilter("always", UserWarning)
            if asked.verb == "run":
                done = _batched(asked)
            else:
                joint = _proven(asked, further) if asked.verb == "prove" else _compared(asked, further)
        if asked.verb != "run":
            _deliver_joint(asked, joint)
            return 0
        _deliver(asked, done, time.monotonic() - started)
    except (Error, OSError) as error:
        print(f"servoid.fleet: {error}", file=sys.stderr)
        return 2 if isinstance(error, UsageError) else 1
    except KeyboardInterrupt:
        print("servoid.fleet: stopped; what was done is kept, and the same command goes on", file=sys.stderr)
        return 130
    if done.interrupted:
        print("servoid.fleet: stopped by the user before the end; the same command goes on", file=sys.stderr)
        return 1
    return 0


def _batched(asked: argparse.Namespace) -> Done:
    return run(
        asked.input,
        asked.out,
        engine=asked.engine,
        tasks=asked.tasks,
        address=asked.address,
        workers=asked.workers,
        patience=asked.patience,
        progress=not asked.quiet,
        do=asked.do,
        effects=asked.effects,
        algorithm=asked.algorithm,
        cost=asked.cost,
        evaluations=asked.evaluations,
        budget=asked.budget,
        seed=asked.seed,
        force=asked.force,
        retry_errors=asked.retry == "error",
        table=asked.table,
    )


def _proven(asked: argparse.Namespace, further: Sequence[str]) -> Joint:
    return prove(
        asked.out,
        _going_on(further),
        cases=asked.cases,
        coverage=asked.coverage,
        engine=asked.engine,
        address=asked.address,
        workers=asked.workers,
        program=asked.program,
        progress=not asked.quiet,
    )


def _compared(asked: argparse.Namespace, further: Sequence[str]) -> Joint:
    found = compare(
        asked.out,
        asked.recordings,
        _going_on(further),
        seeds=asked.seeds,
        seed=asked.seed,
        budget=asked.budget,
        motor=asked.motor,
        engine=asked.engine,
        address=asked.address,
        workers=asked.workers,
        program=asked.program,
        progress=not asked.quiet,
    )
    if len(found) == 1:
        return found[0]
    pairs = list(zip(asked.recordings, found, strict=True))
    document = {
        "schema": "servoid.fleet_compare/1",
        "recordings": [{"recording": name, "compare": one.to_dict()} for name, one in pairs],
    }
    return Joint("\n".join(f"{name}\n{one.text}" for name, one in pairs), json.dumps(document, indent=2) + "\n")


def _going_on(further: Sequence[str]) -> list[str]:
    """Arguments for the program."""
    return [argument for argument in further if argument != "--"]


def _deliver_joint(asked: argparse.Namespace, joint: Joint) -> None:
    """Prints the table, and writes the result as JSON if asked for."""
    if asked.json == "-":
        print(joint.json, end="")
        return
    print(joint.text, end="")
    if asked.json is not None:
        _write_whole(asked.json, joint.json)


def _deliver(asked: argparse.Namespace, done: Done, took: float) -> None:
    """Prints the totals, and writes them as JSON if asked for."""
    if asked.json != "-":
        print(f"{done.recordings} recordings: {done.made} made now ({done.errors} errors), {done.there} there before")
        if done.interrupted and asked.engine != "local":
            print("these are the totals of the shards that ended; what others made is kept, too")
    if asked.json is None:
        return
    text = json.dumps(
        {
            "schema": "servoid.fleet_run/1",
            "engine": asked.engine,
            "input": asked.input,
            "out": asked.out,
            "recordings": done.recordings,
            "there": done.there,
            "made": done.made,
            "errors": done.errors,
            "interrupted": done.interrupted,
            "seconds": round(took, 3),
            "table": asked.table,
        },
        indent=2,
    )
    if asked.json == "-":
        print(text)
        return
    _write_whole(asked.json, text + "\n")


def _write_whole(path: str, text: str) -> None:
    handle, own = tempfile.mkstemp(dir=os.path.dirname(os.path.abspath(path)), prefix=".fleet")
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text)
    os.chmod(own, 0o644)
    os.replace(own, path)
