"""Runs the notebooks of this folder and writes them, as run, into the book.

    python render.py          runs them, keeps their outputs, and writes pages and drawings
    python render.py --check  runs them and says which outputs differ from those that were kept
"""

import argparse
import sys
from pathlib import Path

import nbformat
from nbclient import NotebookClient
from nbconvert import MarkdownExporter

FOLDER = Path(__file__).parent
#: Characters of an output that differs; a drawing has a hundred thousand.
SHOWN = 300
PAGES = FOLDER.parent.parent / "docs" / "book" / "src" / "tutorial"


def run(path: Path) -> nbformat.NotebookNode:
    """The notebook with the outputs of a fresh run."""
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    for cell in notebook.cells:
        # When a cell ran is of that run alone.
        cell.metadata.pop("execution", None)
    notebook.metadata["language_info"] = {"name": "python"}
    return notebook


def outputs(notebook: nbformat.NotebookNode) -> list[list[str]]:
    """What each cell prints and shows, as text."""

    def text(output: nbformat.NotebookNode) -> str:
        shown = output.get("data", {})
        return str(output.get("text") or shown.get("image/svg+xml") or shown.get("text/plain") or output.get("ename"))

    return [[text(output) for output in cell.get("outputs", [])] for cell in notebook.cells]


def write(path: Path, notebook: nbformat.NotebookNode) -> None:
    """Keeps the outputs, and writes the page of the book with its drawings."""
    nbformat.write(notebook, path)
    resources = {"output_files_dir": path.stem, "unique_key": path.stem}
    page, made = MarkdownExporter().from_notebook_node(notebook, resources=resources)
    source = f"<!-- Written by python/notebooks/render.py from {path.name}. -->\n\n"
    (PAGES / f"{path.stem}.md").write_text(source + page.strip() + "\n", encoding="utf-8")
    for name, content in made["outputs"].items():
        drawing = PAGES / name
        drawing.parent.mkdir(exist_ok=True)
        drawing.write_bytes(content)


def main() -> int:
    asked = argparse.ArgumentParser(description="Runs the notebooks of this folder.")
    asked.add_argument("--check", action="store_true", help="write nothing, and say what differs")
    check = asked.parse_args().check
    differ = 0
    for path in sorted(FOLDER.glob("*.ipynb")):
        notebook = run(path)
        if not check:
            write(path, notebook)
            continue
        kept = outputs(nbformat.read(path, as_version=4))
        for number, (before, now) in enumerate(zip(kept, outputs(notebook), strict=True)):
            if before != now:
                shown = [str(text)[:SHOWN] for text in (before, now)]
                print(f"{path.name}, cell {number}: was {shown[0]}\n  and is {shown[1]}", file=sys.stderr)
                differ += 1
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
