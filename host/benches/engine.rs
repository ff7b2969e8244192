//! Nanoseconds a step of one candidate, with every effect: alone, and side by side with others. Beside them the plain explicit
//! Euler step of the linear motor in f64, and how many times its time each takes. Least of several runs.
#![forbid(unsafe_code)]

use host::problem::abreast::Run;
use host::problem::course::{Leg, Manner, legs};
use host::problem::simulate::{Method, Simulation};
use host::problem::{Candidate, Data, Horizon, StartAngle};
use host::recording::{Drive, Recording};
use shared::effects::{EffectSet, Kind};
use shared::excite::{COMMISSIONING, commands};
use shared::motor::Machine;
use std::hint::black_box;
use std::time::Instant;

const SUPPLY: f64 = 12.0;
const INTERVAL_S: f64 = 1e-3;
const MACHINE: Machine<f64> = Machine {
    kb: 0.05,
    damping: 0.002,
    inertia: 0.0025,
    electrical: 0.0016,
};
const LANES: usize = 8;
const RUNS: usize = 7;

fn data() -> Data {
    let command: Vec<f64> = commands::<f64>(&COMMISSIONING, INTERVAL_S, 1)
        .map(|command| command.drive * SUPPLY)
        .collect();
    let mut angle = 0.0;
    let recording = Recording {
        source: "bench".to_owned(),
        time_s: (0..command.len()).map(|k| k as f64 * INTERVAL_S).collect(),
        counts: command
            .iter()
            .map(|volts| {
                angle += 4.0 * volts;
                f64::floor(angle)
            })
            .collect(),
        command,
        current_a: None,
        enabled: None,
        counts_per_rev: 2000.0,
        quantised: true,
        supply_v: Some(SUPPLY),
        drive: Drive::Voltage,
    };
    Data::new(&recording).expect("valid bases")
}

fn candidate(data: &Data, kind: Option<Kind>, change: f64) -> Candidate {
    let mut effects = EffectSet::default();
    if let Some(kind) = kind {
        let values: Vec<f64> = kind
            .description()
            .parameters
            .iter()
            .map(|p| p.scaled(p.typical, data.supply, data.units.speed) * (1.0 + change))
            .collect();
        effects.push(kind, &values).expect("a valid effect");
    }
    Candidate {
        machine: MACHINE,
        effects,
        start_speed: 0.0,
        start_offset: 0.0,
    }
}

/// The paper's step, and the error that it is judged by.
fn euler(data: &Data) -> f64 {
    let machine = MACHINE.lower(&data.units);
    let per_unit = data.units.counts_per_unit();
    let (mut current, mut speed, mut angle, mut sum) = (0.0, 0.0, data.counts[0], 0.0);
    for (volts, reading) in data.command.iter().zip(&data.counts) {
        sum += f64::abs(angle - reading);
        let rise = (volts - current - machine.kb * speed) / machine.electrical;
        let gain = (current - machine.damping * speed) / machine.inertia;
        angle += speed * per_unit;
        current += rise;
        speed += gain;
    }
    sum
}

/// Least time of a run, ns a step of a candidate.
fn least<A>(steps: usize, mut work: impl FnMut() -> A) -> f64 {
    let once = |_| {
        let began = Instant::now();
        black_box(work());
        began.elapsed().as_secs_f64()
    };
    let best = (0..RUNS).map(once).fold(f64::INFINITY, f64::min);
    best * 1e9 / steps as f64
}

fn main() {
    let data = data();
    let baseline = least(data.len(), || euler(black_box(&data)));
    println!("scalar Euler in f64: {baseline:.2} ns a step");
    println!(
        "{:16} {:>8} {:>8} {:>8} {:>10}",
        "", "alone", "abreast", "gain", "of Euler"
    );
    for kind in std::iter::once(None).chain(Kind::ALL.iter().copied().map(Some)) {
        let run = Run {
            data: &data,
            method: Method::default(),
            manner: Manner::Free,
        };
        let legs = |candidate: &Candidate| -> Vec<Leg> {
            legs(&data, candidate, &Horizon::Whole, StartAngle::Known)
        };
        let group: Vec<Candidate> = (0..LANES)
            .map(|k| candidate(&data, kind, k as f64 * 1e-5))
            .collect();
        let one = &group[0];
        let alone = least(data.len(), || {
            let simulation = Simulation::new(&data, one, run.method).expect("a valid model");
            simulation.errors(run.manner, &legs(one))
        });
        let abreast = least(data.len() * LANES, || run.errors(&group, &legs));
        println!(
            "{:16} {alone:8.1} {abreast:8.1} {:7.1}x {:9.2}x",
            kind.map_or("linear", |kind| kind.name()),
            alone / abreast,
            abreast / baseline
        );
    }
}
