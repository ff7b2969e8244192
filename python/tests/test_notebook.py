"""The notebook of the book runs, and shows what it shows there."""

import subprocess
import sys
from pathlib import Path

RENDER = Path(__file__).parent.parent / "notebooks" / "render.py"


def test_the_notebook_shows_what_the_book_shows():
    done = subprocess.run([sys.executable, RENDER, "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr + "\nrun python/notebooks/render.py"
