"""MuJoCo loads its export, and moves as the bench does, for every effect that the format claims to carry."""

import re

import mujoco
import numpy as np
import pytest

from conftest import COUNTS, PERIOD

#: Steps of MuJoCo between two readings. Its own error falls with them: LuGre's bristles and the winding are fast.
STEPS = 50
#: What the format says that it carries as a whole, with the counts RMS that the steps leave.
WHOLE = {None: 2.0, "coulomb": 3.0, "cogging": 3.0, "voltage_sat": 3.0, "lugre": 16.0}
#: What it carries in part.
PART = ["stribeck", "asym_coulomb"]


def run(xml: str, motion) -> np.ndarray:
    """The joint's angle at every reading, rad."""
    model = mujoco.MjModel.from_xml_string(xml)
    model.opt.timestep = PERIOD / STEPS
    model.opt.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    data = mujoco.MjData(model)
    data.qpos[0] = motion.angle[0]
    angles = [data.qpos[0]]
    for volts in motion.voltage[:-1]:
        data.ctrl[0] = volts
        mujoco.mj_step(model, data, nstep=STEPS)
        angles.append(data.qpos[0])
    return np.array(angles)


@pytest.mark.parametrize("effect", WHOLE)
def test_what_it_carries_moves_as_the_bench_does(motor, effect):
    one = motor(effect)
    assert effect is None or one.carried("mujoco"), one.export("mujoco")["cannot_carry"]
    off = one.motion.off(run(one.text("mujoco"), one.motion))
    assert off < WHOLE[effect], off


@pytest.mark.parametrize("effect", PART)
def test_what_it_carries_in_part_it_says_and_moves_nearer_with_it_than_without(motor, effect):
    one = motor(effect)
    lacks = one.export("mujoco")["cannot_carry"]
    assert any(lack["what"] == effect and "only in part" in lack["why"] for lack in lacks), lacks
    text = one.text("mujoco")
    without = re.sub(' frictionloss="[^"]*"', "", text)
    assert without != text
    with_it, none = (one.motion.off(run(xml, one.motion)) for xml in (text, without))
    assert with_it < 0.9 * none, (with_it, none)


def test_the_motor_without_dcmotor_moves_alike_but_for_its_inductance(motor):
    one = motor("coulomb")
    text = one.text("mujoco")
    general = re.search(r"<general [^>]*/>", text).group()
    text = re.sub(r"<dcmotor [^>]*/>", general, text)
    # At every speed it is late by the electrical time constant.
    late = one.found("electrical_time_constant") * 700.0 * COUNTS / (2.0 * np.pi)
    off = one.motion.off(run(text, one.motion))
    assert off < late, (off, late)


def test_the_output_of_a_gear_moves_as_the_motor_does(motor):
    one = motor("coulomb")
    here = run(one.text("mujoco"), one.motion)
    there = run(one.text("mujoco", "--side", "output", "--ratio", "30"), one.motion)
    # Both begin at the angle of the motor's recording.
    here, there = here - here[0], 30.0 * (there - there[0])
    assert np.abs(here - there).max() < 0.02 * np.ptp(here)
