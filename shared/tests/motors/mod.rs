//! Motors of very different size, for laws that must hold for all.

use shared::motor::Physical;
use shared::scalar::Real;
use shared::units::PerUnit;

/// A motor, its supply (V), and its encoder (counts per revolution).
pub struct Bench {
    pub name: &'static str,
    pub physical: Physical<f64>,
    pub supply: f64,
    pub counts_per_rev: u32,
}

pub const BENCHES: [Bench; 4] = [
    Bench {
        name: "the paper's motor",
        physical: physical(1.2, 0.02, 0.06, 6.2e-4, 1e-4),
        supply: 1.0,
        counts_per_rev: 360,
    },
    Bench {
        name: "a small gearmotor (at its output)",
        physical: physical(8.0, 2e-3, 0.55, 2.0e-3, 2e-2),
        supply: 6.0,
        counts_per_rev: 2800,
    },
    Bench {
        name: "a coreless 24 V motor",
        physical: physical(1.2, 0.12e-3, 0.0235, 1.1e-6, 6e-7),
        supply: 24.0,
        counts_per_rev: 2048,
    },
    Bench {
        name: "a 400 W servo",
        physical: physical(0.55, 1.6e-3, 0.14, 2.8e-5, 8e-5),
        supply: 48.0,
        counts_per_rev: 10_000,
    },
];

const fn physical(r: f64, l: f64, k: f64, j: f64, f: f64) -> Physical<f64> {
    Physical {
        resistance: r,
        inductance: l,
        kt: k,
        kb: k,
        inertia: j,
        viscous: f,
    }
}

impl Bench {
    /// Bases as a user would take them: the supply, and the no-load speed with some room.
    pub fn units<R: Real>(&self, interval: f64) -> PerUnit<R> {
        let no_load = self.supply * self.physical.machine().response().gain;
        PerUnit::new(
            R::from_f64(self.supply),
            R::from_f64(no_load * 1.3),
            R::from_f64(interval),
            R::from_f64(self.counts_per_rev as f64),
        )
        .expect("positive bases")
    }
}
