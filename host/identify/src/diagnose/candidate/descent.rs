//! Levenberg and Marquardt's method for models that are costly beside their algebra: finite differences
//! once, then C. G. Broyden's update of the Jacobian (*Math. Comp.* 19, 577, 1965,
//! doi:10.1090/S0025-5718-1965-0198670-6), so that a step costs one evaluation instead of one for each
//! unknown; differences again where the updated Jacobian fails. Normal equations, since a diagnosis makes
//! some hundred Jacobians of twenty thousand rows, and their orthogonal decomposition would cost as much
//! as the simulations.

use super::bounded_step::within;
use super::settings::{BETTER, INSIDE};
pub use super::settings::{FINEST, PROBE};
use crate::diagnose::context::Budget;
use nalgebra::{DMatrix, DVector};
use servoid_engine::solve::Objective;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Most evaluations.
    pub evaluations: usize,
    /// Relative fall of the sum of squares, predicted or made, at which the search has converged.
    pub tolerance: f64,
    /// Only every so manyeth residual enters the Jacobian's products.
    pub stride: usize,
    /// Sum of squares that nothing more is wanted of.
    pub enough: f64,
    /// Damping of the first step. Where two unknowns do nearly the same, a strong one holds the search back
    /// from the valley's floor.
    pub damping: f64,
    /// Whether the Jacobian is updated between differences. Near the end of a narrow valley an updated one is
    /// not good enough.
    pub secant: bool,
    /// First step of the finite differences, as a share of the cube's side.
    pub probe: f64,
    /// RMS change of the residuals that the steps of further differences are to make; `None` for the first step always.
    pub probed: Option<f64>,
    /// Whether a search that ends at a wall is begun once more from a little inside: a coordinate that was driven there early may
    /// have no slope back.
    pub again: bool,
}

impl Settings {
    /// Of a search that shall converge: every residual, differences at every step, and once more from a wall.
    pub const THOROUGH: Settings = Settings {
        evaluations: 80,
        tolerance: 1e-4,
        stride: 1,
        enough: 0.0,
        damping: 1e-9,
        secant: false,
        probe: PROBE,
        probed: None,
        again: true,
    };
    /// Of a search that is to come near: few evaluations, every fourth residual, and one Jacobian as long as it holds.
    pub const ROUGH: Settings = Settings {
        evaluations: 40,
        tolerance: 1e-2,
        stride: 4,
        damping: 1e-4,
        secant: true,
        again: false,
        ..Settings::THOROUGH
    };
}

/// Where a search ended.
#[derive(Clone, Debug)]
pub struct Descent {
    /// Point of the unit cube.
    pub x: Vec<f64>,
    /// Sum of squares.
    pub squares: f64,
    /// Evaluations spent.
    pub evaluations: usize,
}

/// Steps that are set by what they change stay between these.
const PROBES: (f64, f64) = (1e-10, 1e-4);
/// Damping stays between these.
const DAMPING: (f64, f64) = (1e-12, 1e9);

/// Descends from `start`; `None` where the model cannot run there.
///
/// Where `budget` is exhausted the search ends with what it has.
pub fn descend(
    objective: &dyn Objective,
    start: &[f64],
    settings: Settings,
    budget: &Budget<'_>,
) -> Option<Descent> {
    let mut best = Search::new(objective, start, settings, budget)?.run();
    let inside = |x: &f64| x.clamp(INSIDE, 1.0 - INSIDE);
    let walled = best.x.iter().any(|x| *x == 0.0 || *x == 1.0);
    if settings.again && walled && best.squares > settings.enough {
        let start: Vec<f64> = best.x.iter().map(inside).collect();
        if let Some(search) = Search::new(objective, &start, settings, budget) {
            let again = search.run();
            let evaluations = best.evaluations + again.evaluations;
            if again.squares < best.squares * (1.0 - BETTER) {
                best = again;
            }
            best.evaluations = evaluations;
        }
    }
    Some(best)
}

