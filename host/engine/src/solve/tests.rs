//! Laws that every solver obeys on every problem, and how much better than chance they are.

use super::ga::Ga;
use super::levenberg_marquardt::LevenbergMarquardt;
use super::test_problems::{PROBLEMS, Problem, Witness};
use super::{Evaluator, Found, Objective, Solver, all, by_name};

/// Methods whose one run takes no random number.
const DETERMINISTIC: [&str; 1] = ["lm"];

fn search(solver: &dyn Solver, witness: &Witness, budget: usize, seed: u64) -> Found {
    let mut nobody = |_: usize, _: f64| {};
    let mut evaluator = Evaluator::new(witness, budget, &witness.stop, &mut nobody);
    solver.search(&mut evaluator, seed);
    evaluator.finish()
}

/// Every solver with its usual settings, and those settings that change its course.
fn solvers() -> Vec<(String, Box<dyn Solver>)> {
    let mut solvers: Vec<(String, Box<dyn Solver>)> = all()
        .into_iter()
        .map(|solver| (solver.name().to_owned(), solver))
        .collect();
    for (population, elites) in [(2, 1), (5, 4), (50, 0)] {
        let ga = Ga {
            population,
            elites,
            ..Default::default()
        };
        solvers.push((format!("{ga:?}"), Box::new(ga)));
    }
    solvers
}

/// Every solver on every problem.
fn pairs() -> impl Iterator<Item = (Box<dyn Solver>, Problem, String)> {
    PROBLEMS.into_iter().flat_map(|problem| {
        solvers().into_iter().map(move |(label, solver)| {
            let label = format!("{label} on {}", problem.name);
            (solver, problem, label)
        })
    })
}

fn asked(witness: &Witness) -> Vec<Vec<u64>> {
    witness.asked.lock().expect("no panic before").clone()
}

#[test]
fn the_budget_is_kept_and_the_counts_are_honest() {
    for (solver, problem, label) in pairs() {
        for budget in [0, 1, 2, 5, 23, 700] {
            let witness = Witness::of(problem);
            let found = search(solver.as_ref(), &witness, budget, 1);
            let evaluated = asked(&witness).len();
            assert!(
                found.evaluations <= budget,
                "{label}: {} of {budget}",
                found.evaluations
            );
            assert_eq!(found.evaluations, evaluated, "{label}: booked, made");
            assert!(budget == 0 || evaluated > 0, "{label}: idle");
        }
    }
}

#[test]
fn the_best_cost_is_that_of_the_reported_point() {
    for (solver, problem, label) in pairs() {
        let witness = Witness::of(problem);
        let found = search(solver.as_ref(), &witness, 700, 2);
        let evaluated = asked(&witness);
        let bits: Vec<u64> = found.x.iter().map(|x| x.to_bits()).collect();
        if found.cost.is_finite() {
            assert!(
                evaluated.contains(&bits),
                "{label}: reports a point it never tried"
            );
            assert_eq!(witness.cost(&found.x), found.cost, "{label}");
        }
        let falls = found
            .curve
            .windows(2)
            .all(|w| w[0].0 < w[1].0 && w[0].1 > w[1].1);
        assert!(falls, "{label}: {:?}", found.curve);
        assert_eq!(
            found.curve.last().map_or(f64::INFINITY, |last| last.1),
            found.cost,
            "{label}"
        );
    }
}

#[test]
fn the_seed_alone_decides() {
    for (solver, problem, label) in pairs() {
        let run = |seed| {
            let witness = Witness::of(problem);
            search(solver.as_ref(), &witness, 400, seed);
            asked(&witness)
        };
        assert_eq!(run(7), run(7), "{label}: the same seed, twice");
        if !DETERMINISTIC.contains(&solver.name()) {
            assert_ne!(run(7), run(8), "{label}: two seeds");
        }
    }
}

#[test]
fn a_raised_flag_stops_the_search() {
    for (solver, problem, label) in pairs() {
        for stop_at in [1, 9, 150] {
            let witness = Witness::stopping(problem, stop_at);
            let found = search(solver.as_ref(), &witness, 2000, 3);
            assert!(
                found.evaluations <= stop_at,
                "{label}: went on to {}",
                found.evaluations
            );
            assert_eq!(found.interrupted, found.evaluations == stop_at, "{label}");
        }
    }
}

fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

/// Costs over the seeds, ascending.
fn costs(solver: &dyn Solver, problem: Problem, budget: usize, seeds: u64) -> Vec<f64> {
    let run = |seed| search(solver, &Witness::of(problem), budget, seed).cost;
    let mut costs: Vec<f64> = (1..=seeds).map(run).collect();
    costs.sort_by(f64::total_cmp);
    let [q1, median, q3] = [0.25, 0.5, 0.75].map(|share| quantile(&costs, share));
    let worst = costs[costs.len() - 1];
    println!(
        "{:>12} on {:<28} {q1:9.2e} {median:9.2e} {q3:9.2e} {worst:9.2e}",
        solver.name(),
        problem.name
    );
    costs
}

#[test]
fn all_beat_chance_on_the_sphere() {
    let sphere = Problem::named("sphere");
    let random = by_name("random").expect("a baseline");
    let chance = quantile(&costs(random.as_ref(), sphere, 600, 31), 0.5);
    for solver in all().iter().filter(|solver| solver.name() != "random") {
        let median = quantile(&costs(solver.as_ref(), sphere, 600, 31), 0.5);
        assert!(
            median < 0.1 * chance,
            "{}: {median:e} against {chance:e}",
            solver.name()
        );
    }
}

/// What the strong methods are there for.
#[test]
fn the_strong_methods_find_the_optimum() {
    for problem in PROBLEMS {
        for name in ["lm", "nelder_mead", "cmaes", "de"] {
            let solver = by_name(name).expect("a method of the list");
            let median = quantile(&costs(solver.as_ref(), problem, 3000, 31), 0.5);
            if problem.smooth || name != "lm" {
                let above = median - problem.least;
                assert!(
                    above < 1e-6,
                    "{name} on {}: {above:e} above the optimum",
                    problem.name
                );
            }
        }
    }
}

/// Children of which every gene mutates are new points, so a point asked for twice could only be an
/// elite that is evaluated again.
#[test]
fn elites_are_not_evaluated_again() {
    for (population, elites) in [(5, 4), (5, 1), (50, 10)] {
        let restless = Ga {
            population,
            elites,
            mutation_rate: Some(1.0),
        };
        let witness = Witness::of(Problem::named("sphere"));
        search(&restless, &witness, 2000, 4);
        let mut evaluated = asked(&witness);
        evaluated.sort();
        evaluated.dedup();
        assert_eq!(evaluated.len(), 2000, "{restless:?}");
    }
}

/// A start where the model is impossible is replaced, not given up on.
#[test]
fn least_squares_gets_away_from_an_impossible_start() {
    let problem = Problem::named("impossible beyond a plane");
    let lm = LevenbergMarquardt::default();
    let costs = costs(&lm, problem, 500, 31);
    assert!(costs.iter().all(|cost| cost.is_finite()));
}
