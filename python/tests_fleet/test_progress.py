"""What is drawn on a terminal while the local engine works."""

import io
import os
import re
import signal
import sys
import threading

import pytest
import servoid as sv
from conftest import UNITS
from servoid import fleet


class Terminal(io.StringIO):
    """A terminal, in place of stderr."""

    def isatty(self) -> bool:
        return True

    def counts(self) -> list[int]:
        """The recordings of each line that was drawn."""
        return [int(count) for count in re.findall(rf"(\d+) of {UNITS} recordings", self.getvalue())]


def test_counts_what_was_there_and_what_is_made(lot, tmp_path, monkeypatch):
    there = sv.batch(lot, tmp_path, budget=20, shard="1/2").made
    monkeypatch.setattr(sys, "stderr", terminal := Terminal())
    done = fleet.run(lot, tmp_path, budget=20, progress=True)
    assert (done.there, done.made) == (there, UNITS - there)
    first, *drawn, last = terminal.counts()
    assert first == 0 and last == UNITS
    assert drawn == sorted(drawn)
    assert any(there < count < UNITS for count in drawn), drawn
    assert terminal.getvalue().count("\n") == 1


def test_does_not_keep_ctrl_c(lot, tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    pressed = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    pressed.start()
    done = fleet.run(lot, tmp_path, budget=20, workers=1, progress=True)
    pressed.join()
    assert done.interrupted and done.made < UNITS
