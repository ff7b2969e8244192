"""Motors drawn from a population, and a fit's covariance."""

import importlib.util
import json

import numpy as np
import pandas
import pytest
import servoid as sv


@pytest.fixture
def lot(desk, tmp_path):
    """Results of motors whose friction differs by a tenth."""
    frictions = 0.003 * np.exp(0.1 * np.random.default_rng(4).standard_normal(24))
    rows = []
    for number, friction in enumerate(frictions):
        desk.run(f"simulate --seconds 3 --hide coulomb:torque={friction} --seed {number} --out {tmp_path}/{number}.csv")
        one = sv.read(tmp_path / f"{number}.csv")
        row = {"unit": f"{number}", "t_s": one.t, "voltage_v": one.command, "angle_counts": one.counts}
        rows.append(row | {"counts_per_rev": one.counts_per_rev, "lot": f"{number % 2}"})
    pandas.DataFrame(rows).to_parquet(tmp_path / "lot.parquet", row_group_size=5)
    sv.batch(tmp_path / "lot.parquet", tmp_path / "results", do="fit", effects=["coulomb"])
    return tmp_path / "results", frictions


def test_a_population_is_the_command_lines_and_so_are_its_draws(desk, lot, tmp_path):
    results, frictions = lot
    population = sv.population(results)
    assert population.to_dict() == desk.json(f"population {results}")
    # One of 24 may lie far enough out to be called odd.
    assert population.motors >= 23
    spread = population.std["coulomb.torque"] / population.mean["coulomb.torque"]
    assert spread == pytest.approx(np.std(np.log(frictions), ddof=1), rel=0.2)
    drawn = population.draw(2000, seed=3)
    (tmp_path / "population.json").write_text(population.json)
    for to in ("npz", "parquet"):
        desk.run(f"draw {tmp_path}/population.json -n 2000 --seed 3 --to {to} --out {tmp_path}/motors.{to}")
    arrays = np.load(tmp_path / "motors.npz")
    table = pandas.read_parquet(tmp_path / "motors.parquet")
    assert set(arrays) == set(drawn) == set(table.columns)
    for name, values in drawn.items():
        assert np.array_equal(arrays[name], values)
        assert np.array_equal(table[name], values)
    friction = drawn["coulomb.torque"]
    assert np.mean(friction) == pytest.approx(population.mean["coulomb.torque"], rel=0.02)
    assert np.std(friction) == pytest.approx(population.std["coulomb.torque"], rel=0.1)
    covariance = population.covariance
    assert covariance.shape == (len(population.names),) * 2
    assert np.array_equal(covariance, covariance.T)


def test_what_is_no_population_is_refused():
    with pytest.raises(sv.UsageError, match="servoid population"):
        sv.Population(json.dumps({"schema": "servoid.fit/1"}))


def test_a_fit_states_the_covariance_of_what_it_searched_for(desk):
    fit = sv.fit(sv.read("rec.csv"), effects=["coulomb"])
    names, covariance = fit.covariance
    assert {"gain", "a1", "coulomb.torque"} <= set(names)
    for name, variance in zip(names, np.diag(covariance), strict=True):
        assert np.sqrt(variance) == pytest.approx(fit.params[name].std, rel=1e-9)
    assert np.linalg.eigvalsh(covariance / np.sqrt(np.outer(*[np.diag(covariance)] * 2))).min() > -1e-9


@pytest.mark.skipif(importlib.util.find_spec("arviz") is not None, reason="arviz is installed")
def test_what_needs_arviz_says_so(desk):
    with pytest.raises(ImportError, match="pip install arviz"):
        sv.fit(sv.read("rec.csv")).to_inference_data()
