//! Coulomb friction that differs between the two directions.

use super::{Effect, Kind, Param, Sliding};

/// T = −Tf while moving forward, +Tb while moving backward; at rest it holds against up to Tf forward and
/// up to Tb backward (Armstrong-Hélouvry, Dupont and Canudas de Wit, "A survey of models, analysis tools
/// and compensation methods for the control of machines with friction", Automatica 30(7), 1994).
struct AsymCoulomb {
    forward_n_m: f64,
    backward_n_m: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "asym_coulomb",
    about: "dry friction that differs between the directions",
    electrical: None,
    params: &[
        Param {
            name: "forward",
            unit: "N*m",
            about: "friction torque against forward motion",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.036 * machine.stall_torque_n_m(),
        },
        Param {
            name: "backward",
            unit: "N*m",
            about: "friction torque against backward motion",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.024 * machine.stall_torque_n_m(),
        },
    ],
    other_laws: &[],
    build: |values, _| {
        Box::new(AsymCoulomb {
            forward_n_m: values[0],
            backward_n_m: values[1],
        })
    },
    draw: |typical, _, random| {
        let mean = 0.5 * (typical[0] + typical[1]);
        let lean = random.sign() * random.log_uniform(0.1, 0.6);
        vec![
            ("forward", mean * (1.0 + lean)),
            ("backward", mean * (1.0 - lean)),
        ]
    },
    truth: |values, machine, _| {
        vec![
            machine.winding_volts(values[0]),
            machine.winding_volts(values[1]),
        ]
    },
};

impl Effect for AsymCoulomb {
    fn friction(&self, sliding: &Sliding) -> f64 {
        if sliding.direction > 0.0 {
            self.forward_n_m
        } else {
            self.backward_n_m
        }
    }
}
