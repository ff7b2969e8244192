//! The search against least squares whose answer is known.

use super::*;
use shared::rng;
use std::sync::atomic::AtomicBool;

/// Residuals that are linear in the unknowns, two of which do nearly the same.
struct Slanted {
    columns: Vec<Vec<f64>>,
    target: Vec<f64>,
}

const UNKNOWNS: usize = 4;
const ROWS: usize = 24;

impl Slanted {
    fn draw(seed: u64) -> Self {
        let mut generator = rng::seeded(seed);
        let mut draw = || 2.0 * rng::uniform::<f64>(&mut generator) - 1.0;
        let mut columns: Vec<Vec<f64>> = (0..UNKNOWNS)
            .map(|_| (0..ROWS).map(|_| draw()).collect())
            .collect();
        columns[1] = columns[0]
            .iter()
            .zip(&columns[1])
            .map(|(same, own)| same + 0.02 * own)
            .collect();
        // The minimum without walls lies inside for some unknowns and beyond a wall for others.
        let free: Vec<f64> = (0..UNKNOWNS).map(|_| 0.5 + 1.5 * draw()).collect();
        let target = (0..ROWS)
            .map(|row| {
                let model: f64 = (0..UNKNOWNS).map(|i| columns[i][row] * free[i]).sum();
                model + 0.1 * draw()
            })
            .collect();
        Slanted { columns, target }
    }

    /// The least sum of squares within the cube, by going down one unknown at a time for very long.
    fn least(&self) -> f64 {
        let mut x = [0.5; UNKNOWNS];
        for _ in 0..200_000 {
            for i in 0..UNKNOWNS {
                let residuals = self.residuals(&x);
                let step =
                    dot(&self.columns[i], &residuals) / dot(&self.columns[i], &self.columns[i]);
                x[i] = (x[i] - step).clamp(0.0, 1.0);
            }
        }
        let residuals = self.residuals(&x);
        dot(&residuals, &residuals)
    }

    fn residuals(&self, x: &[f64]) -> Vec<f64> {
        let model =
            |row: usize| -> f64 { (0..UNKNOWNS).map(|i| self.columns[i][row] * x[i]).sum() };
        (0..ROWS).map(|row| model(row) - self.target[row]).collect()
    }
}

impl Objective for Slanted {
    fn dim(&self) -> usize {
        UNKNOWNS
    }

    fn cost(&self, x: &[f64]) -> f64 {
        let residuals = self.residuals(x);
        dot(&residuals, &residuals)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        Some((self.residuals(x), self.cost(x)))
    }
}

/// A step that is merely cut off at a wall climbs the side of a valley that slants across it.
#[test]
fn a_valley_that_slants_across_a_wall_is_followed_to_its_lowest_point_within() {
    let settings = Settings {
        evaluations: 400,
        tolerance: 1e-9,
        ..Settings::THOROUGH
    };
    let stop = AtomicBool::new(false);
    let budget = Budget::usual(&stop);
    for seed in 0..40 {
        let problem = Slanted::draw(seed);
        let found = descend(&problem, &[0.5; UNKNOWNS], settings, &budget).unwrap();
        let least = problem.least();
        assert!(
            found.squares < least * 1.001 + 1e-9,
            "seed {seed}: {} at {:?}, {least} is there",
            found.squares,
            found.x
        );
        assert!(
            found.x.iter().all(|x| (0.0..=1.0).contains(x)),
            "seed {seed}"
        );
    }
}

/// Waves that a usual step of the differences leaps over.
struct Fine;

impl Objective for Fine {
    fn dim(&self) -> usize {
        1
    }

    fn cost(&self, x: &[f64]) -> f64 {
        let residuals = self.residuals_and_cost(x).unwrap().0;
        dot(&residuals, &residuals)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let residuals: Vec<f64> = (0..16)
            .map(|row| libm::sin(1e7 * (1.0 + f64::from(row) / 100.0) * (x[0] - 0.3)))
            .collect();
        let squares = dot(&residuals, &residuals);
        Some((residuals, squares))
    }
}

/// The step of the differences follows how steep the residuals are.
#[test]
fn steps_that_follow_what_they_change_find_the_bottom_of_a_fine_wave() {
    let settings = Settings {
        evaluations: 100,
        tolerance: 1e-9,
        probe: 1e-8,
        probed: Some(0.01),
        ..Settings::THOROUGH
    };
    let stop = AtomicBool::new(false);
    let budget = Budget::usual(&stop);
    for off in [-0.6e-7, -0.2e-7, 0.3e-7, 0.5e-7] {
        let found = descend(&Fine, &[0.3 + off], settings, &budget).unwrap();
        assert!(found.squares < 1e-9, "{off:e}: {}", found.squares);
    }
}
