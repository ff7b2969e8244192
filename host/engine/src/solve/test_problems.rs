//! Problems that the laws of the solvers are tried on. Each asserts that it is asked inside the cube.

use super::Objective;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

/// A problem in residuals; its cost is their sum of squares.
#[derive(Clone, Copy)]
pub(super) struct Problem {
    pub(super) name: &'static str,
    pub(super) dim: usize,
    /// `None` where the model is impossible.
    residuals: fn(&[f64]) -> Option<Vec<f64>>,
    /// The least cost in the cube.
    pub(super) least: f64,
    /// Whether the residuals have derivatives all the way to the optimum.
    pub(super) smooth: bool,
}

/// Off the centre, different in every coordinate.
const SHIFTED: [f64; 4] = [0.37, 0.81, 0.15, 0.62];

fn shifted(x: &[f64]) -> impl Iterator<Item = f64> {
    x.iter().zip(SHIFTED).map(|(x, c)| x - c)
}

/// All of them.
pub(super) const PROBLEMS: [Problem; 6] = [
    Problem {
        name: "sphere",
        dim: 4,
        least: 0.0,
        smooth: true,
        residuals: |x| Some(shifted(x).collect()),
    },
    Problem {
        name: "ellipsoid of condition 1e6",
        dim: 4,
        least: 0.0,
        smooth: true,
        residuals: |x| {
            let weight = |k: usize| libm::pow(1e3f64, k as f64 / (x.len() - 1) as f64);
            Some(shifted(x).enumerate().map(|(k, e)| e * weight(k)).collect())
        },
    },
    Problem {
        name: "Rosenbrock",
        dim: 2,
        least: 0.0,
        smooth: true,
        residuals: |x| {
            let (a, b) = (4.0 * x[0] - 2.0, 4.0 * x[1] - 2.0);
            Some(vec![10.0 * (b - a * a), 1.0 - a])
        },
    },
    Problem {
        name: "sphere in steps of 0.01",
        dim: 4,
        least: 0.0,
        smooth: false,
        residuals: |x| Some(shifted(x).map(|e| (100.0 * e).floor() / 100.0).collect()),
    },
    Problem {
        name: "corner",
        dim: 3,
        least: 0.23,
        smooth: true,
        residuals: |x| {
            Some(vec![
                x[0] + 0.3,
                1.2 - x[1],
                x[2] + 0.1,
                0.3 * (x[0] - x[1] + x[2]),
            ])
        },
    },
    Problem {
        name: "impossible beyond a plane",
        dim: 3,
        least: 0.13 * 0.13 / 3.0,
        smooth: false,
        residuals: |x| {
            let possible = x.iter().sum::<f64>() < 1.2;
            possible.then(|| shifted(x).collect())
        },
    },
];

impl Problem {
    pub(super) fn named(name: &str) -> Problem {
        PROBLEMS
            .into_iter()
            .find(|p| p.name == name)
            .expect("a problem of the list")
    }

    fn squares(&self, x: &[f64]) -> f64 {
        (self.residuals)(x).map_or(f64::INFINITY, |r| r.iter().map(|r| r * r).sum())
    }
}

/// A problem that remembers every point it was asked for, and may raise the stop flag.
pub(super) struct Witness {
    problem: Problem,
    pub(super) asked: Mutex<Vec<Vec<u64>>>,
    pub(super) count: AtomicUsize,
    pub(super) stop: AtomicBool,
    stop_at: usize,
}

impl Witness {
    pub(super) fn of(problem: Problem) -> Self {
        Witness::stopping(problem, usize::MAX)
    }

    /// Raises the stop flag during evaluation `stop_at`.
    pub(super) fn stopping(problem: Problem, stop_at: usize) -> Self {
        Witness {
            problem,
            asked: Mutex::new(Vec::new()),
            count: AtomicUsize::new(0),
            stop: AtomicBool::new(false),
            stop_at,
        }
    }

    fn note(&self, x: &[f64]) {
        assert_eq!(x.len(), self.problem.dim);
        assert!(
            x.iter().all(|x| (0.0..=1.0).contains(x)),
            "asked outside the cube: {x:?}"
        );
        self.asked
            .lock()
            .expect("no panic before")
            .push(x.iter().map(|x| x.to_bits()).collect());
        if self.count.fetch_add(1, Ordering::Relaxed) + 1 == self.stop_at {
            self.stop.store(true, Ordering::Relaxed);
        }
    }
}

impl Objective for Witness {
    fn dim(&self) -> usize {
        self.problem.dim
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.note(x);
        self.problem.squares(x)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        self.note(x);
        let residuals = (self.problem.residuals)(x)?;
        Some((residuals, self.problem.squares(x)))
    }
}
