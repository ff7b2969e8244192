//! Windage: the drag of the air that a fan or a fast rotor stirs.

use super::{At, Effect, Kind, Param, only_its_size};

/// T = −c·ω·|ω|, turbulent drag (Vrancik, "Prediction of windage power loss in alternators", NASA TN
/// D-4849, 1968, with its coefficient taken as constant).
struct Windage {
    drag_n_m_s2: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "windage",
    about: "drag that grows with the square of the speed",
    electrical: None,
    params: &[Param {
        name: "drag",
        unit: "N*m*s^2",
        about: "drag coefficient c",
        scales: true,
        range: (0.0, f64::INFINITY),
        typical: |machine| 0.05 * machine.stall_torque_n_m() / machine.top_speed_rad_s().powi(2),
    }],
    build: |values, _| {
        Box::new(Windage {
            drag_n_m_s2: values[0],
        })
    },
    draw: only_its_size,
    truth: |values, machine, _| vec![machine.winding_volts(values[0])],
};

impl Effect for Windage {
    fn torque(&self, at: &At) -> f64 {
        -self.drag_n_m_s2 * at.speed * at.speed.abs()
    }
}
