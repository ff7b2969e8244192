"""URDF, YAML, Modelica and the settings of drives go through parsers of their programs, where there are any."""

import re
import shutil
import subprocess
from types import SimpleNamespace

import numpy as np
import pytest
import yaml

from conftest import OHM, PERIOD

#: The bench's gearmotor.
KB, INERTIA, HENRY = 0.017, 3.2e-6, 6.0e-4
PAIRS = ("--pole-pairs", "7")


def test_urdf_is_read_by_a_parser(motor, tmp_path):
    import yourdfpy

    one = motor("coulomb")
    dynamics = re.search(r"<dynamics[^>]*/>", one.text("urdf")).group()
    (tmp_path / "robot.urdf").write_text(
        f'<robot name="r"><link name="a"/><link name="b"/><joint name="shaft" type="continuous"><parent link="a"/><child link="b"/>'
        f'<axis xyz="0 0 1"/>{dynamics}</joint></robot>'
    )
    read = yourdfpy.URDF.load(str(tmp_path / "robot.urdf")).joint_map["shaft"].dynamics
    assert float(read.damping) == pytest.approx(1e-6, rel=1e-2)
    assert float(read.friction) == pytest.approx(one.found("coulomb.torque"), rel=1e-6)


def test_ros_s_yaml_is_read_and_its_controller_holds_the_speed(motor):
    one = motor("coulomb")
    read = yaml.safe_load(one.text("ros2-control"))
    manager = read["controller_manager"]["ros__parameters"]
    assert manager["update_rate"] == 1000
    (name,) = (key for key in manager if key != "update_rate")
    assert manager[name]["type"] == "pid_controller/PidController"
    own = read[name]["ros__parameters"]
    assert own["reference_and_state_interfaces"] == ["velocity"]
    (joint,) = own["dof_names"]
    gain = own["gains"][joint]
    assert all(isinstance(value, float) for value in gain.values()), gain

    # control_toolbox's Pid on the motor: the error of the last reading, the integral clamped.
    steps, inner, reference = 1000, 50, 100.0
    dt = PERIOD / inner
    speed = current = integral = angle = before = 0.0
    friction, volts, speeds = one.found("coulomb.torque"), 0.0, []
    for _ in range(steps):
        read_speed = (angle - before) / PERIOD
        before = angle
        error = reference - read_speed
        integral = np.clip(integral + gain["i"] * PERIOD * error, gain["i_clamp_min"], gain["i_clamp_max"])
        asked = gain["p"] * error + integral + gain["feedforward_gain"] * reference
        for _ in range(inner):
            current += dt * (volts - KB * speed - OHM * current) / HENRY
            speed = speed + dt * (KB * current - 1e-6 * speed - np.sign(speed) * friction) / INERTIA
            angle += dt * speed
        # What was computed acts a period later.
        volts = float(np.clip(asked, -12.0, 12.0))
        speeds.append(speed)
    speeds = np.array(speeds)
    assert abs(speeds[-1] / reference - 1.0) < 0.01, speeds[-1]
    assert speeds.max() < 1.5 * reference, speeds.max()


class Device(SimpleNamespace):
    """What takes any setting, as `odrivetool` does, and keeps it."""

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        setattr(self, name, Device())
        return getattr(self, name)


def test_odrive_s_lines_run_and_are_a_phase_s(motor):
    device = Device()
    exec(compile(motor().text("odrive", *PAIRS, "--sample", "125e-6"), "odrive.py", "exec"), {"odrv0": device})
    axis = device.axis0
    assert axis.config.motor.pole_pairs == 7
    assert axis.config.motor.phase_resistance == pytest.approx(OHM / 2)
    assert axis.config.motor.phase_inductance == pytest.approx(HENRY / 2, rel=1e-2)
    kv = 60.0 / (2.0 * np.pi * KB)
    assert axis.config.motor.torque_constant == pytest.approx(8.27 / kv, rel=2e-3)
    assert axis.controller.config.inertia == pytest.approx(2.0 * np.pi * INERTIA, rel=1e-3)
    assert axis.controller.config.vel_gain > 0.0 < axis.controller.config.vel_integrator_gain


def test_vesc_s_script_sets_a_phase_in_its_units(motor):
    lines = [line.split(";")[0].strip() for line in motor().text("vesc", *PAIRS).splitlines()]
    forms = [re.fullmatch(r"\(conf-set '([a-z-]+) (\S+)\)", line).groups() for line in lines if line]
    value = {name: float(number) for name, number in forms}
    assert value["foc-motor-r"] == pytest.approx(1e3 * OHM / 2)
    assert value["foc-motor-l"] == pytest.approx(1e6 * HENRY / 2, rel=1e-2)
    assert value["foc-motor-flux-linkage"] == pytest.approx(1e3 * KB / np.sqrt(3.0) / 7, rel=1e-3)
    assert value["si-motor-poles"] == 14


def test_moteus_s_file_sets_a_phase_in_its_units(motor):
    lines = [line.split("#")[0].strip() for line in motor().text("moteus", *PAIRS).splitlines()]
    value = {name: float(number) for name, number in (line.split() for line in lines if line)}
    assert value["motor.poles"] == 14
    assert value["motor.resistance_ohm"] == pytest.approx(OHM / 2)
    assert value["motor.inductance_q_H"] == pytest.approx(HENRY / 2, rel=1e-2)
    assert value["motor.Kv"] == pytest.approx(60.0 / (2.0 * np.pi * KB), rel=1e-3)


def test_modelica_s_record_is_parsed(motor):
    from pymoca import parser

    one = motor("coulomb")
    tree = parser.parse(one.text("modelica"))
    symbols = tree.classes["Motor"].symbols

    def values(name: str) -> dict:
        given = (argument.value for argument in symbols[name].class_modification.arguments)
        return {one.component.name: one.modifications[0].value for one in given}

    assert values("inertia") == {"value": pytest.approx(INERTIA, rel=1e-3)}
    assert values("gain") == {"unit": "rad/(s.V)", "value": pytest.approx(one.found("gain"))}
    assert "coulomb_torque" in symbols


def test_modelica_s_record_is_loaded_by_openmodelica(motor, tmp_path):
    if shutil.which("omc") is None:
        pytest.skip("CONSUMERS: no OpenModelica (omc) on this machine; the record is only parsed")
    (tmp_path / "motor.mo").write_text(motor("coulomb").text("modelica"))
    script = 'loadModel(Modelica); loadFile("motor.mo"); checkModel(Motor); getErrorString();'
    (tmp_path / "check.mos").write_text(script)
    said = subprocess.run(["omc", "check.mos"], cwd=tmp_path, capture_output=True, text=True).stdout
    assert "completed successfully" in said and "Error" not in said, said
