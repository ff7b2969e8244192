//! Friction that grows with the torque passed through a gear.

use super::{At, Effect, Kind, Law, Param, Sliding, only_its_size};

/// F = μ·|Kt·i − Tload|, a share of the torque that the motor and its load pass to each other (Duclusaud and
/// Passault, "Extended friction models for the physics simulation of servo actuators", 2024: the
/// load-dependent term).
struct LoadFriction {
    share: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "load_friction",
    about: "dry friction that grows with the transmitted torque",
    electrical: None,
    params: &[Param {
        name: "share",
        unit: "1",
        about: "friction per transmitted torque μ",
        scales: true,
        range: (0.0, 0.9),
        typical: |_| 0.08,
    }],
    other_laws: &[Law {
        name: "stribeck",
        about: "half as much again near standstill",
        build: |values, machine| {
            Box::new(StribeckLoadFriction {
                share: values[0],
                speed_rad_s: 0.03 * machine.top_speed_rad_s(),
            })
        },
        form: None,
    }],
    build: |values, _| Box::new(LoadFriction { share: values[0] }),
    draw: only_its_size,
    truth: |values, _, _| vec![values[0]],
};

impl Effect for LoadFriction {
    fn friction(&self, sliding: &Sliding) -> f64 {
        self.share * sliding.transmitted
    }

    fn piece(&self, _: &At, transmitted: f64) -> i8 {
        i8::from(self.share > 0.0 && transmitted > 0.0)
    }
}

/// μ·(1 + exp(−(ω/ωs)²)/2): friction of a loaded gear that is larger near standstill (Duclusaud, Passault, "Extended
/// friction models for servo actuators", ICRA 2025, model M5, with the excess a fixed share of the friction).
struct StribeckLoadFriction {
    share: f64,
    speed_rad_s: f64,
}

impl Effect for StribeckLoadFriction {
    fn friction(&self, sliding: &Sliding) -> f64 {
        let excess = 0.5 * (-(sliding.speed / self.speed_rad_s).powi(2)).exp();
        self.share * (1.0 + excess) * sliding.transmitted
    }

    fn piece(&self, _: &At, transmitted: f64) -> i8 {
        i8::from(self.share > 0.0 && transmitted > 0.0)
    }
}
