"""Motors of the virtual bench, fitted, and exported to the programs that the formats are for.

A motor with a hidden effect is recorded with the bridge open in the pauses, and fitted with its resistance known. What is exported has to move
as another recording of the same motor does, which was never fitted.
"""

import csv
import json
import os
import subprocess
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pytest

#: Counts a turn of the bench, and seconds between two readings.
COUNTS, PERIOD = 2000.0, 1e-3
#: Resistance of the bench's gearmotor, ohm, and the turns of its gear.
OHM, GEAR = 2.3, 30.0

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("SERVOID", str(ROOT / "target" / "debug" / "servoid"))


def servoid(folder: Path, *words: str) -> str:
    """What the program says on stdout."""
    done = subprocess.run([PROGRAM, *words, "--quiet"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, f"servoid {' '.join(words)}: {done.stderr}"
    return done.stdout


@dataclass(frozen=True)
class Motion:
    """A recording: volts that are held until the next reading, and the angle that was read."""

    voltage: np.ndarray
    counts: np.ndarray

    @classmethod
    def read(cls, path: Path) -> "Motion":
        rows = list(csv.DictReader(line for line in path.open() if not line.startswith("#")))
        columns = (np.array([float(row[name]) for row in rows]) for name in ("voltage_v", "angle_counts"))
        return cls(*columns)

    @property
    def angle(self) -> np.ndarray:
        """The angle, rad: readings are rounded down."""
        return (self.counts + 0.5) * 2.0 * np.pi / COUNTS

    def off(self, angle: np.ndarray) -> float:
        """How far another motion (rad) is off, counts RMS."""
        return float(np.sqrt(np.mean(((angle - self.angle) * COUNTS / (2.0 * np.pi)) ** 2)))


@dataclass(frozen=True)
class Motor:
    """A motor of the bench and what was found of it."""

    folder: Path
    effect: str | None

    def hidden(self, name: str, excite: str, seconds: float) -> Path:
        """A recording with the effect hidden in it."""
        hide = ["--hide", self.effect] if self.effect else []
        length = ["--seconds", str(seconds)]
        servoid(self.folder, "simulate", *hide, "--excite", excite, *length, "--out", name, "--no-motor")
        return self.folder / name

    @cached_property
    def motion(self) -> Motion:
        """What was never fitted."""
        return Motion.read(self.hidden("other.csv", "commissioning", 4.0))

    @cached_property
    def fit(self) -> dict:
        """The fit's JSON."""
        self.hidden("fitted.csv", "commissioning-coast", 8.0)
        names = ["--with", self.effect] if self.effect else []
        facts = ["--known", f"resistance_ohm={OHM}", "--kt-equals-kb"]
        set_up = ["--counts-per-rev", str(COUNTS), "--supply-v", "12"]
        servoid(self.folder, "fit", "fitted.csv", *names, *facts, *set_up, "--json", "fit.json")
        return json.loads((self.folder / "fit.json").read_text())

    def found(self, name: str) -> float:
        """A number of the fit."""
        return next(p["value"] for p in self.fit["parameters"] if p["name"] == name)

    def export(self, to: str, *flags: str) -> dict:
        """`servoid.export/1`."""
        self.fit
        return json.loads(servoid(self.folder, "export", "fit.json", "--to", to, "--json", "-", *flags))

    def text(self, to: str, *flags: str) -> str:
        """What stands in the file."""
        return self.export(to, *flags)["text"]

    def carried(self, to: str, *flags: str) -> bool:
        """Whether the format claims to carry all of the effect."""
        return self.effect not in [lack["what"] for lack in self.export(to, *flags)["cannot_carry"]]


@pytest.fixture(scope="session")
def motor(tmp_path_factory):
    """The motor with an effect, fitted once."""
    made = {}

    def of(effect: str | None = None) -> Motor:
        if effect not in made:
            made[effect] = Motor(tmp_path_factory.mktemp(effect or "linear"), effect)
        return made[effect]

    return of
