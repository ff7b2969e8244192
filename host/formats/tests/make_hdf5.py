"""Writes the fixtures of HDF5 with h5py (3.16), and of MATLAB 7.3 with hdf5storage (0.2): `python make_hdf5.py`.

hdf5storage writes no struct arrays: `simulink_73.mat` has one as MATLAB writes it, by references. `testhdf5_7.4_GLNX86.mat`
is one of SciPy's tests (BSD-3-Clause), which MATLAB wrote.
"""

from importlib.resources import files

import h5py
import hdf5storage
import numpy as np
from expected import Folder, column, matrix, ramp, table, unread

FOLDER = Folder("hdf5")
RANDOM = np.random.default_rng(11)
N = 25
t = np.arange(N) * 0.01
u = RANDOM.normal(size=N)
x = RANDOM.normal(size=(N, 3))

record = np.dtype([("t", "f8"), ("counts", ">i4", (2,)), ("joint", [("angle", "f4"), ("on", "?")]), ("note", "S3")])
records = np.zeros(6, dtype=record)
records["t"] = np.arange(6) * 0.01
records["counts"] = RANDOM.integers(-(2**31), 2**31, size=(6, 2))
records["joint"]["angle"] = RANDOM.normal(size=6)
records["joint"]["on"] = [0, 1, 1, 0, 0, 1]
records["note"] = b"abc"
count = np.arange(9001)

for version, libver in [("old", ("earliest", "v108")), ("new", ("latest", "latest"))]:
    name = f"mixed_{version}.h5"
    with h5py.File(FOLDER.path / name, "w", libver=libver) as file:
        file["u"] = u
        file["t"] = t
        file["t"].attrs["units"] = "s"
        file["note"] = "a motor"
        file["gain"] = 2.5
        packed = {"compression": "gzip", "shuffle": True, "fletcher32": True}
        file.create_dataset("x", data=x, chunks=(8, 2), maxshape=(None, 3), **packed)
        demo = file.create_group("data/demo_0")
        demo["obs/wide"] = x.T
        demo["actions"] = x.astype("f2")
        demo["big"] = u.astype(">f4")
        demo["done"] = np.arange(N) % 2 == 0
        demo["words"] = ["a", "b"]
        demo["image"] = np.zeros((3, 4, 5), dtype="u1")
        demo["complex"] = t + 1j * u
        file["records"] = records
        long = file.create_group("long")
        long.create_dataset("a", data=count.astype("u2"), chunks=(1000,), **packed)
        long.create_dataset("b", data=np.stack([count % 17, count % 19], 1).astype("u1"), chunks=(4000, 1), **packed)
        long.create_dataset("c", data=np.stack([count % 23, count % 29]).astype("u1"), chunks=(1, 5000), **packed)
        file["the_same"] = h5py.SoftLink("/data")
        file["nowhere"] = h5py.SoftLink("/missing")
        file["elsewhere"] = h5py.ExternalLink("other.h5", "/a")
    tables = [
        table(
            "records",
            column("t", records["t"]),
            *matrix("counts", records["counts"]),
            column("joint.angle", records["joint"]["angle"]),
            column("joint.on", records["joint"]["on"], "Flag"),
            column("note", None, "Text"),
        ),
        table("", column("t", t, unit="s"), column("u", u), *matrix("x", x)),
        unread("data/demo_0/complex", "real(x)"),
        unread("data/demo_0/image", "reshape"),
        table(
            "data/demo_0",
            *matrix("actions", x.astype("f2")),
            column("big", u.astype("f4")),
            column("done", np.arange(N) % 2 == 0, "Flag"),
        ),
        table("data/demo_0/obs/wide", *matrix("wide", x)),
        table(
            "long",
            ramp("a", 9001, 65536),
            ramp("b[0]", 9001, 17),
            ramp("b[1]", 9001, 19),
            ramp("c[0]", 9001, 23),
            ramp("c[1]", 9001, 29),
        ),
    ]
    FOLDER.expect(name, "Hdf5", *tables, facts={"gain": "2.5", "note": "a motor"})

