//! Motors of half a watt to half a kilowatt with 12 to 65,536 counts a revolution, bare and with a robot's mass, and ordinary faults.
#![allow(dead_code, reason = "each law takes the faults that it is about")]

use firmware::app::{Memory, Recording};
use firmware::plant::{CARRIERS, Motor, Shaft};
use firmware::trials::{bench::Bench, host::Host};
use shared::fit::{Grade, Outcome, Settings};
use shared::rng;
use shared::wire::*;
use std::cell::RefCell;
use std::f32::consts::TAU;

const COUNTS: [u32; 12] = [
    12, 28, 44, 64, 100, 400, 1_000, 2_000, 4_096, 8_192, 16_384, 65_536,
];

/// A motor and its bench.
#[derive(Clone, Debug)]
pub struct Drawn {
    pub motor: Motor,
    pub offset_ma: i32,
    pub glitches: u32,
    /// Limit of the current, as a part of that at rest and full supply.
    pub limit: Option<f32>,
}

fn between(rng: &mut rng::Generator, low: f32, high: f32) -> f32 {
    low * (high / low).powf(rng::uniform(rng))
}

/// The motor of a seed, with all of its faults.
pub fn draw(seed: u64) -> Drawn {
    let mut rng = rng::seeded(seed);
    let rng = &mut rng;
    let counts_per_rev = COUNTS[rng::below(rng, 12) as usize];
    let power = between(rng, 0.5, 500.0);
    let supply = [6.0, 12.0, 24.0, 48.0][(power.log10() + 0.9).clamp(0.0, 3.0) as usize];
    let stall = between(rng, 4.0, 10.0) * power / supply;
    let resistance = supply / stall;
    let fastest = between(rng, 250.0, 1200.0) / power.max(1.0).powf(0.15);
    let constant = supply / fastest;
    let mass = if rng::below(rng, 2) == 0 {
        1.0
    } else {
        between(rng, 3.0, 20.0)
    };
    let mechanical = between(rng, 4e-3, 4e-2) * mass;
    let torque = constant * stall;
    Drawn {
        motor: Motor {
            supply,
            supply_resistance: between(rng, 0.002, 0.03) * resistance,
            dead_time: between(rng, 0.001, 0.016),
            resistance,
            inductance: resistance * between(rng, 1e-4, 1e-3),
            constant,
            inertia: mechanical * constant * constant / resistance,
            viscous: torque / fastest * between(rng, 0.005, 0.03),
            coulomb: torque * between(rng, 0.01, 0.06),
            cogging: torque * between(rng, 1e-4, 5e-3),
            cogging_order: 14.0,
            counts_per_rev: counts_per_rev as f32,
            state: Shaft::default(),
        },
        offset_ma: ((rng::uniform::<f32>(rng) - 0.5) * 0.02 * stall * 1000.0) as i32,
        glitches: if rng::below(rng, 2) == 0 { 0 } else { 600 },
        limit: (rng::below(rng, 2) == 0).then(|| between(rng, 0.5, 1.0)),
    }
}

/// The commissioning of a motor with as many evaluations of the search, behind a bridge whose dead time is fitted; any error is a success.
pub fn commissioning(motor: &Motor, seed: u64, evaluations: u16) -> Job {
    Job {
        kind: Kind::Commission,
        amplitude: 30_000,
        excite: 6_000,
        coast: true,
        record: 2_000,
        verify: 2_000,
        verify_within: 100,
        accept: Grade::No,
        seed,
        fit: Settings {
            seed,
            evaluations,
            carriers: CARRIERS as u16,
            supply: true,
            ..Settings::default()
        },
        limits: Limits {
            duty: 32_000,
            time: 60_000,
            ..Limits::NONE
        },
        counts_per_rev: motor.counts_per_rev as u32,
        supply_mv: (motor.supply * 1000.0) as u32,
    }
}

/// Gain (counts a period under the whole supply), time constant (periods) and their ratio, each as the range between a supply that holds and one
/// that is part of the winding.
pub fn truth(motor: &Motor) -> [[f32; 2]; 3] {
    let of = |resistance: f32| {
        let all = motor.constant + resistance * motor.viscous / motor.constant;
        let gain = motor.supply / all / TAU * motor.counts_per_rev * 1e-3;
        let lag = motor.inertia * resistance + motor.inductance * motor.viscous;
        let first_order = lag / (motor.constant * all) * 1e3;
        [gain, first_order, gain / first_order]
    };
    let (stiff, soft) = (
        of(motor.resistance),
        of(motor.resistance + motor.supply_resistance),
    );
    [0, 1, 2].map(|k| [stiff[k].min(soft[k]), stiff[k].max(soft[k])])
}

/// By which part a value is outside of a range.
pub fn outside(value: f32, [low, high]: [f32; 2]) -> f32 {
    (value / high - 1.0).max(1.0 - value / low).max(0.0)
}

/// Parts by which a fit's gain, time constant and their ratio are off.
pub fn off(outcome: &Outcome, motor: &Motor) -> [f32; 3] {
    let [gain, mechanical] = [0, 1].map(|k| outcome.estimates[k].value);
    let truth = truth(motor);
    let found = [gain, mechanical, gain / mechanical];
    [0, 1, 2].map(|k| outside(found[k], truth[k]))
}

impl Drawn {
    /// Its bench, with the faults of sensor and encoder.
    pub fn bench(&self) -> RefCell<Bench> {
        let mut bench = Bench::new(self.motor.clone());
        (bench.offset_ma, bench.glitches) = (self.offset_ma, self.glitches);
        RefCell::new(bench)
    }
}

/// A motor's tuning, as a board orders it that measures its supply.
pub fn tuning(motor: &Motor, seed: u64) -> Job {
    let common = commissioning(motor, seed, 4_000);
    Job {
        kind: Kind::Tune,
        fit: Settings {
            supply: false,
            ..common.fit
        },
        ..common
    }
}

/// Runs periods until the run has ended.
pub fn to_its_end<const SENSES: bool>(
    host: &mut Host<'_, f32, 2000, SENSES>,
) -> Result<Report, Box<Failure>> {
    loop {
        let mut outcome = None;
        host.period(|message| match message {
            ToHost::Report(report) => outcome = Some(Ok(report)),
            ToHost::Failed(failure) => outcome = Some(Err(Box::new(failure))),
            _ => {}
        });
        if let Some(outcome) = outcome {
            return outcome;
        }
    }
}

/// Runs a job on a bench to its end.
pub fn ran<const SENSES: bool>(bench: &RefCell<Bench>, job: Job) -> Result<Report, Box<Failure>> {
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<2000>::new());
    let mut host = Host::<f32, 2000, SENSES>::new(bench, &mut memory, &mut recording);
    assert!(host.start(job));
    to_its_end(&mut host)
}
