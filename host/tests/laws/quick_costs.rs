//! Quicker costs are the costs, and whoever only compares them decides the same.

use servoid_engine::block_cost::BlockCost;
use servoid_engine::problem::{Base, Data, FitProblem, Horizon, StartAngle, Structure};
use servoid_engine::solve::{Evaluator, Found, Objective, Solver, swarm};
use servoid_identify::paper::{BOX, Experiment, Variant, paper_problem};
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::cost::Cost;
use shared::motor::Machine;
use shared::rng;
use std::sync::atomic::AtomicBool;

/// Most that a quick cost may differ from the plain one, as a part of it.
const TOLERANCE: f64 = 1e-9;
const SEEDS: u64 = 6;

/// Readings of a slow wander under commands that are held for some time each.
fn data(seed: u64, quantised: bool) -> Data {
    let mut generator = rng::seeded(seed);
    let mut draw = || rng::uniform::<f64>(&mut generator);
    let mut command = Vec::new();
    while command.len() < 4000 {
        let held = 1 + (600.0 * draw()) as usize;
        command.extend(std::iter::repeat_n(24.0 * draw() - 12.0, held));
    }
    let mut angle = 100.0 * draw();
    let counts = command.iter().map(|volts| {
        angle += 3.0 * volts;
        if quantised { angle.floor() } else { angle }
    });
    let recording = Recording {
        source: "test".to_owned(),
        time_s: (0..command.len()).map(|k| k as f64 * 1e-3).collect(),
        counts: counts.collect(),
        command,
        measured: Series::NONE,
        enabled: None,
        counts_per_rev: 2000.0,
        quantised,
        supply_v: Some(12.0),
        drive: Drive::Voltage,
        position: None,
    };
    Data::new(&recording).expect("valid bases")
}

fn problem(data: &Data, cost: Cost, start_angle: StartAngle, start_speed: bool) -> FitProblem<'_> {
    let centre = Machine {
        kb: 0.05,
        damping: 0.002,
        inertia: 0.0025,
        electrical: 0.0016,
    };
    let base = Base::Response { damping: false };
    FitProblem {
        data,
        structure: Structure::around(data, base, &[], &centre, start_speed),
        cost,
        weight: 0.5,
        horizon: Horizon::Whole,
        start_angle,
        method: Default::default(),
        start: None,
    }
}

const COSTS: [Cost; 3] = [
    Cost::Absolute {
        model_floored: false,
    },
    Cost::Absolute {
        model_floored: true,
    },
    Cost::Squared,
];

/// Calls `check` with problems of all sorts and points of their cubes.
fn everywhere(mut check: impl FnMut(&FitProblem<'_>, &[f64], &str)) {
    let mut at = |problem: &FitProblem<'_>, seed: u64, label: &str| {
        let mut generator = rng::seeded(seed);
        for _ in 0..20 {
            let x: Vec<f64> = (0..problem.dim())
                .map(|_| rng::uniform(&mut generator))
                .collect();
            check(problem, &x, label);
        }
    };
    for seed in 0..SEEDS {
        for (cost, quantised) in COSTS
            .iter()
            .flat_map(|cost| [(*cost, true), (*cost, false)])
        {
            let data = data(seed, quantised);
            let starts = [(StartAngle::Known, false), (StartAngle::Free, true)];
            for (start_angle, start_speed) in starts {
                let label =
                    format!("seed {seed}, {cost:?}, {start_angle:?}, quantised {quantised}");
                at(
                    &problem(&data, cost, start_angle, start_speed),
                    seed,
                    &label,
                );
            }
        }
    }
    let experiment = Experiment {
        seconds: 5.0,
        sample_s: 1e-3,
    };
    let data = experiment.record().expect("a recording");
    for variant in Variant::all() {
        let label = format!("the paper's step, {}", variant.name());
        for seed in 0..SEEDS {
            at(&paper_problem(&data, variant, BOX), seed, &label);
        }
    }
}

fn same(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= TOLERANCE * a.abs().max(b.abs())
}

