//! The linear motor on the paper's step of 10,000 samples: one cost, searches, and the paper's comparison.

use super::{clock, euler};
use servoid_engine::block_cost::BlockCost;
use servoid_engine::compare::{self, Contest};
use servoid_engine::problem::FitProblem;
use servoid_engine::solve::{self, Evaluator, Found, Objective, Solver, swarm::ParticleSwarm};
use servoid_identify::fit::{self, Options};
use servoid_identify::paper::{self, BOX, Experiment, Variant};
use shared::rng;
use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// The paper's step.
pub const STEP: Experiment = Experiment {
    seconds: 10.0,
    sample_s: 1e-3,
};
const CANDIDATES: usize = 5;
const PARTICLES: usize = 50;
const ROUNDS: usize = 400;
const SEEDS: u64 = 30;
const BUDGET: usize = 5000;
const THREADS: usize = 2;

fn row(what: &str, seconds: f64, reference: f64) {
    println!(
        "{what:58} {:12.3} us {:8.1}x",
        seconds * 1e6,
        reference / seconds
    );
}

/// Prints them.
pub fn rows() {
    let data = STEP.record().expect("the paper's step");
    let variant = Variant::all().next().expect("a variant");
    let problem = paper::paper_problem(&data, variant, BOX);
    let quick = BlockCost::new(&problem);
    let mut generator = rng::seeded(1);
    let points: Vec<Vec<f64>> = (0..CANDIDATES)
        .map(|_| {
            let mut draw = || 0.3 + 0.4 * rng::uniform::<f64>(&mut generator);
            (0..problem.dim()).map(|_| draw()).collect()
        })
        .collect();
    let machines: Vec<_> = points
        .iter()
        .map(|x| problem.structure.candidate_at(x).machine)
        .collect();
    let each = |cost: &dyn Fn(usize) -> f64| {
        clock::least(|| (0..CANDIDATES).map(|k| cost(black_box(k))).sum::<f64>())
            / CANDIDATES as f64
    };
    let reference = each(&|k| euler::cost(&machines[k], &data));
    row("scalar Euler, f64", reference, reference);
    row(
        "cost, sample by sample",
        each(&|k| problem.cost(&points[k])),
        reference,
    );
    row(
        "full cost, five candidates by turns",
        each(&|k| quick.cost(&points[k])),
        reference,
    );
    row(
        "refused by the bound",
        each(&|k| quick.cost_within(&points[k], 1e-3)),
        reference,
    );
    swarm(&problem, reference);
    least_squares(&data, reference);
    contest(&problem, reference);
}

/// The same costs, always in full.
struct Full<'a>(BlockCost<'a>);

impl Objective for Full<'_> {
    fn dim(&self) -> usize {
        self.0.dim()
    }
    fn cost(&self, x: &[f64]) -> f64 {
        self.0.cost(x)
    }
}

fn swarm(problem: &FitProblem<'_>, reference: f64) {
    let search = |objective: &dyn Objective| -> Found {
        let stop = AtomicBool::new(false);
        let mut nobody = |_: usize, _: f64| {};
        let mut evaluator = Evaluator::new(objective, PARTICLES * ROUNDS, &stop, &mut nobody);
        let swarm = ParticleSwarm {
            population: PARTICLES,
            ..ParticleSwarm::default()
        };
        swarm.search(&mut evaluator, 1);
        evaluator.finish()
    };
    let (cut, full) = (BlockCost::new(problem), Full(BlockCost::new(problem)));
    let (found, other) = (search(&cut), search(&full));
    let same = found.x == other.x && found.curve == other.curve;
    let whole = reference * found.evaluations as f64;
    row(
        "PSO 50 x 400, every cost in full",
        clock::least(|| search(&full)),
        whole,
    );
    row(
        "PSO 50 x 400, refusing by the bound",
        clock::least(|| search(&cut)),
        whole,
    );
    println!("  decisions identical: {same}; best cost {:.6}", found.cost);
}

fn least_squares(data: &servoid_engine::problem::Data, reference: f64) {
    let options = Options::default();
    let solver = solve::by_name("lm").expect("a method");
    let fitted = || {
        let stop = AtomicBool::new(false);
        let problem = fit::problem(data, &options).expect("a start");
        fit::search(&problem, solver.as_ref(), &options, &stop, &mut |_, _| {})
    };
    let evaluations = fitted().evaluations;
    let start = clock::least(|| fit::problem(data, &options).map(|problem| problem.start));
    row("start by regression", start, reference);
    row(
        "fit: regression, then Levenberg-Marquardt",
        clock::least(fitted),
        reference,
    );
    println!("  {evaluations} evaluations");
}

fn contest(problem: &FitProblem<'_>, reference: f64) {
    let contest = Contest {
        problem,
        budget: BUDGET,
        seeds: (1..=SEEDS).collect(),
    };
    let solvers = paper::solvers(CANDIDATES);
    let stop = AtomicBool::new(false);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(THREADS).build();
    let pool = pool.expect("threads");
    let began = Instant::now();
    let (seconds, rows) =
        clock::once(|| pool.install(|| compare::run(&contest, &solvers, &stop, &|| ())));
    let wall = began.elapsed().as_secs_f64();
    let evaluations: usize = rows
        .iter()
        .flat_map(|row| &row.runs)
        .map(|run| run.evaluations)
        .sum();
    row(
        "the paper's GA, PSO and FA, 5 x 1000, 30 seeds: CPU",
        seconds,
        reference * evaluations as f64,
    );
    println!("  on the wall with {THREADS} threads: {wall:.2} s");
}
