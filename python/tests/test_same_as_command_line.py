"""The same call gives the same numbers, to the last bit, here and on the command line."""

import numpy as np
import pandas
import pytest
import servoid as sv

FITS = [
    ("rec.csv", {}, ""),
    ("rec.csv", {"effects": ["coulomb"], "validate": "other.csv"}, "--with coulomb --validate other.csv"),
    ("rec.csv", {"effects": ["coulomb", "cogging"], "seed": 7}, "--with coulomb,cogging --seed 7"),
    ("rec.csv", {"algorithm": "pso", "budget": 400, "seed": 3}, "--algorithm pso --budget 400 --seed 3"),
    ("rec.csv", {"cost": "iae", "algorithm": "nelder_mead", "budget": 300}, "--cost iae --algorithm nelder_mead --budget 300"),
    ("rec.csv other.csv", {"effects": ["coulomb"], "own": ["coulomb.torque"]}, "--with coulomb --own coulomb.torque"),
]


def read(names: str) -> list[sv.Recording]:
    return [sv.read(name) for name in names.split()]


@pytest.mark.parametrize(("names", "options", "flags"), FITS)
def test_a_fit(desk, names, options, flags):
    options = {**options, "validate": read(options.get("validate", ""))}
    found = sv.fit(read(names), **options)
    assert found.to_dict() == desk.json(f"fit {names} {flags}")


def test_a_diagnosis(desk):
    found = sv.diagnose(sv.read("rec.csv"), validate=sv.read("other.csv"))
    assert found.to_dict() == desk.json("diagnose rec.csv --validate other.csv")
    assert found.named == ["coulomb"]
    assert found.verdict == "missing_effects"
    assert 0.5 < found.probability <= 1.0
    assert [row["added"] for row in found.table()] == [None, "coulomb"]
    errors = [row["validate_rms_counts"] for row in found.table()]
    assert errors[0] > 10 * errors[1]


def test_a_law_of_ones_own(desk):
    law = "drag:torque=-c*w*abs(w);c=1e-5in[0,1e-3]V*s^2/rad^2"
    found = sv.diagnose(sv.read("rec.csv"), validate=sv.read("other.csv"), laws=[law], discover=True)
    assert found.to_dict() == desk.json(f"diagnose rec.csv --validate other.csv --effect {law} --discover")
    assert found.proposed is None, "coulomb explains it: nothing is left to look for"
    fit = sv.fit(sv.read("rec.csv"), effects=[law])
    assert fit.to_dict()["model"]["formulas"] == [law]


def test_known_facts(desk):
    facts = {"resistance_ohm": (2.0, 0.05), "kt_equals_kb": True}
    found = sv.fit(sv.read("rec.csv"), known=facts)
    (desk.folder / "known.toml").write_text(
        (desk.folder / "motor.toml").read_text().split("[known]")[0]
        + "[known]\nresistance_ohm = { value = 2.0, tolerance = 0.05 }\nkt_equals_kb = true\n"
    )
    assert found.to_dict() == desk.json("fit rec.csv --motor known.toml")


def test_arrays_are_the_file():
    file = sv.read("rec.csv")
    table = pandas.read_csv("rec.csv", comment="#")
    arrays = sv.Recording(
        table["t_s"],
        voltage=table["voltage_v"],
        counts=table["angle_counts"],
        enabled=table["enabled"],
        counts_per_rev=file.counts_per_rev,
        supply_v=12.0,
        source="rec.csv",
    )
    known = {}
    assert sv.fit(arrays, known=known).to_dict() == sv.fit(file, known=known).to_dict()


def test_series_of_pandas_and_strided_arrays_are_columns():
    file = sv.read("rec.csv")
    table = pandas.DataFrame({"t": file.t, "u": file.command, "n": file.counts.astype(np.int64)})
    wide = np.repeat(table["u"].to_numpy(), 2)[::2]
    one = sv.Recording(table["t"], voltage=wide, counts=table["n"], counts_per_rev=file.counts_per_rev, source="rec.csv")
    assert np.array_equal(one.counts, file.counts)
    assert np.array_equal(one.command, file.command)
