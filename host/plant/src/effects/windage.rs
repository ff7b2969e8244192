//! Windage: the drag of the air that a fan or a fast rotor stirs.

use super::{At, Effect, Kind, Law, Param, only_its_size};

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
    other_laws: &[Law {
        name: "smooth_rotor",
        about: "drag on the speed to the power 1.75",
        build: |values, machine| {
            let reference = machine.top_speed_rad_s();
            Box::new(SmoothRotor {
                drag: values[0] * reference.powf(0.25),
            })
        },
        form: None,
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

/// T = −c'·|ω|^1.75·sgn ω: a smooth rotor in a turbulent boundary layer, whose friction coefficient falls with the
/// fourth root of the Reynolds number (Schlichting, Gersten, "Boundary-Layer Theory", 2017, ch. 18).
struct SmoothRotor {
    drag: f64,
}

impl Effect for SmoothRotor {
    fn torque(&self, at: &At) -> f64 {
        -self.drag * at.speed.abs().powf(1.75).copysign(at.speed)
    }
}
