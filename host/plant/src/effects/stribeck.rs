//! Stribeck friction: stiction that falls off as the shaft begins to slide.

use super::{Effect, Kind, Law, Param, Sliding};

/// T = −(Tc + ΔT·exp(−|ω/ωs|^δ))·sgn ω, and at rest it holds against up to Tc + ΔT (Tustin 1947 with
/// δ = 1; Armstrong-Hélouvry, "Control of Machines with Friction", 1991, with δ = 2). The law is
/// whole: it contains its own Coulomb part.
struct Stribeck {
    coulomb_n_m: f64,
    extra_n_m: f64,
    speed_rad_s: f64,
    exponent: f64,
}

pub(super) static KIND: Kind = Kind {
    name: "stribeck",
    about: "dry friction that is larger at rest than in motion",
    electrical: None,
    params: &[
        Param {
            name: "coulomb",
            unit: "N*m",
            about: "sliding friction Tc far above the Stribeck speed",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.03 * machine.stall_torque_n_m(),
        },
        Param {
            name: "extra",
            unit: "N*m",
            about: "excess of static over sliding friction, Ts − Tc",
            scales: true,
            range: (0.0, f64::INFINITY),
            typical: |machine| 0.03 * machine.stall_torque_n_m(),
        },
        Param {
            name: "speed",
            unit: "rad/s",
            about: "Stribeck speed ωs, where the excess has fallen to 37 %",
            scales: false,
            range: (f64::MIN_POSITIVE, f64::INFINITY),
            typical: |machine| 0.03 * machine.top_speed_rad_s(),
        },
        Param {
            name: "exponent",
            unit: "1",
            about: "shape δ: 1 exponential, 2 Gaussian",
            scales: false,
            range: (0.5, 4.0),
            typical: |_| 2.0,
        },
    ],
    other_laws: &[Law {
        name: "quotient",
        about: "the excess falls as 1/(1 + (w/ws)^2)",
        build: |values, _| {
            Box::new(QuotientStribeck {
                coulomb_n_m: values[0],
                extra_n_m: values[1],
                speed_rad_s: values[2],
            })
        },
        form: Some(1.0),
    }],
    build: |values, _| {
        Box::new(Stribeck {
            coulomb_n_m: values[0],
            extra_n_m: values[1],
            speed_rad_s: values[2],
            exponent: values[3],
        })
    },
    draw: |typical, machine, random| {
        vec![
            ("extra", typical[1] * random.log_uniform(0.3, 1.5)),
            (
                "speed",
                machine.top_speed_rad_s() * random.log_uniform(0.01, 0.06),
            ),
            ("exponent", random.uniform(1.0, 2.0)),
        ]
    },
    truth: |values, machine, _| {
        vec![
            machine.winding_volts(values[0]),
            machine.winding_volts(values[1]),
            values[2],
            values[3],
            0.0,
        ]
    },
};

impl Effect for Stribeck {
    fn friction(&self, sliding: &Sliding) -> f64 {
        let decay = (-(sliding.speed / self.speed_rad_s).powf(self.exponent)).exp();
        self.coulomb_n_m + self.extra_n_m * decay
    }
}

/// The excess falls as 1/(1 + (ω/ωs)²) (Hess, Soom, "Friction at a lubricated line contact operating at oscillating
/// sliding velocities", J. Tribology 112, 1990): far slower than an exponential.
struct QuotientStribeck {
    coulomb_n_m: f64,
    extra_n_m: f64,
    speed_rad_s: f64,
}

impl Effect for QuotientStribeck {
    fn friction(&self, sliding: &Sliding) -> f64 {
        let decay = 1.0 / (1.0 + (sliding.speed / self.speed_rad_s).powi(2));
        self.coulomb_n_m + self.extra_n_m * decay
    }
}
