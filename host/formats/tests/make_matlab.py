"""Writes the fixtures of MATLAB's level 5 with SciPy (1.17): `python make_matlab.py`.

SciPy writes neither the other byte order nor objects: some fixtures are SciPy's own (BSD-3-Clause), which MATLAB wrote, and
`objects.mat` has objects in the bytes that MATLAB is known to write.
"""

import struct
from importlib.resources import files

import numpy as np
from expected import Folder, column, matrix, ramp, table, unread
from scipy.io import savemat

FOLDER = Folder("matlab")
RANDOM = np.random.default_rng(7)
N = 25
t = np.arange(N) * 0.01
u = RANDOM.normal(size=N)
x = RANDOM.normal(size=(N, 3))


def mat(name, variables, *tables, facts=None, **options):
    savemat(FOLDER.path / name, variables, **options)
    FOLDER.expect(name, "Matlab5", *tables, facts=facts)


def structs(*elements):
    """A struct array of one row."""
    dtype = [(name, object) for name in elements[0]]
    array = np.empty((1, len(elements)), dtype=dtype)
    for at, element in enumerate(elements):
        array[0, at] = tuple(element[name] for name in elements[0])
    return array


cells = np.empty((1, 3), dtype=object)
cells[0, 0], cells[0, 1], cells[0, 2] = u, 2 * u, "a text"
variables = {
    "t": t.reshape(-1, 1),
    "u": u.reshape(1, -1),
    "x": x,
    "wide": x.T,
    "few": np.arange(3.0),
    "gain": 2.5,
    "note": "größe",
    "on": np.array([True, False] * 12 + [True]),
    "deep": {
        "t": t[:9],
        "mass": np.int8(-3),
        "inner": {"a": u[:9], "b": 2 * u[:9], "c": u[:4], "name": "joint"},
        "empty": np.zeros((0, 0)),
    },
    "several": structs({"a": t, "b": u, "k": 1.0}, {"a": 2 * t, "b": 2 * u, "k": 2.0}),
    "cells": cells,
    "cube": np.zeros((2, 3, 4)),
    "thin": u.reshape(1, 1, N),
    "complex": t + 1j * u,
}
TABLES = [
    unread("cube", "reshape"),
    unread("complex", "real(x)"),
    table(
        "",
        column("t", t),
        column("u", u),
        *matrix("x", x),
        *matrix("wide", x),
        column("on", variables["on"], "Flag"),
        column("cells[0]", u),
        column("cells[1]", 2 * u),
        column("thin", u),
    ),
    table("few", column("few", [0, 1, 2])),
    table("deep.t", column("t", t[:9])),
    table("deep.inner", column("a", u[:9]), column("b", 2 * u[:9])),
    table("deep.inner.c", column("c", u[:4])),
    table("several[0]", column("a", t), column("b", u)),
    table("several[1]", column("a", 2 * t), column("b", 2 * u)),
]
FACTS = {
    "gain": "2.5",
    "note": "größe",
    "cells[2]": "a text",
    "deep.mass": "-3",
    "deep.inner.name": "joint",
    "several[0].k": "1",
    "several[1].k": "2",
}
mat("mixed.mat", variables, *TABLES, facts=FACTS)
mat("mixed_packed.mat", variables, *TABLES, facts=FACTS, do_compression=True)

kinds = {}
for kind in ["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"]:
    edge = np.iinfo(kind)
    kinds[kind] = np.array([edge.min, edge.max, 0, 1, 99], dtype=kind)
kinds["single"] = np.array([0, -1.5, np.nan, np.inf, 1e-40], dtype="f4")
kinds["double"] = np.array([0, -1.5, np.nan, -np.inf, 1e-310])
mat("kinds.mat", kinds, table("", *(column(name, values) for name, values in kinds.items())))

# Simulink, "Structure With Time": two signals, one of them of two values, and labels.
out = {
    "time": (t + 5).reshape(-1, 1),
    "signals": structs(
        {"values": u.reshape(-1, 1), "dimensions": 1.0, "label": "voltage", "blockName": "m/a"},
        {"values": x[:, :2], "dimensions": 2.0, "label": "", "blockName": "m/b"},
        {"values": x.T.reshape(3, 1, N, order="F"), "dimensions": 3.0, "label": "state", "blockName": "m/c"},
    ),
    "blockName": "m/scope",
}
facts = {"out.blockName": "m/scope"}
columns = [
    column("time", (t + 5) - (t + 5)[0], "Time"),
    column("voltage", u),
    *matrix("signals[1]", x[:, :2]),
    *matrix("state", x),
]
mat("simulink.mat", {"out": out}, table("out", *columns), facts=facts, do_compression=True)

