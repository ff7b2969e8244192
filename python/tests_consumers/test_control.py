"""python-control, and compiled programs, move as the bench does; feed-forward asks for the volts that were given."""

import json
import re
import shutil
import subprocess

import control
import numpy as np
import pytest

from conftest import PERIOD, Motion


def numbers(one) -> dict:
    """What `--to json` says, by name."""
    return {row["name"]: row["value"] for row in json.loads(one.text("json"))["parameters"]}


def test_the_transfer_function_moves_as_the_bench_does(motor):
    one = motor()
    value = numbers(one)
    plant = control.tf([value["gain"]], [value["a2"], value["a1"], 1.0, 0.0])
    held = control.sample_system(plant, PERIOD, method="zoh")
    time = np.arange(len(one.motion.voltage)) * PERIOD
    _, angle = control.forced_response(held, time, one.motion.voltage)
    off = one.motion.off(np.asarray(angle) + one.motion.angle[0])
    assert off < 2.0, off


def test_the_transfer_function_steps_as_the_fit_says(motor):
    value = numbers(motor())
    speed = control.tf([value["gain"]], [value["a2"], value["a1"], 1.0])
    time, response = control.step_response(speed, T=np.linspace(0.0, 0.3, 3001))
    assert response[-1] == pytest.approx(value["gain"], rel=1e-4)
    # Two poles: 63 % are reached at a1, but for the fast one.
    reached = time[np.argmax(response > (1.0 - np.exp(-1.0)) * value["gain"])]
    assert reached == pytest.approx(value["a1"], rel=0.02)


C = """#include <stdio.h>
#include "motor.h"
int main(void) {
  double c = 0, w = 0, q = 0, v;
  while (scanf("%lf", &v) == 1) {
    printf("%.9g\\n", q);
    double dc = SERVOID_STEP_C_BY_C * c + SERVOID_STEP_C_BY_W * w + SERVOID_STEP_C_BY_V * v;
    double dw = SERVOID_STEP_W_BY_C * c + SERVOID_STEP_W_BY_W * w + SERVOID_STEP_W_BY_V * v;
    q += SERVOID_STEP_THETA_BY_C * c + SERVOID_STEP_THETA_BY_W * w + SERVOID_STEP_THETA_BY_V * v;
    c += dc;
    w += dw;
  }
  return 0;
}
"""
RUST = """#[path = "motor.rs"]
#[allow(dead_code)]
mod motor;
use motor::*;
fn main() {
    let (mut c, mut w, mut q) = (0.0f64, 0.0f64, 0.0f64);
    for line in std::io::stdin().lines() {
        let v: f64 = line.expect("a line").parse().expect("a number");
        println!("{q:.9}");
        let row = |by: [f32; 3]| f64::from(by[0]) * c + f64::from(by[1]) * w + f64::from(by[2]) * v;
        let dc = row([STEP_C_BY_C, STEP_C_BY_W, STEP_C_BY_V]);
        let dw = row([STEP_W_BY_C, STEP_W_BY_W, STEP_W_BY_V]);
        q += row([STEP_THETA_BY_C, STEP_THETA_BY_W, STEP_THETA_BY_V]);
        c += dc;
        w += dw;
    }
}
"""


@pytest.mark.parametrize(
    ("format", "ending", "program", "compiler"),
    [("c", "h", C, ["cc", "-o"]), ("rust", "rs", RUST, ["rustc", "-O", "--edition", "2021", "-o"])],
)
def test_a_compiled_program_moves_as_the_bench_does(motor, tmp_path, format, ending, program, compiler):
    if shutil.which(compiler[0]) is None:
        pytest.skip(f"CONSUMERS: no {compiler[0]} on this machine")
    one = motor()
    (tmp_path / f"motor.{ending}").write_text(one.text(format))
    source = tmp_path / ("main.c" if format == "c" else "main.rs")
    source.write_text(program)
    subprocess.run([*compiler, str(tmp_path / "main"), str(source)], check=True)
    volts = "".join(f"{v!r}\n" for v in one.motion.voltage.tolist())
    ran = subprocess.run([tmp_path / "main"], input=volts, capture_output=True, text=True, check=True).stdout
    off = one.motion.off(np.array([float(line) for line in ran.split()]) + one.motion.angle[0])
    # Single precision, for 4000 steps.
    assert off < 3.0, off


def test_wpilib_s_feed_forward_asks_for_the_volts_that_were_given(motor):
    one = motor("coulomb")
    text = one.text("wpilib")
    value = {name: float(number) for name, number in re.findall(r"double (\w+) = (\S+);", text)}
    # A slow triangle: what the winding adds with the jerk is small.
    slow = Motion.read(one.hidden("slow.csv", "triangle", 4.0))
    window = 20
    speed = (slow.angle[2 * window :] - slow.angle[: -2 * window]) / (2 * window * PERIOD)
    acceleration = np.gradient(speed, PERIOD)
    given = slow.voltage[window:-window]
    asked = value["kS"] * np.sign(speed) + value["kV"] * speed + value["kA"] * acceleration
    moving = np.abs(speed) > 20.0
    assert moving.sum() > 500
    off = np.sqrt(np.mean((asked - given)[moving] ** 2))
    assert off < 0.05 * np.abs(given).max(), off
