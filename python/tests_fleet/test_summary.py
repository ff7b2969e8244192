"""What the results of a batch say of all motors together."""

import json

import pandas
import pytest
import servoid as sv
from conftest import UNITS
from servoid import fleet


def test_of_a_folder_of_results(lot, tmp_path):
    out = tmp_path / "out"
    fleet.run(lot, out, do="fit", effects=["coulomb"])
    found = fleet.summary(out)
    said = found.to_dict()
    assert said == json.loads(found.json)
    assert (said["schema"], said["recordings"], said["motors"]) == ("servoid.fleet/1", UNITS, UNITS)
    assert said["refused"] == []
    friction = next(one for one in said["quantities"] if one["name"] == "coulomb.torque")
    assert friction["recordings"] == UNITS and friction["low"] < friction["median"] < friction["high"]
    assert repr(found) == f"<servoid.fleet.Summary of {UNITS} recordings, {len(said['odd'])} of them odd>"
    page = found.to_html(tmp_path / "fleet.html")
    assert page == (tmp_path / "fleet.html").read_text(encoding="utf-8") == found.to_html()
    assert page.startswith("<!doctype html>") and "coulomb" in page

    # Two recordings a motor.
    labels = pandas.DataFrame({"unit": [f"unit {k:03}" for k in range(UNITS)], "serial": [k // 2 for k in range(UNITS)]})
    labels.to_csv(tmp_path / "labels.csv", index=False)
    assert fleet.summary(out, labels=tmp_path / "labels.csv").to_dict()["motors"] == UNITS // 2


def test_of_a_folder_without_results(tmp_path):
    with pytest.raises(sv.Error):
        fleet.summary(tmp_path)
