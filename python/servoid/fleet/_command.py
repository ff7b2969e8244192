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
from collections.abc import Sequence
from typing import get_args

from .._batch import Done
from .._servoid import Error, UsageError
from ._engine import Name
from ._run import run

EXAMPLES = """examples:
  python -m servoid.fleet run logs results --engine local --do fit --with coulomb --table fits.parquet
  python -m servoid.fleet run lot.parquet results --engine ray
  python -m servoid.fleet run /shared/lot.parquet /shared/results --engine dask --address tcp://head:8786 --tasks 256

exit codes: 0 done, 1 the work failed or was stopped, 2 usage, 130 stopped by a second Ctrl-C"""


def _arguments() -> argparse.ArgumentParser:
    def positive(text: str) -> int:
        if not text.isdecimal() or int(text) < 1:
            raise argparse.ArgumentTypeError(f"{text!r} is no number from 1")
        return int(text)

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
    add("--engine", choices=get_args(Name), default="local", help="who runs the work (default: this process)")
    add("--address", metavar="ADDRESS", help="a cluster of the engine; else it starts one on this machine")
    add("--tasks", type=positive, metavar="N", help="shards of the batch; a few for each CPU if not said")
    add("--workers", type=positive, metavar="N", help="recordings done at a time on this machine; one a core if not said")
    add("--do", choices=["fit", "diagnose"], default="diagnose", help="what is done to each recording (default: diagnose)")
    add("--with", dest="effects", type=names, default=[], metavar="EFFECT,…", help="effects of a fit beside the linear motor")
    add("--algorithm", default="lm", metavar="NAME", help="search method of a fit (default: lm)")
    add("--cost", default="squared", metavar="NAME", help="what a fit minimises (default: squared)")
    add("--evaluations", type=positive, default=20_000, metavar="N", help="model evaluations of a fit at most (default: 20000)")
    add("--budget", type=positive, metavar="MILLIONS", help="steps of a model that a diagnosis takes at most, in millions")
    add("--seed", type=int, default=1, metavar="N", help="seed of whatever is drawn (default: 1)")
    add("--force", action="store_true", help="use recordings that `servoid check` refuses")
    add("--retry", choices=["error"], help="do again what gave an error")
    add("--patience", type=float, default=120.0, metavar="S", help="how long a task waits for a shard that is busy (default: 120)")
    add("--table", metavar="FILE", help="all results of the folder as one Parquet file, ordered by recording")
    add("--json", metavar="FILE", help="the totals as JSON; - for stdout")
    add("--quiet", action="store_true", help="no progress")
    return parser


def main(arguments: Sequence[str] | None = None) -> int:
    """The command line; returns its exit code."""
    asked = _arguments().parse_args(arguments)
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
            done = run(
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
    handle, own = tempfile.mkstemp(dir=os.path.dirname(os.path.abspath(asked.json)), prefix=".fleet")
    with os.fdopen(handle, "w", encoding="utf-8") as file:
        file.write(text + "\n")
    os.chmod(own, 0o644)
    os.replace(own, asked.json)
