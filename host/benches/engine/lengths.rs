//! Costs, fits and memory against the length of the recording, at 1 kHz.

use super::clock;
use super::effects::{INTERVAL_S, candidate, data};
use servoid_engine::block_cost::BlockCost;
use servoid_engine::problem::{self, Data, Horizon, StartAngle};
use servoid_engine::simulation::Method;
use servoid_engine::solve::{self, Objective};
use servoid_identify::fit::{self, Options};
use shared::cost::Cost;
use shared::effects::Kind;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;

/// Lengths, s.
const LENGTHS_S: [f64; 5] = [1.0, 10.0, 60.0, 600.0, 3600.0];
/// How long each command is held, samples.
const HELD: usize = 500;

/// Largest memory of this process so far, MB; nothing where the system does not say.
fn most_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM"))?;
    let kilobytes: f64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kilobytes / 1024.0)
}

/// The same commands with the readings of the motor itself.
fn of_motor(mut data: Data) -> Data {
    let motor = candidate(&data, &[], 0.0);
    let (horizon, start) = (Horizon::Whole, StartAngle::Free);
    let errors = problem::errors(
        &data,
        &motor,
        Method::default(),
        &horizon,
        start,
        Cost::Squared,
    );
    for (reading, error) in data.counts.iter_mut().zip(errors.expect("a valid model")) {
        *reading = (*reading + error).floor();
    }
    data
}

/// Prints them.
pub fn rows() {
    println!(
        "{:>8} {:>10} {:>14} {:>14} {:>14} {:>12} {:>10}",
        "s", "samples", "linear ns", "held ns", "Coulomb ns", "LM fit ms", "most MB"
    );
    for seconds in LENGTHS_S {
        let samples = (seconds / INTERVAL_S) as usize;
        let levels = [0.3, -0.2, 0.6, 0.0, -0.5, 0.1];
        let data = of_motor(data((0..samples).map(|k| levels[k / HELD % levels.len()])));
        let per_sample = |work: &dyn Fn() -> f64| clock::least(work) * 1e9 / samples as f64;
        let options = Options::default();
        let problem = fit::problem(&data, &options).expect("a start");
        let quick = BlockCost::new(&problem);
        let start = problem.start.clone().expect("a start");
        let coulomb = candidate(&data, &[Kind::Coulomb], 0.0);
        let friction = per_sample(&|| {
            let (horizon, start) = (&problem.horizon, problem.start_angle);
            problem::errors(
                &data,
                &coulomb,
                Method::default(),
                horizon,
                start,
                Cost::Squared,
            )
            .map_or(0.0, |errors| errors[0])
        });
        let solver = solve::by_name("lm").expect("a method");
        let stop = AtomicBool::new(false);
        let (fitted, _) = clock::once(|| {
            let problem = fit::problem(&data, &options).expect("a start");
            fit::search(&problem, solver.as_ref(), &options, &stop, &mut |_, _| {})
        });
        println!(
            "{seconds:8} {samples:10} {:14.2} {:14.2} {friction:14.2} {:12.2} {:>10}",
            per_sample(&|| problem.cost(black_box(&start))),
            per_sample(&|| quick.cost(black_box(&start))),
            fitted * 1e3,
            most_megabytes().map_or("?".to_owned(), |most| format!("{most:.0}"))
        );
    }
}