struct Search<'a> {
    objective: &'a dyn Objective,
    settings: Settings,
    budget: &'a Budget<'a>,
    x: Vec<f64>,
    residuals: Vec<f64>,
    squares: f64,
    evaluations: usize,
    /// Columns of the Jacobian, thinned by the stride.
    columns: Vec<Vec<f64>>,
    fresh: bool,
    damping: f64,
    /// Steps of the next finite differences.
    probes: Vec<f64>,
}

impl<'a> Search<'a> {
    fn new(
        objective: &'a dyn Objective,
        start: &[f64],
        settings: Settings,
        budget: &'a Budget<'a>,
    ) -> Option<Self> {
        let x: Vec<f64> = start.iter().map(|x| x.clamp(0.0, 1.0)).collect();
        let (residuals, squares) = objective.residuals_and_cost(&x)?;
        squares.is_finite().then(|| Search {
            objective,
            settings,
            budget,
            residuals: thinned(residuals, settings.stride),
            x,
            squares,
            evaluations: 1,
            columns: Vec::new(),
            fresh: false,
            damping: settings.damping,
            probes: vec![settings.probe; start.len()],
        })
    }

    fn run(mut self) -> Descent {
        self.go_down();
        Descent {
            x: self.x,
            squares: self.squares,
            evaluations: self.evaluations,
        }
    }

    fn go_down(&mut self) {
        while self.differences() {
            loop {
                let before = self.squares;
                match self.step() {
                    Outcome::Taken { predicted } => {
                        let fall = (before - self.squares) / before;
                        if fall < self.settings.tolerance && predicted < self.settings.tolerance {
                            if self.fresh {
                                return;
                            }
                            break;
                        }
                        self.fresh = false;
                        if !self.settings.secant {
                            break;
                        }
                    }
                    Outcome::Refused if self.fresh => {
                        self.damping *= 10.0;
                        if self.damping > DAMPING.1 {
                            return;
                        }
                    }
                    Outcome::Refused => break,
                    Outcome::Nowhere if self.fresh => return,
                    Outcome::Nowhere => break,
                }
                if self.evaluations >= self.settings.evaluations || self.budget.exhausted() {
                    return;
                }
            }
        }
    }

    /// The Jacobian by differences, inwards at a wall. False if the evaluations do not suffice.
    fn differences(&mut self) -> bool {
        if self.evaluations + self.x.len() > self.settings.evaluations {
            return false;
        }
        if self.budget.exhausted() {
            return false;
        }
        let step = |(x, probe): (&f64, &f64)| if x + probe > 1.0 { -probe } else { *probe };
        let steps: Vec<f64> = self.x.iter().zip(&self.probes).map(step).collect();
        let moved: Vec<Vec<f64>> = (0..self.x.len())
            .map(|axis| {
                let mut moved = self.x.clone();
                moved[axis] += steps[axis];
                moved
            })
            .collect();
        // Of a long recording each is large: the old ones go before the new ones come.
        self.columns = Vec::new();
        let changes = self.objective.changes(&self.x, &moved);
        self.evaluations += moved.len();
        self.columns = changes
            .into_iter()
            .zip(&steps)
            .map(|(change, step)| match change {
                Some(mut change) => {
                    for change in &mut change {
                        *change /= step;
                    }
                    thinned(change, self.settings.stride)
                }
                None => vec![0.0; self.residuals.len()],
            })
            .collect();
        if let Some(wanted) = self.settings.probed {
            for (probe, column) in self.probes.iter_mut().zip(&self.columns) {
                let slope = (dot(column, column) / column.len().max(1) as f64).sqrt();
                *probe = (wanted / slope).clamp(PROBES.0, PROBES.1);
            }
        }
        self.fresh = true;
        true
    }

