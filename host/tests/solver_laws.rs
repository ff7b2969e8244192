//! Laws over all search methods × all problems: the cube, the budget, the books, the seed.

use host::solve::{self, Evaluator, Found, Objective, Solver};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// A cost with its name and number of unknowns.
struct Problem {
    name: &'static str,
    dim: usize,
    residuals: fn(&[f64]) -> Vec<f64>,
    asked: Mutex<Vec<Vec<f64>>>,
}

impl Objective for Problem {
    fn dim(&self) -> usize {
        self.dim
    }
    fn cost(&self, x: &[f64]) -> f64 {
        self.asked
            .lock()
            .expect("no panic elsewhere")
            .push(x.to_vec());
        sum((self.residuals)(x))
    }
    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        self.asked
            .lock()
            .expect("no panic elsewhere")
            .push(x.to_vec());
        let residuals = (self.residuals)(x);
        residuals
            .iter()
            .all(|r| r.is_finite())
            .then(|| (residuals.clone(), sum(residuals)))
    }
}

fn sum(residuals: Vec<f64>) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

fn problems() -> Vec<Problem> {
    let make = |name, dim, residuals| Problem {
        name,
        dim,
        residuals,
        asked: Mutex::new(Vec::new()),
    };
    vec![
        make("sphere", 3, |x| x.iter().map(|v| v - 0.3).collect()),
        make("ellipsoid", 4, |x| {
            x.iter()
                .enumerate()
                .map(|(k, v)| 10f64.powi(k as i32) * (v - 0.6))
                .collect()
        }),
        make("rosenbrock", 2, |x| {
            let (a, b) = (4.0 * x[0] - 2.0, 4.0 * x[1] - 2.0);
            vec![10.0 * (b - a * a), 1.0 - a]
        }),
        make("steps", 2, |x| {
            x.iter().map(|v| ((v - 0.5) * 20.0).round()).collect()
        }),
        make("corner", 3, |x| x.to_vec()),
        make("beyond the wall", 2, |x| vec![x[0] + 0.5, x[1] - 0.4]),
        make("half impossible", 2, |x| {
            if x[0] > 0.7 {
                vec![f64::INFINITY]
            } else {
                vec![x[0] - 0.6, x[1] - 0.2]
            }
        }),
    ]
}

fn search(
    solver: &dyn Solver,
    problem: &Problem,
    budget: usize,
    seed: u64,
) -> (Found, Vec<Vec<f64>>) {
    let stop = AtomicBool::new(false);
    let mut nobody = |_: usize, _: f64| {};
    let mut evaluator = Evaluator::new(problem, budget, &stop, &mut nobody);
    solver.search(&mut evaluator, seed);
    let asked = std::mem::take(&mut *problem.asked.lock().expect("no panic elsewhere"));
    (evaluator.finish(), asked)
}

fn every(check: impl Fn(&dyn Solver, &Problem, u64)) {
    for solver in solve::all() {
        for problem in problems() {
            for seed in [1, 2, 3] {
                check(solver.as_ref(), &problem, seed);
            }
        }
    }
}

#[test]
fn the_cube_the_budget_and_the_books_are_kept() {
    every(|solver, problem, seed| {
        let (found, asked) = search(solver, problem, 400, seed);
        let at = format!("{} on {}, seed {seed}", solver.name(), problem.name);
        assert!(
            asked.iter().flatten().all(|v| (0.0..=1.0).contains(v)),
            "{at}: left the cube"
        );
        assert!(asked.len() <= 400, "{at}: {} evaluations", asked.len());
        assert_eq!(
            found.evaluations,
            asked.len(),
            "{at}: not every evaluation is counted"
        );
        assert_eq!(
            found.cost,
            sum((problem.residuals)(&found.x)),
            "{at}: cost of another point"
        );
        let least = asked
            .iter()
            .map(|x| sum((problem.residuals)(x)))
            .fold(f64::INFINITY, f64::min);
        assert_eq!(found.cost, least, "{at}: the best was forgotten");
        assert!(
            found
                .curve
                .windows(2)
                .all(|w| w[0].0 < w[1].0 && w[0].1 > w[1].1),
            "{at}: curve not falling"
        );
    });
}

#[test]
fn the_same_seed_gives_the_same_bits() {
    every(|solver, problem, seed| {
        let first = search(solver, problem, 300, seed).1;
        let second = search(solver, problem, 300, seed).1;
        assert_eq!(
            first,
            second,
            "{} on {}, seed {seed}",
            solver.name(),
            problem.name
        );
    });
}

#[test]
fn another_seed_searches_elsewhere() {
    for solver in solve::all() {
        // From one start the deterministic methods have one path (the simplex until its first restart).
        if ["lm", "nelder_mead"].contains(&solver.name()) {
            continue;
        }
        let problem = &problems()[0];
        assert_ne!(
            search(solver.as_ref(), problem, 100, 1).1,
            search(solver.as_ref(), problem, 100, 2).1,
            "{}",
            solver.name()
        );
    }
}

#[test]
fn a_stop_is_heeded_at_once() {
    every(|solver, problem, seed| {
        let stop = AtomicBool::new(false);
        let mut after_ten = |count: usize, _: f64| {
            if count == 10 {
                stop.store(true, Ordering::Relaxed);
            }
        };
        let mut evaluator = Evaluator::new(problem, 100_000, &stop, &mut after_ten);
        solver.search(&mut evaluator, seed);
        let found = evaluator.finish();
        assert!(
            found.evaluations <= 10,
            "{} on {}, seed {seed}",
            solver.name(),
            problem.name
        );
        assert!(
            found.interrupted || found.evaluations < 10,
            "{} on {}",
            solver.name(),
            problem.name
        );
        problem.asked.lock().expect("no panic elsewhere").clear();
    });
}

/// Medians over 31 seeds at 600 evaluations.
#[test]
fn every_method_beats_random_search_on_the_ellipsoid() {
    let problem = &problems()[1];
    let mut medians = Vec::new();
    for solver in solve::all() {
        let mut costs: Vec<f64> = (1..=31)
            .map(|seed| search(solver.as_ref(), problem, 600, seed).0.cost)
            .collect();
        costs.sort_by(f64::total_cmp);
        println!(
            "{}: best {:.2e}, median {:.2e}, worst {:.2e}",
            solver.name(),
            costs[0],
            costs[15],
            costs[30]
        );
        medians.push((solver.name(), costs[15]));
    }
    let random = medians
        .iter()
        .find(|(name, _)| *name == "random")
        .expect("in the list")
        .1;
    for (name, median) in medians {
        assert!(
            name == "random" || median < 0.2 * random,
            "{name}: {median} against {random}"
        );
    }
}
