"""Recordings of the virtual bench, made by the program that SERVOID names."""

import json
import os
import shlex
import subprocess
from pathlib import Path

import pytest


class Desk:
    """A folder, and the command line in it."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.program = os.environ["SERVOID"]

    def run(self, arguments: str) -> str:
        done = subprocess.run(
            [self.program, *shlex.split(arguments)], cwd=self.folder, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"servoid {arguments}: {done.stderr}"
        return done.stdout

    def json(self, arguments: str) -> dict:
        found = json.loads(self.run(f"{arguments} --json - --quiet"))
        # How its columns were found is said of files alone.
        found.pop("read", None)
        return found


@pytest.fixture(scope="session")
def desk(tmp_path_factory: pytest.TempPathFactory) -> Desk:
    desk = Desk(tmp_path_factory.mktemp("desk"))
    for name, seed in (("rec.csv", 1), ("other.csv", 2)):
        desk.run(f"simulate --hide coulomb --excite commissioning-coast --seconds 8 --out {name} --seed {seed}")
    return desk


@pytest.fixture(autouse=True)
def in_desk(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(desk.folder)
