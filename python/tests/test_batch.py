"""`servoid batch`, with files that another library writes and reads."""

import json

import numpy as np
import pandas
import pytest
import servoid as sv


def lot(recordings, **columns):
    """A Parquet file of recordings, one a row."""
    rows = [
        {
            "unit": f"unit {k}",
            "t_s": one.t,
            "voltage_v": one.command,
            "angle_counts": one.counts,
            "counts_per_rev": one.counts_per_rev,
            **columns,
        }
        for k, one in enumerate(recordings)
    ]
    return pandas.DataFrame(rows)


@pytest.mark.parametrize("whole", [np.float64, np.int64, np.int32])
def test_recordings_of_a_parquet_file_are_fitted_as_arrays_are(desk, tmp_path, whole):
    recordings = [sv.read("rec.csv"), sv.read("other.csv"), sv.read("rec.csv").between(1.0, 5.0)]
    # The same samples under another name are a row of their own.
    recordings.append(recordings[0])
    table = lot(recordings)
    table["angle_counts"] = [counts.astype(whole) for counts in table["angle_counts"]]
    table.to_parquet(tmp_path / "lot.parquet", row_group_size=2)
    command = f"batch {tmp_path}/lot.parquet --do fit --with coulomb --out {tmp_path}/out --table {tmp_path}/table.parquet"
    done = desk.json(command)
    assert [done["recordings"], done["made"], done["errors"]] == [4, 4, 0]
    assert desk.json(command)["made"] == 0
    found = pandas.read_parquet(tmp_path / "table.parquet")
    assert list(found["unit"]) == ["unit 0", "unit 1", "unit 2", "unit 3"]
    assert set(found["status"]) == {"ok"}
    for row, one in zip(found.itertuples(), recordings, strict=True):
        arrays = sv.Recording(
            one.t, voltage=one.command, counts=one.counts, counts_per_rev=one.counts_per_rev, source=row.unit
        )
        fit = sv.fit(arrays, effects=["coulomb"])
        assert json.loads(row.result) == fit.to_dict()
        assert row.rms_counts == fit.rms_counts
        values = {entry["name"]: entry["value"] for entry in row.parameters}
        assert values == {name: parameter.value for name, parameter in fit.params.items()}


def test_what_is_wrong_with_a_row_is_a_row(desk, tmp_path):
    good = sv.read("rec.csv").between(0.0, 3.0)
    table = pandas.concat([lot([good]), lot([good], motor="counts_per_rev = no")], ignore_index=True)
    table.at[1, "unit"] = "wrong"
    table.to_parquet(tmp_path / "lot.parquet")
    done = desk.json(f"batch {tmp_path}/lot.parquet --do fit --out {tmp_path}/out --table {tmp_path}/table.parquet")
    assert [done["made"], done["errors"]] == [2, 1]
    found = pandas.read_parquet(tmp_path / "table.parquet").set_index("unit")
    assert found.loc["wrong", "cause"] == "motor"
    assert "this is not TOML" in found.loc["wrong", "message"]
    assert found.loc["unit 0", "status"] == "ok"


def test_a_file_without_the_columns_says_which(desk, tmp_path):
    pandas.DataFrame({"time": [[0.0, 1.0]]}).to_parquet(tmp_path / "other.parquet")
    with pytest.raises(AssertionError, match="t_s"):
        desk.run(f"batch {tmp_path}/other.parquet --out {tmp_path}/out")


def test_a_batch_in_python_goes_on_with_one_of_the_command_line(desk, tmp_path):
    recordings = [sv.read("rec.csv"), sv.read("other.csv"), sv.read("rec.csv").between(1.0, 5.0)]
    lot(recordings, serial="A7", station="3").to_parquet(tmp_path / "lot.parquet", row_group_size=1)
    desk.json(f"batch {tmp_path}/lot.parquet --do fit --shard 1/3 --out {tmp_path}/out")
    done = sv.batch(tmp_path / "lot.parquet", tmp_path / "out", do="fit", table=tmp_path / "table.parquet")
    assert (done.recordings, done.there, done.made, done.errors, done.interrupted) == (3, 1, 2, 0, False)
    found = pandas.read_parquet(tmp_path / "table.parquet")
    assert [labels["serial"] for labels in found["labels"]] == ["A7"] * 3
    runs = sorted((tmp_path / "out" / "runs").glob("*.json"))
    runs = [json.loads(run.read_text()) for run in runs]
    assert sum(part["rows"] for run in runs for part in run["parts"]) == 3
    assert [run["done"]["made"] for run in runs] == [1, 2]


def test_what_a_batch_cannot_do_says_why(tmp_path):
    with pytest.raises(sv.UsageError, match="shard"):
        sv.batch(tmp_path, tmp_path / "out", shard="3/2")
    with pytest.raises(sv.Error, match="no CSV file"):
        sv.batch(tmp_path, tmp_path / "out")
