//! Viscous friction that differs between the two directions.

use super::{At, Effect, Kind, Param};

/// T = −bf·ω forward and −bb·ω backward, on top of the machine's own viscous friction (as of a lip seal or a
/// screw pump; Armstrong-Hélouvry, Dupont and Canudas de Wit, Automatica 30(7), 1994).
struct AsymViscous {
    forward_n_m_s: f64,
    backward_n_m_s: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "asym_viscous",
    about: "extra viscous friction that differs between the directions",
    electrical: None,
    params: &[
        Param {
            name: "forward",
            unit: "N*m*s",
            about: "extra viscous friction forward bf",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.06 * machine.stall_torque_n_m() / machine.top_speed_rad_s(),
        },
        Param {
            name: "backward",
            unit: "N*m*s",
            about: "extra viscous friction backward bb",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.02 * machine.stall_torque_n_m() / machine.top_speed_rad_s(),
        },
    ],
    other_laws: &[],
    build: |values, _| {
        Box::new(AsymViscous {
            forward_n_m_s: values[0],
            backward_n_m_s: values[1],
        })
    },
    draw: |typical, _, random| {
        let (much, little) = (typical[0], typical[0] * random.uniform(0.0, 0.6));
        let (forward, backward) = if random.chance(0.5) {
            (much, little)
        } else {
            (little, much)
        };
        vec![("forward", forward), ("backward", backward)]
    },
    truth: |values, machine, _| {
        vec![
            machine.winding_volts(values[0]),
            machine.winding_volts(values[1]),
        ]
    },
};

impl Effect for AsymViscous {
    fn torque(&self, at: &At) -> f64 {
        let viscous = if at.speed > 0.0 {
            self.forward_n_m_s
        } else {
            self.backward_n_m_s
        };
        -viscous * at.speed
    }
}
