//! Argmin's particle swarm on the paper's step, as `peers.py` has it: `argmin-peer READINGS SEEDS`.
#![forbid(unsafe_code)]

use argmin::core::{CostFunction, Error, Executor};
use argmin::solver::particleswarm::ParticleSwarm;
use rand::SeedableRng;
use rand::rngs::StdRng;
use rustix::time::{ClockId, clock_gettime};
use std::cell::Cell;

const INTERVAL_S: f64 = 1e-3;
const VOLTS: f64 = 1.0;
const BOX: (f64, f64) = (1e-4, 1.5);
/// Inductance, resistance, kt, inertia, viscous friction, kb; SI.
const TRUTH: [f64; 6] = [0.02, 1.2, 0.06, 6.2e-4, 1e-4, 0.06];
const BUDGET: u64 = 20_000;
const PARTICLES: usize = 50;
const WITHIN: f64 = 1.01;

/// Integral of the absolute error, degree seconds.
fn cost(x: &[f64], readings: &[f64]) -> f64 {
    let [inductance, resistance, kt, inertia, viscous, kb] = [x[0], x[1], x[2], x[3], x[4], x[5]];
    let (mut current, mut speed, mut angle, mut total) = (0.0, 0.0, 0.0, 0.0);
    for reading in readings {
        total += f64::abs(f64::to_degrees(angle) - reading);
        let rise = (VOLTS - resistance * current - kb * speed) / inductance;
        let gain = (kt * current - viscous * speed) / inertia;
        angle += INTERVAL_S * speed;
        current += INTERVAL_S * rise;
        speed += INTERVAL_S * gain;
    }
    let total = total * INTERVAL_S;
    if total.is_nan() {
        1e30
    } else {
        total.min(1e30)
    }
}

struct Problem<'a> {
    readings: &'a [f64],
    evaluations: &'a Cell<u64>,
}

impl CostFunction for Problem<'_> {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Error> {
        self.evaluations.set(self.evaluations.get() + 1);
        Ok(cost(x, self.readings))
    }
}

fn cpu_s() -> f64 {
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

fn median(seconds: &mut [f64]) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds.get(seconds.len() / 2).copied().unwrap_or(f64::NAN)
}

fn main() -> Result<(), Error> {
    let arguments: Vec<String> = std::env::args().collect();
    let [_, file, seeds] = &arguments[..] else {
        return Err(Error::msg("usage: argmin-peer READINGS SEEDS"));
    };
    let readings: Vec<f64> = std::fs::read_to_string(file)?
        .lines()
        .map(str::parse)
        .collect::<Result<_, _>>()?;
    let seeds: u64 = seeds.parse()?;
    let target = WITHIN * cost(&TRUTH, &readings);
    let (mut seconds, mut counts, mut there) = (Vec::new(), Vec::new(), Vec::new());
    for seed in 1..=seeds {
        let evaluations = Cell::new(0);
        let problem = Problem {
            readings: &readings,
            evaluations: &evaluations,
        };
        let solver = ParticleSwarm::new((vec![BOX.0; 6], vec![BOX.1; 6]), PARTICLES)
            .with_rng_generator(StdRng::seed_from_u64(seed));
        let began = cpu_s();
        let result = Executor::new(problem, solver)
            .configure(|state| {
                state
                    .max_iters(BUDGET / PARTICLES as u64)
                    .target_cost(target)
            })
            .run()?;
        seconds.push(cpu_s() - began);
        counts.push(evaluations.get());
        if result.state().get_best_cost() <= target {
            there.push(seconds[seconds.len() - 1]);
        }
    }
    counts.sort_unstable();
    let reached = format!("{}/{seeds}", there.len());
    let a_success = seconds.iter().sum::<f64>() / there.len() as f64;
    println!(
        "{:22} {:14.4} {:11.4} {a_success:11.4} {:12} {reached:>8}",
        "argmin PSO",
        median(&mut seconds),
        median(&mut there),
        counts[counts.len() / 2]
    );
    Ok(())
}