#[test]
fn a_quick_cost_is_the_cost() {
    let (mut checked, mut most) = (0, 0.0f64);
    everywhere(|problem, x, label| {
        let quick = BlockCost::new(problem);
        let (plain, quick) = (problem.cost(x), quick.cost(x));
        // A floored error of nearly a whole count may fall to either side.
        let floored = problem.cost == COSTS[1];
        let apart = (plain - quick).abs() <= 3.0 * problem.weight;
        assert!(
            same(plain, quick) || (floored && apart),
            "{label}: {plain} is not {quick} at {x:?}"
        );
        if plain.is_finite() && !floored {
            most = most.max((plain - quick).abs() / plain);
            checked += 1;
        }
    });
    println!("{checked} costs, the farthest off by {most:.1e}");
    assert!(checked > 300);
}

/// The slowest motors that the paper's box has and the fastest, whose lines and transients would be numbers far larger than
/// their angles.
#[test]
fn motors_in_the_corners_of_the_box_cost_the_same() {
    let experiment = Experiment {
        seconds: 5.0,
        sample_s: 1e-3,
    };
    let data = experiment.record().expect("a recording");
    let mut finite = 0;
    for variant in Variant::all() {
        let problem = paper_problem(&data, variant, BOX);
        let quick = BlockCost::new(&problem);
        for corner in 0..1 << problem.dim() {
            let x: Vec<f64> = (0..problem.dim())
                .map(|k| f64::from(corner >> k & 1))
                .collect();
            let label = format!("{}, corner {corner}", variant.name());
            let (plain, cost) = (problem.cost(&x), quick.cost(&x));
            let apart = (plain - cost).abs() <= 3.0 * problem.weight;
            let floored = problem.cost == COSTS[1];
            assert!(
                same(plain, cost) || (floored && apart),
                "{label}: {plain} is not {cost}"
            );
            if cost.is_finite() {
                finite += 1;
                assert_eq!(quick.cost_within(&x, cost), cost, "{label}");
                assert!(quick.cost_within(&x, 0.9 * cost) > 0.9 * cost, "{label}");
            }
        }
    }
    assert!(finite > 100, "{finite}");
}

#[test]
fn problems_with_held_commands_are_quick() {
    let data = data(1, true);
    for cost in COSTS {
        assert!(BlockCost::new(&problem(&data, cost, StartAngle::Known, false)).helps());
    }
}

/// Below the limit the cost to the bit, else something above the limit.
#[test]
fn a_limit_changes_nothing_below_it() {
    everywhere(|problem, x, label| {
        let quick = BlockCost::new(problem);
        let cost = quick.cost(x);
        for part in [0.0, 0.3, 0.9, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 1.1, 1e3] {
            let limit = cost * part;
            let within = quick.cost_within(x, limit);
            let right = if cost <= limit {
                within == cost
            } else {
                within > limit
            };
            assert!(right, "{label}: {within} within {limit} of {cost} at {x:?}");
        }
    });
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

fn search(solver: &dyn Solver, objective: &dyn Objective, seed: u64) -> Found {
    let stop = AtomicBool::new(false);
    let mut nobody = |_: usize, _: f64| {};
    let mut evaluator = Evaluator::new(objective, 1500, &stop, &mut nobody);
    solver.search(&mut evaluator, seed);
    evaluator.finish()
}

#[test]
fn whoever_only_compares_costs_decides_the_same() {
    let solvers: [Box<dyn Solver>; 4] = [
        Box::new(swarm::ParticleSwarm::default()),
        Box::new(swarm::ParticleSwarm {
            population: 5,
            ..Default::default()
        }),
        Box::new(swarm::Fireflies::default()),
        Box::new(swarm::Random),
    ];
    let experiment = Experiment {
        seconds: 5.0,
        sample_s: 1e-3,
    };
    let step = experiment.record().expect("a recording");
    let wander = data(3, true);
    let mut problems: Vec<FitProblem<'_>> = Variant::all()
        .map(|variant| paper_problem(&step, variant, BOX))
        .collect();
    problems.extend(COSTS.map(|cost| problem(&wander, cost, StartAngle::Known, false)));
    for (number, problem) in problems.iter().enumerate() {
        for solver in &solvers {
            for seed in 0..SEEDS {
                let cut = search(solver.as_ref(), &BlockCost::new(problem), seed);
                let full = search(solver.as_ref(), &Full(BlockCost::new(problem)), seed);
                let label = format!("problem {number}, {}, seed {seed}", solver.name());
                assert_eq!(cut.x, full.x, "{label}");
                assert_eq!(cut.curve, full.curve, "{label}");
                assert_eq!(cut.evaluations, full.evaluations, "{label}");
            }
        }
    }
}
