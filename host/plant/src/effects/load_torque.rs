//! A constant load, as of a weight that hangs from a drum.

use super::{At, Effect, Kind, Param};

/// T = −T0 at every speed, at rest too; positive T0 resists forward rotation.
struct LoadTorque {
    torque_n_m: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "load_torque",
    about: "a constant torque on the shaft, at rest too",
    electrical: None,
    params: &[Param {
        name: "torque",
        unit: "N*m",
        about: "load torque T0, positive against forward rotation",
        scales: true,
        range: (f64::NEG_INFINITY, f64::INFINITY),
        typical: |machine| 0.03 * machine.stall_torque_n_m(),
    }],
    other_laws: &[],
    build: |values, _| {
        Box::new(LoadTorque {
            torque_n_m: values[0],
        })
    },
    draw: |typical, _, random| vec![("torque", random.sign() * typical[0])],
    truth: |values, machine, _| vec![machine.winding_volts(values[0])],
};

impl Effect for LoadTorque {
    fn torque(&self, _: &At) -> f64 {
        -self.torque_n_m
    }
}