ts = {
    "Time": t.reshape(-1, 1),
    "Data": x[:, :1],
    "TimeInfo": {"Units": "seconds", "Start": 0.0},
    "DataInfo": {"Units": "rad", "Interpolation": "linear"},
    "Name": "angle",
}
facts = {
    "ts.Name": "angle",
    "ts.TimeInfo.Units": "seconds",
    "ts.TimeInfo.Start": "0",
    "ts.DataInfo.Units": "rad",
    "ts.DataInfo.Interpolation": "linear",
}
columns = [column("Time", t, unit="seconds"), column("Data", x[:, 0], unit="rad")]
mat("timeseries.mat", {"ts": ts}, table("ts", *columns), facts=facts)

# As many rows as signals are few: the vector beside them says which axis is time.
short = RANDOM.normal(size=(2, 4))
mat("short.mat", {"t": t[:2], "y": short}, table("", column("t", t[:2]), *matrix("y", short)))

count = np.arange(9001)
long = {"a": count.astype("u2"), "b": np.stack([count % 17, count % 19], 1).astype("u1")}
columns = [ramp("a", 9001, 65536), ramp("b[0]", 9001, 17), ramp("b[1]", 9001, 19)]
mat("long_packed.mat", {"s": long}, table("s", *columns), do_compression=True)
columns = [ramp("w[0]", 9001, 17), ramp("w[1]", 9001, 19)]
mat("long_wide.mat", {"w": long["b"].T}, table("w", *columns), do_compression=True)



def copied(name, *tables, facts=None):
    made = files("scipy.io.matlab.tests") / "data" / name
    (FOLDER.path / name).write_bytes(made.read_bytes())
    FOLDER.expect(name, "Matlab5", *tables, facts=facts)


# The other order of bytes, as MATLAB 6.1 wrote it on a SPARC.
first = np.array([[1, 2, 3, 4, 5], [2, 0, 0, 0, 0], [3, 0, 0, 0, 0]])
copied("testmatrix_6.1_SOL2.mat", table("testmatrix", *matrix("testmatrix", first.T)))
turn = np.arange(9) * np.pi / 4
copied("testdouble_6.1_SOL2.mat", table("testdouble", column("testdouble", turn)))
facts = {"teststructnest.one": "1", "teststructnest.two.three": "number 3"}
copied("teststructnest_6.1_SOL2.mat", facts=facts)
copied("testsparse_6.1_SOL2.mat", unread("testsparse", "full(x)"))
facts = {f"testcellnest[{at}]": str(value) for at, value in [("0", 1), ("1][0", 2), ("1][1", 3), ("1][2][0", 4), ("1][2][1", 5)]}
copied("testcellnest_6.1_SOL2.mat", facts=facts)
# A function of MATLAB, which holds nothing.
copied("parabola.mat")


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def opaque(name, kind):
    """An object as MATLAB writes it: flags without axes, and the numbers of the object elsewhere."""
    flags = element(6, struct.pack("<II", 17, 0))
    names = b"".join(element(1, text) for text in (name, b"MCOS", kind))
    numbers = element(6, struct.pack("<II", 13, 0)) + element(5, struct.pack("<ii", 6, 1)) + element(1, b"")
    numbers += element(6, struct.pack("<6I", 0xDD000000, 2, 1, 1, 1, 1))
    return element(14, flags + names + element(14, numbers))


objects = [opaque(b"ts", b"timeseries"), opaque(b"T", b"timetable"), opaque(b"sim", b"Simulink.SimulationOutput")]
savemat(FOLDER.path / "objects.mat", {"t": t, "u": u})
with (FOLDER.path / "objects.mat").open("ab") as file:
    file.write(b"".join(objects))
FOLDER.expect(
    "objects.mat",
    "Matlab5",
    unread("ts", "struct('time', ts.Time, 'data', ts.Data)"),
    unread("T", "table2struct"),
    unread("sim", "Structure With Time"),
    table("", column("t", t), column("u", u)),
)

FOLDER.close()