    /// Tries one step; books it if it leads down.
    fn step(&mut self) -> Outcome {
        let n = self.x.len();
        let gradient = DVector::from_fn(n, |i, _| dot(&self.columns[i], &self.residuals));
        // A coordinate that does nothing stays, and one at a wall whose cost falls outwards.
        let free: Vec<usize> = (0..n)
            .filter(|&i| {
                let out = (self.x[i] <= 0.0 && gradient[i] > 0.0)
                    || (self.x[i] >= 1.0 && gradient[i] < 0.0);
                !out && gradient[i] != 0.0
            })
            .collect();
        let normal = DMatrix::from_fn(free.len(), free.len(), |i, j| {
            dot(&self.columns[free[i]], &self.columns[free[j]])
        });
        let scale: Vec<f64> = (0..free.len())
            .map(|i| normal[(i, i)].max(f64::MIN_POSITIVE))
            .collect();
        let mut damped = normal.clone();
        for (i, scale) in scale.iter().enumerate() {
            damped[(i, i)] += self.damping * scale;
        }
        let pull = DVector::from_iterator(free.len(), free.iter().map(|&i| -gradient[i]));
        let room: Vec<(f64, f64)> = free
            .iter()
            .map(|&i| (-self.x[i], 1.0 - self.x[i]))
            .collect();
        let Some(moved) = within(&damped, &pull, &room) else {
            return Outcome::Nowhere;
        };
        let mut to = self.x.clone();
        for (&i, step) in free.iter().zip(moved.iter()) {
            to[i] = (to[i] + step).clamp(0.0, 1.0);
        }
        let predicted = 2.0 * moved.dot(&pull) - moved.dot(&(&normal * &moved));
        let whole = dot(&self.residuals, &self.residuals).max(f64::MIN_POSITIVE);
        if moved.iter().all(|m| *m == 0.0) {
            return Outcome::Nowhere;
        }
        self.evaluations += 1;
        // Only a Jacobian that stays learns from a step that is refused.
        let tried = if self.settings.secant && self.fresh {
            self.objective.residuals_and_cost(&to)
        } else {
            self.objective.residuals_within(&to, self.squares)
        };
        let Some((residuals, squares)) = tried.filter(|(_, squares)| squares.is_finite()) else {
            return Outcome::Refused;
        };
        let residuals = thinned(residuals, self.settings.stride);
        if self.settings.secant {
            self.update(&free, &moved, &scale, &residuals);
        }
        if squares >= self.squares {
            return Outcome::Refused;
        }
        let made = 1.0 - squares / self.squares;
        let predicted = predicted / whole;
        self.damping = if made > 0.5 * predicted {
            (self.damping * 0.1).max(DAMPING.0)
        } else {
            self.damping
        };
        self.x = to;
        self.residuals = residuals;
        self.squares = squares;
        Outcome::Taken { predicted }
    }

    /// Broyden's update: the least change of the Jacobian that predicts what was seen, measured in the
    /// unknowns' own scales.
    fn update(&mut self, free: &[usize], moved: &DVector<f64>, scale: &[f64], there: &[f64]) {
        let weight: f64 = moved.iter().zip(scale).map(|(m, s)| m * m * s).sum();
        if weight <= 0.0 {
            return;
        }
        let mut missed: Vec<f64> = there
            .iter()
            .zip(&self.residuals)
            .map(|(t, h)| t - h)
            .collect();
        for (&i, m) in free.iter().zip(moved.iter()) {
            for (missed, slope) in missed.iter_mut().zip(&self.columns[i]) {
                *missed -= slope * m;
            }
        }
        for ((&i, m), s) in free.iter().zip(moved.iter()).zip(scale) {
            let share = m * s / weight;
            for (slope, missed) in self.columns[i].iter_mut().zip(&missed) {
                *slope += missed * share;
            }
        }
    }
}

enum Outcome {
    /// The step led down; by how much, relatively, it was predicted to.
    Taken { predicted: f64 },
    /// It did not.
    Refused,
    /// There is no step.
    Nowhere,
}

/// In eight running sums, which the processor's lanes add side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a
        .remainder()
        .iter()
        .zip(b.remainder())
        .map(|(a, b)| a * b)
        .sum();
    for (a, b) in a.zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    sums.iter().sum::<f64>() + rest
}

fn thinned(values: Vec<f64>, stride: usize) -> Vec<f64> {
    if stride <= 1 {
        return values;
    }
    values.into_iter().step_by(stride).collect()
}

#[cfg(test)]
mod tests;
