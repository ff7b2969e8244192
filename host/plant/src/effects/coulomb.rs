//! Coulomb friction.

use super::{Effect, Kind, Param, Sliding, only_its_size};

/// T = −Tc·sgn ω while moving; at rest it holds against up to Tc (Coulomb 1785; Olsson et al.,
/// "Friction models and friction compensation", Eur. J. Control 4(3), 1998, eq. 1).
struct Coulomb {
    torque_n_m: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "coulomb",
    about: "dry friction of one size at every speed",
    electrical: None,
    params: &[Param {
        name: "torque",
        unit: "N*m",
        about: "friction torque Tc",
        scales: true,
        range: (0.0, f64::INFINITY),
        typical: |machine| 0.03 * machine.stall_torque_n_m(),
    }],
    other_laws: &[],
    build: |values, _| {
        Box::new(Coulomb {
            torque_n_m: values[0],
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| vec![machine.winding_volts(values[0])],
};

impl Effect for Coulomb {
    fn friction(&self, _: &Sliding) -> f64 {
        self.torque_n_m
    }
}
