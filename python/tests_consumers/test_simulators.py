"""bam, mjlab and Simscape's equations move as the bench does, but for the inductance, which the first two do not have."""

import ast
import functools
import importlib
import importlib.util
import json
import re
import sys
import types
from types import SimpleNamespace
from unittest import mock

import numpy as np
import pytest

from conftest import COUNTS, GEAR, PERIOD

OUTPUT = ("--side", "output", "--ratio", str(GEAR))
#: Steps between two readings.
STEPS = 10
#: Without its inductance a motor is ahead by the electrical time constant: counts at 700 rad/s and 0.26 ms.
AHEAD = 60.0


def motion_of(motion, step) -> np.ndarray:
    """The motor's angle at every reading, rad: `step(volts, speed, dt)` gives the speed after it, on the output's side."""
    angle, speed, angles = motion.angle[0], 0.0, [motion.angle[0]]
    dt = PERIOD / STEPS
    for volts in motion.voltage[:-1]:
        for _ in range(STEPS):
            speed = step(volts, speed, dt)
            angle += GEAR * speed * dt
        angles.append(angle)
    return np.array(angles)


def braked(speed: float, torque: float, friction: float, inertia: float, dt: float) -> float:
    """The speed after a torque and dry friction, which stops and does not turn round."""
    free = speed + torque * dt / inertia
    return float(np.sign(free) * max(abs(free) - friction * dt / inertia, 0.0))


@pytest.mark.parametrize(
    ("effect", "model", "key"),
    [
        (None, "m1", None),
        ("coulomb", "m1", "friction_base"),
        ("stribeck", "m2", "friction_stribeck"),
        ("load_friction", "m3", "load_friction_base"),
    ],
)
def test_bam_moves_as_the_bench_does(motor, tmp_path, effect, model, key):
    from bam.model import load_model
    from bam.simulate import Simulator

    one = motor(effect)
    text = one.text("bam", *OUTPUT)
    assert json.loads(text)["model"] == model
    assert effect is None or one.carried("bam", *OUTPUT)

    def off(values: dict) -> float:
        (tmp_path / "motor.json").write_text(json.dumps(values))
        servo = load_model(str(tmp_path / "motor.json"))
        # A shaft without a pendulum.
        zero = {name: lambda *_: 0.0 for name in ("compute_bias", "compute_mass")}
        servo.actuator.testbench = SimpleNamespace(**zero)
        simulator = Simulator(servo)

        def step(volts: float, speed: float, dt: float) -> float:
            simulator.dq = speed
            simulator.step(volts, True, dt)
            return float(simulator.dq)

        return one.motion.off(motion_of(one.motion, step))

    values = json.loads(text)
    with_it = off(values)
    assert with_it < AHEAD, with_it
    if key:
        without = off({**values, key: 0.0})
        assert with_it < 0.5 * without, (with_it, without)


@functools.cache
def mjlab():
    """mjlab's own classes, without what they compute on (torch, warp), which would be gigabytes."""
    found = importlib.util.find_spec("mjlab")
    if found is None:
        pytest.skip("CONSUMERS: mjlab is not installed")
    folder = found.submodule_search_locations[0]
    mocked = {name: mock.MagicMock() for name in ("torch", "mujoco_warp", "mjlab.utils.buffers", "mjlab.utils.spec")}
    for name in ("mjlab", "mjlab.actuator", "mjlab.utils"):
        mocked[name] = types.ModuleType(name)
        mocked[name].__path__ = [f"{folder}/{'/'.join(name.split('.')[1:])}"]
    mocked["torch"].clamp = lambda x, min=None, max=None: np.clip(x, min, max)
    sys.modules.update(mocked)
    module = importlib.import_module("mjlab.actuator.dc_actuator")
    mocked["mjlab.actuator"].DcMotorActuatorCfg = module.DcMotorActuatorCfg
    return module


@pytest.mark.parametrize("effect", [None, "coulomb", "voltage_sat"])
def test_mjlab_moves_as_the_bench_does(motor, effect):
    module = mjlab()
    one = motor(effect)
    assert effect is None or one.carried("mjlab", *OUTPUT)
    text = one.text("mjlab", *OUTPUT)
    names: dict = {}
    exec(compile(text, "motor.py", "exec"), names)
    cfg = names["MOTOR"]
    limits = (cfg.saturation_effort, cfg.velocity_limit, cfg.effort_limit)
    # As the remark says.
    constant, ratio = map(float, re.search(r"\(u - (\S+)\*w\)/(\S+),", text).groups())
    viscous, friction, inertia = cfg.viscous_damping, cfg.frictionloss or 0.0, cfg.armature

    def step(volts: float, speed: float, dt: float) -> float:
        torque = float(module.dc_motor_clip((volts - constant * speed) / ratio, *limits, speed))
        return braked(speed, torque - viscous * speed, friction, inertia, dt)

    off = one.motion.off(motion_of(one.motion, step))
    assert off < AHEAD, off


@pytest.mark.parametrize("effect", [None, "coulomb"])
def test_simscape_s_equations_move_as_the_bench_does(motor, effect):
    one = motor(effect)
    assert effect is None or one.carried("simscape", *OUTPUT)
    lines = [line for line in one.text("simscape", *OUTPUT).splitlines() if line and not line.startswith("%")]
    value = {name: float(number) for name, number in (re.fullmatch(r"motor\.(\w+) = (\S+); % .*", line).groups() for line in lines)}
    assert value["La"] / value["Ra"] == pytest.approx(one.found("electrical_time_constant"))
    friction = value.get("TC", 0.0)
    assert value.get("Tbrk", 0.0) == friction

    def step(volts: float, speed: float, dt: float) -> float:
        torque = value["K"] * (volts - value["K"] * speed) / value["Ra"] - value["Dm"] * speed
        return braked(speed, torque, friction, value["Jm"], dt)

    off = one.motion.off(motion_of(one.motion, step))
    assert off < AHEAD, off


def test_no_number_of_mjlab_s_file_is_an_expression(motor):
    tree = ast.parse(motor("coulomb").text("mjlab"))
    call = next(node for node in ast.walk(tree) if isinstance(node, ast.Call))
    for keyword in call.keywords:
        assert isinstance(ast.literal_eval(keyword.value), float | tuple), keyword.arg
