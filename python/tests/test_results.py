"""What results can do."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pandas
import pytest
import servoid as sv


@pytest.fixture(scope="module")
def fitted(desk):
    return sv.fit(sv.read(desk.folder / "rec.csv"), effects=["coulomb"], validate=sv.read(desk.folder / "other.csv"))


def test_parameters_have_values_errors_and_units(fitted):
    torque = fitted.params["coulomb.torque"]
    assert torque.identifiable and torque.unit and 0 < torque.std < 0.1 * torque.value
    assert fitted.effects == ["coulomb"]
    assert fitted.validate_rms_counts < 1.0
    assert "coulomb" in fitted.summary()
    assert repr(fitted).startswith("<servoid.Fit coulomb: ")


def test_the_residual_is_the_error_that_is_stated(fitted):
    residual = fitted.residual()
    assert residual.dtype == np.float64
    assert np.sqrt(np.mean(residual**2)) == pytest.approx(fitted.rms_counts, rel=1e-9)


def test_simulation_repeats_the_fitted_run(fitted):
    recording = sv.read("rec.csv")
    model = fitted.model
    start = model.to_dict()
    assert start["effects"] == ["coulomb"] == model.effects
    table = pandas.read_csv("rec.csv", comment="#")
    run = model.simulate(
        recording.t, recording.command, enabled=table["enabled"], start_speed=start["start_speed_rad_s"]
    )
    error = run - recording.counts
    departs = (error - error.mean()) - (fitted.residual() - fitted.residual().mean())
    assert np.abs(departs).max() < 1e-6


def test_a_batch_is_its_rows(fitted):
    time = np.arange(2000) * 1e-3
    commands = np.stack([volts * np.sign(np.sin(7 * time)) for volts in (2.0, 5.0, 11.0)])
    together = fitted.model.simulate(time, commands)
    assert together.shape == commands.shape
    for row, command in zip(together, commands, strict=True):
        assert np.array_equal(row, fitted.model.simulate(time, command))
    assert np.array_equal(fitted.model.simulate(time, 0 * time), 0 * time)


def test_pages_and_drawings(fitted, tmp_path):
    page = fitted.to_html(tmp_path / "fit.html")
    assert (tmp_path / "fit.html").read_text(encoding="utf-8") == page
    assert "http-equiv" in page and "coulomb" in page
    assert ElementTree.fromstring(fitted.plot()._repr_svg_()).tag.endswith("svg")
    assert fitted._repr_html_().startswith("<pre>")


def test_exports(fitted, tmp_path):
    with pytest.raises(sv.Error, match="torques") as caught:
        fitted.model.to_mujoco()
    assert caught.value.cause == "export"
    known = sv.fit(sv.read("rec.csv"), effects=["coulomb"], known={"resistance_ohm": 2.0, "kt_equals_kb": True})
    ElementTree.fromstring(known.model.to_mujoco())
    assert fitted.model.export("toml", tmp_path / "motor.toml") == (tmp_path / "motor.toml").read_text(encoding="utf-8")
    with pytest.raises(sv.UsageError, match="known are"):
        fitted.model.export("excel")


def test_a_model_comes_back_from_its_file(desk, fitted):
    (desk.folder / "fit.json").write_text(fitted.json)
    again = sv.Model.read("fit.json")
    assert again.json == fitted.model.json


def test_python_control_has_the_same_linear_motor():
    import control

    linear = sv.fit(sv.read("rec.csv")).model
    time = np.arange(1500) * 1e-3
    volts = np.full_like(time, 6.0)
    _, outputs = control.forced_response(linear.to_control(), time, volts)
    counts = outputs[1] / (2 * np.pi) * sv.read("rec.csv").counts_per_rev
    assert np.abs(counts - linear.simulate(time, volts)).max() < 0.01 * counts.max()
