//! This engine on the work of `benches/peers`: CPU seconds until a cost is within 1 % of the truth's.

use super::clock;
use super::linear::STEP;
use host::paper::{BOX, PRINTED, Variant, paper_problem};
use host::problem::Quick;
use host::solve::{Evaluator, Objective, Solver, cma_es, swarm::ParticleSwarm};
use std::sync::atomic::AtomicBool;

const SEEDS: u64 = 5;
const BUDGET: usize = 20_000;
const WITHIN: f64 = 1.01;

/// Prints them.
pub fn rows() {
    let data = STEP.record().expect("the paper's step");
    let variant = Variant::all().next().expect("a variant");
    let problem = paper_problem(&data, variant, BOX);
    let truth = PRINTED[0].values();
    let quick = Quick::new(&problem);
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
    for (name, solver) in searches {
        let mut runs: Vec<(f64, usize)> = Vec::new();
        let mut reached = 0;
        for seed in 1..=SEEDS {
            let (seconds, evaluations) = clock::once(|| {
                let stop = AtomicBool::new(false);
                let mut least = |_: usize, best: f64| {
                    if best <= target {
                        stop.store(true, std::sync::atomic::Ordering::Relaxed);
                    }
                };
                let mut evaluator = Evaluator::new(&quick, BUDGET, &stop, &mut least);
                solver.search(&mut evaluator, seed);
                let found = evaluator.finish();
                reached += usize::from(found.cost <= target);
                found.evaluations
            });
            runs.push((seconds, evaluations));
        }
        runs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (seconds, evaluations) = runs[runs.len() / 2];
        println!("{name:22} {seconds:14.4} {evaluations:12} {reached:4}/{SEEDS}");
    }
}
