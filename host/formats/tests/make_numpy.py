"""Writes the fixtures of NumPy's formats with NumPy (2.4): `python make_numpy.py`."""

import numpy as np
from expected import Folder, column, matrix, ramp, table, unread

FOLDER = Folder("numpy")
RANDOM = np.random.default_rng(5)


def npy(name, array, *tables, version=None, **options):
    with (FOLDER.path / name).open("wb") as file:
        if version:
            np.lib.format.write_array(file, array, version=version)
        else:
            np.save(file, array, **options)
    FOLDER.expect(name, "Npy", *tables)


vector = RANDOM.normal(size=11)
rows = RANDOM.normal(size=(7, 3))
npy("vector.npy", vector, table("", column("[0]", vector)))
npy("vector_big.npy", vector.astype(">f4"), table("", column("[0]", vector.astype("f4"))))
npy("rows_c.npy", rows, table("", *matrix("", rows)))
npy("rows_fortran.npy", np.asfortranarray(rows), table("", *matrix("", rows)))
npy("wide_c.npy", rows.T.copy("C"), table("", *matrix("", rows)))
npy("wide_fortran.npy", rows.T.copy("F"), table("", *matrix("", rows)))
npy("square.npy", rows[:3], table("", *matrix("", rows[:3])))
npy("thin.npy", rows.reshape(1, 7, 1, 3), table("", *matrix("", rows)))
npy("version_2.npy", vector, table("", column("[0]", vector)), version=(2, 0))
npy("long.npy", (np.arange(9001) % 251).astype("u1"), table("", ramp("[0]", 9001, 251)))
npy("empty.npy", np.zeros((0, 3)))
npy("cube.npy", np.zeros((2, 3, 4)), unread("", "reshape"))

nanoseconds = np.array([1_700_000_000_123_456_789, 1_700_000_000_123_456_790, 0, -7], dtype="i8")
times = nanoseconds.astype("M8[ns]")
times[2] = np.datetime64("NaT")
since = [0.0, 1e-9, np.nan, (-7 - 1_700_000_000_123_456_789) / 1e9]
npy("times.npy", times, table("", column("[0]", since, "Time")))
tens = np.array([5, 6, 105], dtype="m8[10us]")
npy("durations_big.npy", tens.astype(">m8[10us]"), table("", column("[0]", [0.0, 1e-5, 1e-3], "Time")))
npy("months.npy", np.array(["2024-01", "2024-02"], dtype="M8[M]"), table("", column("[0]", None, "Text")))

record = np.dtype(
    [
        ("t", "<f8"),
        ("flag", "?"),
        ("counts", ">i4", (2,)),
        ("joint", [("angle", "<f4"), ("note", "<U3")]),
        ("grid", "<i2", (2, 2)),
        ("größe", "<u8"),
    ],
    align=True,
)
records = np.zeros(6, dtype=record)
records["t"] = np.arange(6) * 0.01
records["flag"] = [0, 1, 1, 0, 0, 1]
records["counts"] = RANDOM.integers(-(2**31), 2**31, size=(6, 2))
records["joint"]["angle"] = RANDOM.normal(size=6)
records["joint"]["note"] = "abc"
records["grid"] = RANDOM.integers(-9, 9, size=(6, 2, 2))
records["größe"] = [0, 1, 2**53 + 2, 2**64 - 2048, 5, 6]
STRUCTURED = [
    column("t", records["t"]),
    column("flag", records["flag"], "Flag"),
    *matrix("counts", records["counts"]),
    column("joint.angle", records["joint"]["angle"]),
    column("joint.note", None, "Text"),
    *(column(f"grid[{i}][{j}]", records["grid"][:, i, j]) for i in range(2) for j in range(2)),
    column("größe", records["größe"]),
]
npy("structured.npy", records, table("", *STRUCTURED))

np.save(FOLDER.path / "objects.npy", np.array([1, "two"], dtype=object), allow_pickle=True)
FOLDER.expect_error("objects.npy", "Npy", "Python objects")


def npz(name, save, arrays, *tables, facts=None):
    save(FOLDER.path / name, **arrays)
    FOLDER.expect(name, "Npz", *tables, facts=facts)



KINDS = ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "?"]
for order, letter in [("little", "<"), ("big", ">")]:
    arrays = {}
    for kind in KINDS:
        code = letter + kind
        if kind == "?":
            arrays[kind] = np.array([0, 1, 1, 0, 1], dtype="?")
        elif kind[0] == "f":
            arrays[kind] = np.array([0, -1.5, np.nan, np.inf, -6e-8], dtype=code)
        else:
            edge = np.iinfo(kind)
            arrays[kind] = np.array([edge.min, edge.max, 0, 1, 99], dtype=code)
    columns = [column(k, a, "Flag" if k == "?" else "Number") for k, a in arrays.items()]
    npz(f"kinds_{order}.npz", np.savez, arrays, table("", *columns))

t = np.arange(20) * 0.001
mixed = {
    "t": t,
    "x": RANDOM.normal(size=(20, 3)),
    "wide": RANDOM.normal(size=(2, 20)),
    "fortran": np.asfortranarray(RANDOM.normal(size=(20, 2))),
    "few": np.arange(4),
    "label": np.array(["a"] * 20),
    "records": records,
    "gain": np.float32(2.5),
    "note": "a motor",
    "count": 7,
    "on": np.bool_(True),
    "objects": np.array([{}, None], dtype=object),
    "cube": np.zeros((2, 2, 2)),
}
TABLES = [
    table(
        "",
        column("t", t),
        *matrix("x", mixed["x"]),
        *matrix("wide", mixed["wide"].T),
        *matrix("fortran", mixed["fortran"]),
        column("label", None, "Text"),
    ),
    table("few", column("few", mixed["few"])),
    table("records", *STRUCTURED),
    unread("cube", "reshape"),
    unread("objects", "Python objects"),
]
FACTS = {"gain": "2.5", "note": "a motor", "count": "7", "on": "true"}
for name, save in [("mixed_stored", np.savez), ("mixed_deflated", np.savez_compressed)]:
    npz(f"{name}.npz", save, mixed, *TABLES, facts=FACTS)

counts = np.arange(9001)
long = {"t": counts, "wide": np.stack([counts % 17, counts % 19]), "x": np.stack([counts % 23, counts % 29], 1)}
long = {name: array.astype("u2") for name, array in long.items()}
columns = [ramp("t", 9001, 65536), ramp("wide[0]", 9001, 17), ramp("wide[1]", 9001, 19)]
columns += [ramp("x[0]", 9001, 23), ramp("x[1]", 9001, 29)]
npz("long_deflated.npz", np.savez_compressed, long, table("", *columns))

npz(
    "two_lengths.npz",
    np.savez,
    {"a": t, "b": t[:5], "c": 2 * t, "d": 3 * t[:5], "e": t[:7]},
    table("", column("a", t), column("c", 2 * t)),
    table("b", column("b", t[:5]), column("d", 3 * t[:5])),
    table("e", column("e", t[:7])),
)

FOLDER.close()
