//! Nanoseconds a step of one candidate, with every effect: alone, and side by side with others.

use super::{clock, euler};
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle};
use servoid_engine::simulation::Batch;
use servoid_engine::simulation::{Method, Simulation};
use servoid_engine::simulation::{Mode, Segment, segments};
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::effects::{EffectSet, Kind};
use shared::excite::{COMMISSIONING, commands};
use shared::motor::Machine;
use std::hint::black_box;

/// Supply, V.
pub const SUPPLY: f64 = 12.0;
/// Sample interval, s.
pub const INTERVAL_S: f64 = 1e-3;
/// The motor.
pub const MACHINE: Machine<f64> = Machine {
    kb: 0.05,
    damping: 0.002,
    inertia: 0.0025,
    electrical: 0.0016,
};
const LANES: usize = 8;

/// Readings of about what a motor does under these parts of the supply.
pub fn data(drive: impl Iterator<Item = f64>) -> Data {
    let command: Vec<f64> = drive.map(|part| part * SUPPLY).collect();
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
        measured: Series::NONE,
        enabled: None,
        counts_per_rev: 2000.0,
        quantised: true,
        supply_v: Some(SUPPLY),
        drive: Drive::Voltage,
        position: None,
    };
    Data::new(&recording).expect("valid bases")
}

/// The motor with effects of their typical sizes, changed by a part.
pub fn candidate(data: &Data, kinds: &[Kind], change: f64) -> Candidate {
    let mut effects = EffectSet::default();
    for &kind in kinds {
        let values: Vec<f64> = kind
            .parameters()
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

/// Least time of a run, ns a step of a candidate.
fn least<A>(steps: usize, work: impl FnMut() -> A) -> f64 {
    clock::least(work) * 1e9 / steps as f64
}

/// Prints them.
pub fn rows() {
    let data = data(commands::<f64>(&COMMISSIONING, INTERVAL_S, 1).map(|command| command.drive));
    let baseline = least(data.len(), || euler::cost(&MACHINE, black_box(&data)));
    println!("scalar Euler in f64: {baseline:.2} ns a step");
    println!(
        "{:16} {:>8} {:>8} {:>8} {:>10} {:>8}",
        "", "alone", "in lanes", "gain", "of Euler", "in lists"
    );
    let kinds = Kind::ALL.iter().map(std::slice::from_ref);
    for kinds in std::iter::once(&[][..]).chain(kinds) {
        let [alone, in_lanes, listed] = steps(&data, kinds);
        println!(
            "{:16} {alone:8.1} {in_lanes:8.1} {:7.1}x {:9.2}x {listed:8.1}",
            kinds.first().map_or("linear", |kind| kind.name()),
            alone / in_lanes,
            in_lanes / baseline
        );
    }
    println!("\neffects in one model");
    let some = [
        Kind::Coulomb,
        Kind::Cogging,
        Kind::DeadZone,
        Kind::Windage,
        Kind::BrushDrop,
    ];
    for many in 0..=some.len() {
        let [alone, in_lanes, listed] = steps(&data, &some[..many]);
        println!(
            "{many:16} {alone:8.1} {in_lanes:8.1} {:7.1}x {:9.2}x {listed:8.1}",
            alone / in_lanes,
            in_lanes / baseline
        );
    }
}

/// ns a step of a candidate: alone and side by side with others, errors handed over as they come; and the latter with lists
/// of all errors made of them.
fn steps(data: &Data, kinds: &[Kind]) -> [f64; 3] {
    let run = Batch {
        data,
        method: Method::default(),
        mode: Mode::Free,
    };
    let segments = |candidate: &Candidate| -> Vec<Segment> {
        segments(data, candidate, &Horizon::Whole, StartAngle::Known)
    };
    let group: Vec<Candidate> = (0..LANES)
        .map(|k| candidate(data, kinds, k as f64 * 1e-5))
        .collect();
    let (one, others) = group.split_first().expect("some candidates");
    let alone = least(data.len(), || {
        let simulation = Simulation::new(data, one, run.method).expect("a valid model");
        let mut sum = 0.0;
        simulation.stream(run.mode, &segments(one), |errors| sum += errors[0]);
        sum
    });
    let in_lanes = least(data.len() * LANES, || {
        let mut sum = 0.0;
        let together = run.stream(one, others, segments, |errors, changes| {
            sum += errors[0] + changes[0][0];
        });
        // Whole samples of a delay are no number: such candidates are run one by one.
        if !together {
            sum += run.errors(&group, &segments).len() as f64;
        }
        sum
    });
    let listed = least(data.len() * LANES, || run.errors(&group, &segments));
    [alone, in_lanes, listed]
}
