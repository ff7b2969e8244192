//! Eccentricity of the encoder's disc or magnet.

use super::{Effect, Kind, Param, cosine_and_sine};
use std::f64::consts::PI;

/// The encoder sees θ + ε·sin(θ + φ), with ε ≈ e/r for a disc of radius r that sits off its axis by e, as
/// follows from the triangle of axis, disc centre and reading head. The motion itself is not touched.
struct EncEcc {
    amplitude_rad: f64,
    phase_rad: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "enc_ecc",
    about: "the encoder reads an angle error once per revolution",
    electrical: None,
    params: &[
        Param {
            name: "amplitude",
            unit: "rad",
            about: "amplitude ε of the angle error",
            scales: true,
            range: (0.0, 0.5),
            typical: |_| 0.006,
        },
        Param {
            name: "phase",
            unit: "rad",
            about: "phase φ at shaft angle zero",
            scales: false,
            range: (-10.0, 10.0),
            typical: |_| 0.4,
        },
    ],
    other_laws: &[],
    build: |values, _| {
        Box::new(EncEcc {
            amplitude_rad: values[0],
            phase_rad: values[1],
        })
    },
    draw: |_, _, random| vec![("phase", random.uniform(-PI, PI))],
    truth: |values, _, _| cosine_and_sine(values[0], values[1]).to_vec(),
};

impl Effect for EncEcc {
    fn sensed_angle(&self, angle: f64) -> f64 {
        angle + self.amplitude_rad * (angle + self.phase_rad).sin()
    }
}
