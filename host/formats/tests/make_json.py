"""Writes the fixtures of JSON with Python's own library: `python make_json.py`.

The layouts of SysId are those that `AnalysisManager.cpp` and `JSONConverter.cpp` of WPILib's SysId 2023 read.
"""

import json
import math

import numpy as np
from expected import Folder, column, matrix, ramp, table

FOLDER = Folder("json")
RANDOM = np.random.default_rng(13)
N = 12
t = np.arange(N) * 0.01
u = RANDOM.normal(size=N)
x = RANDOM.normal(size=(N, 3))


def document(name, value, *tables, facts=None, form="Json", **options):
    (FOLDER.path / name).write_text(json.dumps(value, **options) + "\n", encoding="utf-8")
    FOLDER.expect(name, form, *tables, facts=facts)


def lines(name, values, *columns, between="\n"):
    text = between.join(json.dumps(value) for value in values) + "\n"
    (FOLDER.path / name).write_text(text, encoding="utf-8")
    FOLDER.expect(name, "JsonLines", table("", *columns))


gaps = [math.nan if at % 3 else value for at, value in enumerate(u)]
arrays = {
    "mass": 0.49,
    "motor": "xl330",
    "on": True,
    "nothing": None,
    "t": t.tolist(),
    "u": u.tolist(),
    "gaps": gaps,
    "missing": [None if at % 2 else at for at in range(N)],
    "infinite": [math.inf, -math.inf] + [0] * (N - 2),
    "flags": [at % 2 == 0 for at in range(N)],
    "words": ["a"] * N,
    "x": x.tolist(),
    "wide": x.T.tolist(),
    "few": [1, 2, 3],
    "empty": [],
    "limits": {"low": [-1.0, -2.0], "high": [1.0, 2.0], "unit": "V"},
}
TABLES = [
    table(
        "",
        column("t", t),
        column("u", u),
        column("gaps", gaps),
        column("missing", [math.nan if at % 2 else at for at in range(N)]),
        column("infinite", [math.nan, math.nan] + [0] * (N - 2)),
        column("flags", [at % 2 == 0 for at in range(N)], "Flag"),
        column("words", None, "Text"),
        *matrix("x", x),
        *matrix("wide", x),
    ),
    table("few", column("few", [1, 2, 3])),
    table("limits", column("low", [-1, -2]), column("high", [1, 2])),
]
FACTS = {"mass": "0.49", "motor": "xl330", "on": "true", "limits.unit": "V"}
document("arrays.json", arrays, *TABLES, facts=FACTS)
document("arrays_indented.json", arrays, *TABLES, facts=FACTS, indent=2)

entries = [
    {"position": float(u[at]), "load": at - 4, "on": at > 3, "state": {"a": at, "b": [at, -at]}, "word": "w"} for at in range(N)
]
del entries[4]["load"]
entries[5]["late \"quoted\" NaN"] = 1
counts = np.arange(N)
ROWS = [
    column("position", u),
    column("load", [math.nan if at == 4 else at - 4 for at in range(N)]),
    column("on", counts > 3, "Flag"),
    column("state.a", counts),
    column("state.b[0]", counts),
    column("state.b[1]", -counts),
    column("word", None, "Text"),
    column("late \"quoted\" NaN", [1 if at == 5 else math.nan for at in range(N)]),
]
bam = {"mass": 0.49, "kp": 400, "motor": "xl330", "entries": entries}
document("entries.json", bam, table("entries", *ROWS), facts={"mass": "0.49", "kp": "400", "motor": "xl330"})
document("records.json", entries, table("", *ROWS))
lines("lines.jsonl", entries, *ROWS)
# Without ends of lines, and with a space where one may be.
lines("one_line.jsonl", entries, *ROWS, between=" ")
lines("lists.jsonl", x.tolist(), *matrix("", x))
lines("one.jsonl", [{"t": 0.5}, {"t": 1.5, "u": "NaN"}], column("t", [0.5, 1.5]), column("u", [math.nan, math.nan]))
document("matrix.json", x.tolist(), table("", *matrix("", x)))
document("vector.json", u.tolist(), table("", column("[0]", u)))
pandas = {"t": {str(at): float(t[at]) for at in range(N)}, "u": {str(at): float(u[at]) for at in range(N)}}
document("pandas.json", pandas, table("", column("t", t), column("u", u)))

# Longer in the first value than the first bytes, by which a format is told.
long = [{"k": at, "fill": "f" * 5000 if at == 0 else ""} for at in range(3)]
lines("long_line.jsonl", long, column("k", [0, 1, 2]), column("fill", None, "Text"))
many = [{"a": at % 7} for at in range(4097)]
lines("many.jsonl", many, ramp("a", 4097, 7))

(FOLDER.path / "mark.json").write_bytes(b"\xef\xbb\xbf" + json.dumps({"t": t.tolist()}).encode())
FOLDER.expect("mark.json", "Json", table("t", column("t", t)))
for name, text, what in [
    ("bad.json", '{"t": [1, 2,, 3]}', "line 1, column 13"),
    ("cut.json", '{"t": [1, 2', "in the middle of a value"),
    ("bad.jsonl", '{"t": 1}\n{"t": }\n', "line 2, column 7"),
]:
    (FOLDER.path / name).write_text(text)
    FOLDER.expect_error(name, "Json", what)

TESTS = ["fast-backward", "fast-forward", "slow-backward", "slow-forward"]
TURN = " (1 rotation = 6.283185307179586 Radians)"


def sysid(name, width, names, mark=True, tests=TESTS, kind="Simple"):
    rows = {test: RANDOM.normal(size=(9, width)) for test in tests}
    value = {test: values.tolist() for test, values in rows.items()}
    value |= {"test": kind, "units": "Radians", "unitsPerRotation": 6.283185307179586}
    facts = {"test": kind, "units": "Radians", "unitsPerRotation": "6.283185307179586"}
    if mark:
        value["sysid"] = True
        facts["sysid"] = "true"
    tables = []
    for test in tests:
        columns = []
        for at, label in enumerate(names):
            values = rows[test][:, at]
            if label == "time":
                columns.append(column(label, values - values[0], "Time", "s"))
                continue
            per = {"voltage": "V", "position": "rotations" + TURN, "velocity": "rotations/s" + TURN}
            columns.append(column(label, values, unit=per.get(label.split("_")[-1])))
        tables.append(table(test, *columns))
    document(name, value, *tables, facts=facts, form="SysId", indent=2)


sysid("sysid.json", 4, ["time", "voltage", "position", "velocity"])
both = ["left_voltage", "right_voltage", "left_position", "right_position", "left_velocity", "right_velocity"]
sysid("sysid_drivetrain.json", 9, ["time", *both, "angle", "angular_rate"], kind="Drivetrain")
old = ["time", "battery_voltage", "autospeed", *both, "gyro"]
sysid("characterization.json", 10, [name.removeprefix("left_") for name in old], mark=False)
sysid("characterization_drivetrain.json", 10, old, mark=False, kind="Drivetrain")
newer = ["quasistatic-forward", "quasistatic-reverse", "dynamic-forward", "dynamic-reverse"]
sysid("sysid_newer.json", 4, ["time", "voltage", "position", "velocity"], tests=newer)

FOLDER.close()
