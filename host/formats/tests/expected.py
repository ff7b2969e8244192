"""What the tests expect of a fixture: written beside it, from the values that the fixture was made of."""

import json
import math
from pathlib import Path


def plain(value):
    """A value as JSON has it: NaN is null, infinity a text."""
    value = float(value)
    if math.isnan(value):
        return None
    return value if math.isfinite(value) else str(value)


def column(name, values, kind="Number", unit=None):
    """A column with its values; None for texts, which are not handed on."""
    values = None if values is None else [plain(value) for value in values]
    return {"name": name, "kind": kind, "unit": unit, "values": values}


def ramp(name, rows, modulo, step=1, kind="Number", unit=None):
    """A long column with the values (step * row) % modulo."""
    return {"name": name, "kind": kind, "unit": unit, "ramp": [rows, step, modulo]}


def matrix(name, values):
    """The columns of a matrix with one row a sample."""
    return [column(f"{name}[{at}]", values[:, at]) for at in range(values.shape[1])]


def table(name, *columns):
    return {"name": name, "columns": list(columns)}


def unread(name, what):
    """What is listed and cannot be read; the error has to hold the text `what`."""
    return {"name": name, "unread": what}


class Folder:
    """A folder of fixtures, and what is expected of each."""

    def __init__(self, name):
        self.path = Path(__file__).parent / "fixtures" / name
        self.path.mkdir(parents=True, exist_ok=True)
        self.expected = {}

    def expect(self, name, form, *tables, facts=None):
        self.expected[name] = {"format": form, "tables": tables, "facts": facts or {}}

    def expect_error(self, name, form, what):
        """The file cannot be opened; the error has to hold the text `what`."""
        self.expected[name] = {"format": form, "error": what}

    def close(self):
        """Writes what is expected, a fixture a line."""
        lines = [f"{json.dumps(name)}: {json.dumps(of)}" for name, of in self.expected.items()]
        text = "{\n" + ",\n".join(lines) + "\n}\n"
        (self.path / "expected.json").write_text(text)
