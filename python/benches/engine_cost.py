"""What an engine costs: the same diagnoses by the threads of one process and by Ray's processes on this machine, in turns.

usage: scripts/fleet bench [--units N] [--seconds S] [--workers N] [--rounds N]

Each run is made twice: with all units to do, and again with all of them done, which is the engine's start and end alone. Prints how
long both took, the work between the first shard's start and the last one's end, and the CPU time of all processes, which other jobs on
the machine disturb least; then the ratios of the medians. What the engine costs a unit is the ratio of CPU time beyond start and end.
"""

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from datetime import datetime
from pathlib import Path

import pandas
import psutil

sys.path.insert(0, str(Path(__file__).parents[1] / "tests_fleet"))
from conftest import motor  # noqa: E402

#: Seconds between looks at the CPU time of processes.
LOOK = 0.1


def timed(lot: Path, out: Path, engine: str, workers: int) -> tuple[float, float]:
    """Seconds of a run, and of CPU of all its processes."""
    command = [sys.executable, "-m", "servoid.fleet", "run", lot, out, "--engine", engine, "--workers", workers, "--quiet"]
    started = time.monotonic()
    run = psutil.Popen([*map(str, command)], stdout=subprocess.DEVNULL)
    used: dict[psutil.Process, float] = {}
    while run.poll() is None:
        try:
            for one in [run, *run.children(recursive=True)]:
                spent = one.cpu_times()
                used[one] = spent.user + spent.system
        except psutil.NoSuchProcess:
            pass
        time.sleep(LOOK)
    if run.returncode != 0:
        sys.exit(f"{engine} failed")
    return time.monotonic() - started, sum(used.values())


def work(out: Path) -> float:
    """Seconds from the first shard's start to the last one's end."""
    runs = [json.loads(path.read_text()) for path in out.glob("runs/*.json")]
    started = min(datetime.fromisoformat(run["started"]) for run in runs)
    return (max(datetime.fromisoformat(run["ended"]) for run in runs) - started).total_seconds()


def main() -> None:
    parser = argparse.ArgumentParser(description="Times Ray against the threads of one process.")
    parser.add_argument("--units", type=int, default=24)
    parser.add_argument("--seconds", type=float, default=8.0, help="length of a recording: 8 s take about 1 s to diagnose")
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    took: dict[str, list[dict[str, float]]] = {"local": [], "ray": []}
    with tempfile.TemporaryDirectory(prefix="fleet") as folder:
        lot = Path(folder) / "lot.parquet"
        pandas.DataFrame([motor(seed, asked.seconds) for seed in range(asked.units)]).to_parquet(lot, row_group_size=1)
        for turn in range(asked.rounds):
            # Whoever is first in one round is last in the next.
            for engine in list(took)[:: 1 if turn % 2 == 0 else -1]:
                out = Path(folder) / f"{engine} {turn}"
                whole, cpu = timed(lot, out, engine, asked.workers)
                own = work(out)
                again, idle = timed(lot, out, engine, asked.workers)
                one = {"run": whole, "done before": again, "work": own, "CPU": cpu, "CPU beyond start and end": cpu - idle}
                took[engine].append(one)
                print(f"{engine:5}  " + "  ".join(f"{name} {seconds:.2f} s" for name, seconds in one.items()), flush=True)
    for name in took["local"][0]:
        local, ray = (statistics.median(one[name] for one in took[engine]) for engine in ("local", "ray"))
        print(f"{name}: ray {ray:.2f} s / local {local:.2f} s = {ray / local:.3f}")


if __name__ == "__main__":
    main()