name = "mixed_73.mat"
path = FOLDER.path / name
path.unlink(missing_ok=True)
cells = np.empty(3, dtype=object)
cells[0], cells[1], cells[2] = u, 2 * u, "a text"
variables = {
    "t": t.reshape(-1, 1),
    "u": u.reshape(1, -1),
    "x": x,
    "few": np.arange(3.0),
    "gain": 2.5,
    "note": "größe",
    "on": t > 0.1,
    "deep": {"t": t[:9], "mass": np.int8(-3), "inner": {"a": u[:9], "b": 2 * u[:9], "name": "joint"}},
    "cells": cells,
    "complex": t + 1j * u,
    "empty": np.zeros((0, 0)),
}
hdf5storage.savemat(str(path), variables, format="7.3", oned_as="column", store_python_metadata=False)
FOLDER.expect(
    name,
    "Hdf5",
    unread("complex", "real(x)"),
    table(
        "",
        column("cells[0]", u),
        column("cells[1]", 2 * u),
        column("on", t > 0.1, "Flag"),
        column("t", t),
        column("u", u),
        *matrix("x", x),
    ),
    table("few", column("few", [0, 1, 2])),
    table("deep.t", column("t", t[:9])),
    table("deep.inner", column("a", u[:9]), column("b", 2 * u[:9])),
    facts={"cells[2]": "a text", "gain": "2.5", "note": "größe", "deep.mass": "-3", "deep.inner.name": "joint"},
)


def matlab(group, name, values, kind="double", **attributes):
    """An array as MATLAB writes it: its axes in the opposite order."""
    made = group.create_dataset(name, data=np.atleast_2d(values).T if values.ndim > 1 else values.reshape(1, -1))
    made.attrs["MATLAB_class"] = np.bytes_(kind)
    for attribute, value in attributes.items():
        made.attrs[attribute] = value
    return made


def letters(group, name, text):
    values = np.array([ord(letter) for letter in text], dtype="u2")
    made = group.create_dataset(name, data=values.reshape(-1, 1))
    made.attrs["MATLAB_class"] = np.bytes_("char")
    made.attrs["MATLAB_int_decode"] = np.int32(2)
    return made


name = "simulink_73.mat"
path = FOLDER.path / name
with h5py.File(path, "w", userblock_size=512, libver="earliest") as file:
    refs = file.create_group("#refs#")
    out = file.create_group("out")
    out.attrs["MATLAB_class"] = np.bytes_("struct")
    matlab(out, "time", t + 5)
    letters(out, "blockName", "m/scope")
    signals = out.create_group("signals")
    signals.attrs["MATLAB_class"] = np.bytes_("struct")
    values = [matlab(refs, "a", u), matlab(refs, "b", x)]
    labels = [letters(refs, "c", "voltage"), letters(refs, "d", "state")]
    for field, members in [("values", values), ("label", labels)]:
        made = signals.create_dataset(field, (2, 1), dtype=h5py.ref_dtype)
        for at, member in enumerate(members):
            made[at, 0] = member.ref
    matlab(file, "ts", np.arange(6, dtype="u4"), "timeseries", MATLAB_object_decode=np.int32(3))
text = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Thu Nov 26 12:00:00 2026 HDF5 schema 1.00 ."
with path.open("r+b") as file:
    file.write(text.ljust(124) + b"\x00\x02IM")
FOLDER.expect(
    name,
    "Hdf5",
    unread("ts", "struct('time', ts.Time, 'data', ts.Data)"),
    table("out", column("time", (t + 5) - (t + 5)[0], "Time"), column("voltage", u), *matrix("state", x)),
    facts={"out.blockName": "m/scope"},
)

name = "testhdf5_7.4_GLNX86.mat"
made = files("scipy.io.matlab.tests") / "data" / name
(FOLDER.path / name).write_bytes(made.read_bytes())
# Of a version of HDF5's layout that MATLAB wrote until 2008.
FOLDER.expect(name, "Hdf5", unread("testdouble", "-v7"))

FOLDER.close()
