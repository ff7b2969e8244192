//! An eccentric mass on a horizontal shaft.

use super::{At, Effect, Kind, Param, cosine_and_sine};
use std::f64::consts::PI;

/// T = −m·g·e·sin(θ + φ): gravity on a mass m at the distance e from the axis; φ is the angle of the
/// mass above its lowest point when θ = 0. The mass adds nothing to the inertia: the machine's inertia
/// is taken to contain it.
struct Unbalance {
    torque_n_m: f64,
    phase_rad: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "unbalance",
    about: "gravity on an eccentric mass, once per revolution",
    electrical: None,
    params: &[
        Param {
            name: "torque",
            unit: "N*m",
            about: "largest torque m·g·e",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.03 * machine.stall_torque_n_m(),
        },
        Param {
            name: "phase",
            unit: "rad",
            about: "angle of the mass from its lowest point at shaft angle zero",
            scales: false,
            range: (-10.0, 10.0),
            typical: |_| 1.1,
        },
    ],
    other_laws: &[],
    build: |values, _| {
        Box::new(Unbalance {
            torque_n_m: values[0],
            phase_rad: values[1],
        })
    },
    draw: |_, _, random| vec![("phase", random.uniform(-PI, PI))],
    truth: |values, machine, _| {
        cosine_and_sine(machine.winding_volts(values[0]), values[1]).to_vec()
    },
};

impl Effect for Unbalance {
    fn torque(&self, at: &At) -> f64 {
        -self.torque_n_m * (at.angle + self.phase_rad).sin()
    }
}
