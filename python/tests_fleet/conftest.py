"""Recordings of a motor, the command line in processes of its own, and what a folder of results holds."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import uuid
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pandas
import psutil
import pyarrow.parquet
import pytest
import servoid as sv

BUILT = Path(__file__).parents[2] / "target/debug/servoid"
UNITS = 24
#: Rows of a row group of the file: one group a shard.
GROUP = 3
SHARDS = UNITS // GROUP
#: Some 30 ms a recording, and some 250 ms.
FIT = ("--do", "fit", "--with", "coulomb")
DIAGNOSE = ("--do", "diagnose", "--budget", "20")


def motor(seed: int, seconds: float = 2.0) -> dict:
    """A recording of a motor with Coulomb friction, as a row of a file."""
    draw = np.random.default_rng(seed)
    step, within, counts_per_rev = 1e-3, 5, 2048.0
    time_s = np.arange(round(seconds / step)) * step
    voltage = 12.0 * np.sign(np.sin(2.0 * np.pi * (1.0 + 0.2 * draw.random()) * time_s))
    voltage *= np.abs(np.sin(2.0 * np.pi * 0.7 * time_s + draw.random()))
    resistance, friction = 1.2 * draw.uniform(0.9, 1.1), 4e-3 * draw.uniform(0.8, 1.2)
    inductance, constant, inertia, viscous = 1e-3, 0.05, 2e-5, 1e-5
    angle = speed = current = 0.0
    angles = []
    h = step / within
    for volts in voltage.tolist():
        angles.append(angle)
        for _ in range(within):
            current += h * (volts - resistance * current - constant * speed) / inductance
            speed += h * (constant * current - viscous * speed - friction * max(-1.0, min(1.0, 20.0 * speed))) / inertia
            angle += h * speed
    counts = np.floor(np.array(angles) / (2.0 * np.pi) * counts_per_rev)
    return {
        "unit": f"unit {seed:03}",
        "t_s": time_s,
        "voltage_v": voltage,
        "angle_counts": counts,
        "counts_per_rev": counts_per_rev,
    }


class Folder:
    """A folder of results."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def keys(self) -> list[str]:
        """The keys of all its rows, as often as they stand there."""
        found = []
        for part in self.path.glob("parts/*.parquet"):
            found += pyarrow.parquet.read_table(part, columns=["key"])["key"].to_pylist()
        for journal in self.path.glob("journal-*.jsonl"):
            lines = journal.read_bytes().split(b"\n")
            found += [json.loads(line)["key"] for line in lines[:-1]]
        return found

    def rows(self) -> int:
        return len(set(self.keys()))

    def under_way(self) -> list[int]:
        """The processes whose work on a shard has not ended, or was killed."""
        pids = []
        for path in self.path.glob("runs/*.json"):
            if json.loads(path.read_text())["ended"] is None:
                pids.append(int(path.stem.rsplit("-", 1)[1]))
        return pids


class Driver:
    """`python -m servoid.fleet`, in a process group of its own."""

    def __init__(self, *arguments: object, verb: str = "run") -> None:
        self._out, self._err = tempfile.TemporaryFile("w+"), tempfile.TemporaryFile("w+")
        command = [sys.executable, "-m", "servoid.fleet", verb, *map(str, arguments), "--json", "-"]
        self.process = subprocess.Popen(command, stdout=self._out, stderr=self._err, start_new_session=True)
        self._seen: set[psutil.Process] = set()

    def family(self) -> set[psutil.Process]:
        """It and every process that it was seen to have."""
        try:
            here = psutil.Process(self.process.pid)
            self._seen |= {here, *here.children(recursive=True)}
        except psutil.NoSuchProcess:
            pass
        return self._seen

    def until(self, what: Callable[[], bool], seconds: float = 120.0) -> bool:
        """Waits until something is so; whether it was before the driver ended."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if what():
                return True
            if self.process.poll() is not None:
                return what()
            time.sleep(0.02)
        raise TimeoutError(f"{self.process.args}: {self.errors()}")

    def kill(self, group: bool) -> None:
        self.family()
        if group and self.process.poll() is None:
            os.killpg(self.process.pid, signal.SIGKILL)
        else:
            self.process.kill()
        self.process.wait()

    def gone(self, folder: Folder, seconds: float = 30.0) -> None:
        """Workers that a killed driver leaves behind end by themselves. (Ray's own agents take minutes.)"""
        left = psutil.wait_procs([one for one in self._seen if one.pid in folder.under_way()], timeout=seconds)[1]
        assert not left, left

    def ended(self, code: int = 0, seconds: float = 180.0) -> dict:
        """Its totals, when it ends with this exit code."""
        self.family()
        assert self.process.wait(timeout=seconds) == code, self.errors()
        self._out.seek(0)
        text = self._out.read()
        return json.loads(text) if text else {}

    def errors(self) -> str:
        self._err.seek(0)
        return self._err.read()

    def close(self) -> None:
        """Leaves no process behind."""
        for one in self.family():
            try:
                one.kill()
            except psutil.NoSuchProcess:
                pass
        self.process.wait()


@pytest.fixture(scope="session", autouse=True)
def ray_of_its_own() -> Iterator[None]:
    """Ray with its token, its files and its list of clusters in a folder that goes away; its sockets need a short path."""
    folder = Path(tempfile.mkdtemp(prefix="fleet"))
    (folder / "token").write_text(uuid.uuid4().hex)
    own = {
        "RAY_AUTH_MODE": "token",
        "RAY_AUTH_TOKEN_PATH": str(folder / "token"),
        "RAY_TMPDIR": str(folder),
        "RAY_USAGE_STATS_ENABLED": "0",
    }
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("RAY_ADDRESS", raising=False)
        for name, value in own.items():
            patch.setenv(name, value)
        yield
    shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(scope="session")
def program() -> str:
    """The program `servoid`, of the package's version."""
    found = os.environ.get("SERVOID") or (str(BUILT) if BUILT.exists() else shutil.which("servoid"))
    if found is None:
        pytest.skip("SKIPPED: no program servoid is built; cargo build makes it")
    said = subprocess.run([found, "--version"], capture_output=True, text=True, check=True).stdout.split()
    if said[-1] != sv.__version__:
        pytest.skip(f"SKIPPED: {found} is version {said[-1]}, the package {sv.__version__}")
    return found


@pytest.fixture(scope="session")
def lot(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The recordings."""
    path = tmp_path_factory.mktemp("lot") / "lot.parquet"
    pandas.DataFrame([motor(seed) for seed in range(UNITS)]).to_parquet(path, row_group_size=GROUP)
    return path


def undisturbed(lot: Path, folder: Path, **task: object) -> bytes:
    """The table of one process with one thread."""
    done = sv.batch(lot, folder / "out", workers=1, table=folder / "table.parquet", **task)
    assert (done.made, done.errors) == (UNITS, 0)
    return (folder / "table.parquet").read_bytes()


@pytest.fixture(scope="session")
def fitted(lot: Path, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return undisturbed(lot, tmp_path_factory.mktemp("fitted"), do="fit", effects=["coulomb"])


@pytest.fixture(scope="session")
def diagnosed(lot: Path, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return undisturbed(lot, tmp_path_factory.mktemp("diagnosed"), do="diagnose", budget=20)


@pytest.fixture
def drive() -> Iterator[Callable[..., Driver]]:
    """Starts drivers."""
    drivers: list[Driver] = []

    def start(*arguments: object, verb: str = "run") -> Driver:
        drivers.append(Driver(*arguments, verb=verb))
        return drivers[-1]

    yield start
    for driver in drivers:
        driver.close()
