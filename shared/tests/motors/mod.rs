//! Motors of very different size, for laws that must hold for all.

use shared::effects::{EffectSet, Kind};
use shared::excite::Command;
use shared::model::{Model, Plan, State};
use shared::motor::Physical;
use shared::scalar::{ErrorValue, Readable, Real};
use shared::units::PerUnit;
use testing::motion::Steps;

/// Sample interval, s.
pub const INTERVAL: f64 = 1e-3;

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
    /// The motor with effects.
    pub fn plan(&self, effects: &[(Kind, &[f64])], substeps: u16) -> Plan<f64> {
        let mut set = EffectSet::default();
        for (kind, values) in effects {
            set.push(*kind, values).expect("a valid effect");
        }
        Plan {
            effects: set,
            substeps,
            ..Plan::linear(self.physical.machine(), self.units(INTERVAL))
        }
    }

    /// Typical values of an effect in SI.
    pub fn typical(&self, kind: Kind) -> Vec<f64> {
        let no_load = self.supply * self.physical.machine().response().gain;
        let parameters = kind.parameters().iter();
        parameters
            .map(|p| p.scaled(p.typical, self.supply, no_load))
            .collect()
    }
}

/// Angle in counts after each sample.
pub fn run<S: Steps>(plan: &Plan<f64>, drive: &[Command<f64>]) -> Vec<f64> {
    let model = Model::<S>::new(plan).expect("a valid model");
    let mut state = State::<S>::default();
    drive
        .iter()
        .map(|command| {
            S::step(
                &model,
                &mut state,
                S::from_f64(command.drive),
                !command.enabled,
            );
            model.reading(&state).minus(0).to_f64()
        })
        .collect()
}

/// The largest difference.
pub fn furthest(a: &[f64], b: &[f64]) -> f64 {
    let pairs = a.iter().zip(b);
    pairs.fold(0.0, |most, (a, b)| most.max((a - b).abs()))
}
