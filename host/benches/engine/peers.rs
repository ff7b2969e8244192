//! This engine on the work of `benches/peers`: CPU seconds until a cost is within 1 % of the truth's.

use super::clock;
use super::linear::STEP;
use servoid_engine::block_cost::BlockCost;
use servoid_engine::solve::{Evaluator, Objective, Solver, cma_es, swarm::ParticleSwarm};
use servoid_identify::paper::{BOX, PRINTED, Variant, paper_problem};
use std::sync::atomic::AtomicBool;

/// Seeds, unless the command line has a number.
const SEEDS: u64 = 5;
const BUDGET: usize = 20_000;
const WITHIN: f64 = 1.01;

/// Prints them.
pub fn rows() {
    let data = STEP.record().expect("the paper's step");
    let variant = Variant::all().next().expect("a variant");
    let problem = paper_problem(&data, variant, BOX);
    let truth = PRINTED[0].values();
    let quick = BlockCost::new(&problem);
    let target = WITHIN * quick.cost(&problem.structure.coordinates(&truth));
    let swarm = |population| ParticleSwarm {
        population,
        ..ParticleSwarm::default()
    };
    let searches: [(&str, Box<dyn Solver>); 3] = [
        ("servoid PSO, 50", Box::new(swarm(50))),
        ("servoid PSO, 20", Box::new(swarm(20))),
        ("servoid CMA-ES", Box::new(cma_es::CmaEs::default())),
    ];
    let seeds = std::env::args().find_map(|argument| argument.parse().ok());
    let seeds: u64 = seeds.unwrap_or(SEEDS);
    println!(
        "{:22} {:>14} {:>11} {:>11} {:>12} {:>8}",
        "search", "CPU s: median", "of reached", "a success", "evaluations", "reached"
    );
    for (name, solver) in searches {
        let (mut all, mut there, mut counts) = (Vec::new(), Vec::new(), Vec::new());
        for seed in 1..=seeds {
            let (seconds, found) = clock::once(|| {
                let stop = AtomicBool::new(false);
                let mut least = |_: usize, best: f64| {
                    if best <= target {
                        stop.store(true, std::sync::atomic::Ordering::Relaxed);
                    }
                };
                let mut evaluator = Evaluator::new(&quick, BUDGET, &stop, &mut least);
                solver.search(&mut evaluator, seed);
                evaluator.finish()
            });
            all.push(seconds);
            counts.push(found.evaluations);
            if found.cost <= target {
                there.push(seconds);
            }
        }
        counts.sort_unstable();
        let reached = format!("{}/{seeds}", there.len());
        // What all seeds took for each that got there.
        let a_success = all.iter().sum::<f64>() / there.len() as f64;
        println!(
            "{name:22} {:14.4} {:11.4} {a_success:11.4} {:12} {reached:>8}",
            median(&mut all),
            median(&mut there),
            counts[counts.len() / 2]
        );
    }
}

fn median(seconds: &mut [f64]) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds.get(seconds.len() / 2).copied().unwrap_or(f64::NAN)
}
