//! Laws over all optimisers × all problems, in both floating-point formats.

use shared::optim::{Firefly, FireflySettings, Optimiser, Pso, PsoSettings, RandomSearch};
use shared::scalar::Real;

const D: usize = 8;

type Problem = (&'static str, usize, fn(&[f64]) -> f64);

/// Costs over the unit cube with their number of unknowns.
const PROBLEMS: [Problem; 5] = [
    ("sphere", 3, |x| {
        x.iter().map(|v| (v - 0.3) * (v - 0.3)).sum()
    }),
    ("ellipsoid", 6, |x| {
        x.iter()
            .enumerate()
            .map(|(k, v)| 100f64.powi(k as i32 / 2) * (v - 0.6).powi(2))
            .sum()
    }),
    ("corner", 4, |x| x.iter().sum()),
    ("steps", 2, |x| {
        x.iter().map(|v| ((v - 0.5) * 20.0).abs().floor()).sum()
    }),
    ("half impossible", 2, |x| {
        if x[0] > 0.5 {
            f64::INFINITY
        } else {
            (x[0] - 0.4).powi(2) + x[1]
        }
    }),
];

fn optimisers<R: Real + 'static>(
    dim: usize,
    seed: u64,
) -> Vec<(&'static str, Box<dyn Optimiser<R, D>>)> {
    vec![
        (
            "pso",
            Box::new(Pso::<R, 20, D>::new(dim, 5, PsoSettings::default(), seed)),
        ),
        (
            "firefly",
            Box::new(Firefly::<R, 20, D>::new(
                dim,
                5,
                FireflySettings {
                    evaluations: 2000,
                    ..Default::default()
                },
                seed,
            )),
        ),
        ("random", Box::new(RandomSearch::<R, D>::new(dim, seed))),
    ]
}

/// Runs a search; gives the points asked for and the best.
fn search<R: Real>(
    optimiser: &mut dyn Optimiser<R, D>,
    cost: fn(&[f64]) -> f64,
    evaluations: usize,
) -> (Vec<Vec<f64>>, f64) {
    let dim = optimiser.dim();
    let asked = (0..evaluations)
        .map(|_| {
            let x: Vec<f64> = optimiser.ask()[..dim].iter().map(|v| v.to_f64()).collect();
            optimiser.tell(R::from_f64(cost(&x)));
            x
        })
        .collect();
    (asked, optimiser.best().cost.to_f64())
}

fn every<R: Real + 'static>(check: impl Fn(&str, &str, &mut dyn Optimiser<R, D>, &Problem, u64)) {
    for problem in &PROBLEMS {
        for seed in 1..=5 {
            for (name, mut optimiser) in optimisers::<R>(problem.1, seed) {
                check(name, problem.0, optimiser.as_mut(), problem, seed);
            }
        }
    }
}

#[test]
fn points_stay_in_the_cube_and_the_best_is_the_least_that_was_told() {
    fn check<R: Real + 'static>() {
        every::<R>(|name, on, optimiser, problem, seed| {
            let (asked, best) = search(optimiser, problem.2, 500);
            let least = asked
                .iter()
                .map(|x| problem.2(x))
                .fold(f64::INFINITY, f64::min);
            assert!(
                asked.iter().flatten().all(|v| (0.0..=1.0).contains(v)),
                "{name} on {on}, seed {seed}"
            );
            assert_eq!(
                R::from_f64(least).to_f64(),
                best,
                "{name} on {on}, seed {seed}"
            );
        });
    }
    check::<f64>();
    check::<f32>();
}

#[test]
fn the_same_seed_asks_for_the_same_bits_and_another_for_others() {
    every::<f32>(|name, on, optimiser, problem, seed| {
        let again = |seed| {
            let mut all = optimisers::<f32>(problem.1, seed);
            let (_, other) = all
                .iter_mut()
                .find(|(other, _)| *other == name)
                .expect("the same list");
            search(other.as_mut(), problem.2, 200).0
        };
        let first = search(optimiser, problem.2, 200).0;
        assert_eq!(first, again(seed), "{name} on {on}, seed {seed}");
        assert_ne!(first, again(seed + 1000), "{name} on {on}, seed {seed}");
    });
}

#[test]
fn a_cost_that_is_cut_off_at_the_bound_changes_no_decision() {
    every::<f64>(|name, on, optimiser, problem, seed| {
        let mut all = optimisers::<f64>(problem.1, seed);
        let (_, other) = all
            .iter_mut()
            .find(|(other, _)| *other == name)
            .expect("the same list");
        for k in 0..1000 {
            let (x, y) = (optimiser.ask(), other.ask());
            assert_eq!(x, y, "{name} on {on}, seed {seed}, evaluation {k}");
            let cost = problem.2(&x[..problem.1]);
            optimiser.tell(cost);
            // Anything above the bound will do: here the least such number.
            let bound = other.bound();
            other.tell(if cost > bound { bound.next_up() } else { cost });
        }
        assert_eq!(
            optimiser.best(),
            other.best(),
            "{name} on {on}, seed {seed}"
        );
    });
}

#[test]
fn not_a_number_is_never_the_best() {
    every::<f64>(|name, on, optimiser, problem, seed| {
        for k in 0..200 {
            let x = optimiser.ask();
            let cost = if k % 3 == 0 {
                f64::NAN
            } else {
                problem.2(&x[..problem.1])
            };
            optimiser.tell(cost);
        }
        assert!(
            !optimiser.best().cost.is_nan(),
            "{name} on {on}, seed {seed}"
        );
    });
}

/// Both swarms must beat random search on a smooth problem: medians over 31 seeds.
#[test]
fn swarms_beat_random_search() {
    let (_, dim, cost) = PROBLEMS[1];
    let mut costs: Vec<(&str, Vec<f64>)> =
        vec![("pso", vec![]), ("firefly", vec![]), ("random", vec![])];
    for seed in 1..=31 {
        for ((_, optimiser), (_, list)) in optimisers::<f64>(dim, seed).iter_mut().zip(&mut costs) {
            list.push(search(optimiser.as_mut(), cost, 2000).1);
        }
    }
    let medians: Vec<f64> = costs
        .iter_mut()
        .map(|(name, list)| {
            list.sort_by(f64::total_cmp);
            println!(
                "{name}: best {:.3e}, median {:.3e}, worst {:.3e} over seeds 1 to 31",
                list[0], list[15], list[30]
            );
            list[15]
        })
        .collect();
    assert!(
        medians[0] < 0.1 * medians[2] && medians[1] < 0.1 * medians[2],
        "{medians:?}"
    );
}
