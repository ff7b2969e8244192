//! Cogging: the detent torque between magnets and teeth.

use super::{At, Effect, Kind, Param, cosine_and_sine};
use std::f64::consts::PI;

/// T = −A·(sin(nθ + φ) + a₂·sin(2nθ + 2φ)), the first terms of the Fourier series over one
/// revolution, whose lowest order n is the least common multiple of slots and poles (Hanselman,
/// "Brushless Permanent Magnet Motor Design", 2003). It acts with and without current.
struct Cogging {
    torque_n_m: f64,
    order: f64,
    phase_rad: f64,
    second: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "cogging",
    about: "detent torque, periodic in the angle",
    electrical: None,
    params: &[
        Param {
            name: "torque",
            unit: "N*m",
            about: "amplitude of the lowest order",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.02 * machine.stall_torque_n_m(),
        },
        Param {
            name: "order",
            unit: "1/rev",
            about: "detents per revolution",
            scales: false,
            range: (1.0, 1000.0),
            typical: |_| 12.0,
        },
        Param {
            name: "phase",
            unit: "rad",
            about: "phase of the lowest order at angle zero",
            scales: false,
            range: (-10.0, 10.0),
            typical: |_| 0.7,
        },
        Param {
            name: "second",
            unit: "1",
            about: "amplitude of twice the lowest order, as a share of it",
            scales: false,
            range: (0.0, 1.0),
            typical: |_| 0.0,
        },
    ],
    other_laws: &[],
    build: |values, _| {
        Box::new(Cogging {
            torque_n_m: values[0],
            order: values[1],
            phase_rad: values[2],
            second: values[3],
        })
    },
    draw: |_, _, random| {
        vec![
            ("order", random.log_uniform(4.0, 60.0).round()),
            ("phase", random.uniform(-PI, PI)),
        ]
    },
    truth: |values, machine, _| {
        let [cosine, sine] = cosine_and_sine(machine.winding_volts(values[0]), values[2]);
        vec![cosine, sine, values[1]]
    },
};

impl Effect for Cogging {
    fn torque(&self, at: &At) -> f64 {
        let (sin, cos) = (self.order * at.angle + self.phase_rad).sin_cos();
        -self.torque_n_m * (sin + self.second * 2.0 * sin * cos)
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        // A quarter: one substep resolves a radian of a force that merely comes and goes.
        if self.torque_n_m == 0.0 {
            0.0
        } else {
            0.25 * self.order * at.speed.abs()
        }
    }
}
