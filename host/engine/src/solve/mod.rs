//! Search methods behind one trait: each minimises a cost over the unit cube, and every single model
//! evaluation is counted by the [`Evaluator`], whichever crate the method comes from.

pub mod cma_es;
mod compressed;
mod cube;
pub mod differential_evolution;
pub mod ga;
pub mod levenberg_marquardt;
pub mod nelder_mead;
mod restart;
pub mod swarm;

#[cfg(test)]
mod test_problems;
#[cfg(test)]
mod tests;

pub use compressed::{Compressed, Tangent};
use std::sync::atomic::{AtomicBool, Ordering};

/// The search is over: the budget is spent or the user asked to stop. Solvers return at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the search was stopped, or its budget is spent")]
pub struct Stop;

/// A cost over the unit cube `[0, 1]^dim`. Lower is better; never NaN (infinity for "impossible").
pub trait Objective: Sync {
    /// Number of unknowns.
    fn dim(&self) -> usize;
    /// Cost of the point `x`.
    fn cost(&self, x: &[f64]) -> f64;
    /// The cost where it is at most `limit`; else anything above that, which may take less time to find.
    fn cost_within(&self, x: &[f64], _limit: f64) -> f64 {
        self.cost(x)
    }
    /// Residual vector whose squares the least-squares methods sum, and the cost, from one and the
    /// same evaluation; `None` where there is none.
    fn residuals_and_cost(&self, _x: &[f64]) -> Option<(Vec<f64>, f64)> {
        None
    }
    /// As [`residuals_and_cost`](Self::residuals_and_cost) where the cost is at most `limit`; may stop early and return
    /// `None` where it is more.
    fn residuals_within(&self, x: &[f64], _limit: f64) -> Option<(Vec<f64>, f64)> {
        self.residuals_and_cost(x)
    }
    /// Residuals at each `moved` point less those at `x`, for finite differences; `None` for a point without residuals.
    /// An implementation may run all points together, so that rounding that they share cancels; so `x` runs again.
    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let here = self.residuals_and_cost(x);
        let change = |x: &Vec<f64>| {
            let (there, here) = (self.residuals_and_cost(x)?.0, &here.as_ref()?.0);
            Some(there.iter().zip(here).map(|(t, h)| t - h).collect())
        };
        moved.iter().map(change).collect()
    }
    /// The same residuals in compressed form, if the problem has one: for many residuals, or where their sum of squares is
    /// faster than a list.
    fn compressed(&self) -> Option<&dyn Compressed> {
        None
    }
    /// A start from the data (regression), if there is one.
    fn start(&self) -> Option<Vec<f64>> {
        None
    }
}

/// Counts evaluations against a budget, keeps the best point and the curve of best costs.
pub struct Evaluator<'a> {
    objective: &'a dyn Objective,
    budget: usize,
    stop: &'a AtomicBool,
    observer: &'a mut dyn FnMut(usize, f64),
    evaluations: usize,
    best: Vec<f64>,
    best_cost: f64,
    curve: Vec<(usize, f64)>,
}

impl<'a> Evaluator<'a> {
    /// `observer` is called after each evaluation with the count so far and the best cost.
    pub fn new(
        objective: &'a dyn Objective,
        budget: usize,
        stop: &'a AtomicBool,
        observer: &'a mut dyn FnMut(usize, f64),
    ) -> Self {
        let best = vec![0.5; objective.dim()];
        Evaluator {
            objective,
            budget,
            stop,
            observer,
            evaluations: 0,
            best,
            best_cost: f64::INFINITY,
            curve: Vec::new(),
        }
    }

    /// The problem being solved.
    pub fn objective(&self) -> &'a dyn Objective {
        self.objective
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.objective.dim()
    }

    /// Least cost so far; infinite before the first evaluation.
    pub fn best_cost(&self) -> f64 {
        self.best_cost
    }

    /// The best point so far; before the first evaluation the problem's own start, or the middle.
    pub fn best_or_start(&self) -> Vec<f64> {
        if self.best_cost.is_finite() {
            return self.best.clone();
        }
        let middle = || vec![0.5; self.dim()];
        clamped(&self.objective.start().unwrap_or_else(middle))
    }

    /// Evaluations left.
    pub fn left(&self) -> usize {
        if self.stop.load(Ordering::Relaxed) {
            0
        } else {
            self.budget.saturating_sub(self.evaluations)
        }
    }

    /// Lowers what is left of the budget to at most `evaluations`.
    pub fn limit(&mut self, evaluations: usize) {
        self.budget = self
            .budget
            .min(self.evaluations.saturating_add(evaluations));
    }

    /// Cost at `x`, whose coordinates are first clamped to the cube. NaN counts as infinite.
    pub fn evaluate(&mut self, x: &[f64]) -> Result<f64, Stop> {
        self.evaluate_within(x, f64::INFINITY)
    }

    /// The same for methods that only compare: anything above `limit` where the cost is.
    pub fn evaluate_within(&mut self, x: &[f64], limit: f64) -> Result<f64, Stop> {
        if self.left() == 0 {
            return Err(Stop);
        }
        let x = clamped(x);
        // The best cost is always wanted as it is.
        let limit = limit.max(self.best_cost);
        let cost = finite_or_infinite(self.objective.cost_within(&x, limit));
        self.record(&x, cost);
        Ok(cost)
    }

    /// Residuals at `x`, whose coordinates are first clamped to the cube, for one evaluation that is
    /// booked with its cost. `None`, booked as infinite, where there are none.
    pub fn evaluate_residuals(&mut self, x: &[f64]) -> Result<Option<Vec<f64>>, Stop> {
        if self.left() == 0 {
            return Err(Stop);
        }
        let x = clamped(x);
        let (residuals, cost) = match self.objective.residuals_and_cost(&x) {
            Some((residuals, cost)) => (Some(residuals), finite_or_infinite(cost)),
            None => (None, f64::INFINITY),
        };
        self.record(&x, cost);
        Ok(residuals)
    }

    /// Sum of the squares of the residuals at `x`, as [`evaluate_residuals`](Self::evaluate_residuals) has them.
    pub fn evaluate_squares(
        &mut self,
        compressed: &dyn Compressed,
        x: &[f64],
    ) -> Result<Option<f64>, Stop> {
        if self.left() == 0 {
            return Err(Stop);
        }
        let x = clamped(x);
        let finite = |(squares, _): &(f64, f64)| squares.is_finite();
        let found = compressed.squares_and_cost(&x).filter(finite);
        let cost = found.map_or(f64::INFINITY, |(_, cost)| finite_or_infinite(cost));
        self.record(&x, cost);
        Ok(found.map(|(squares, _)| squares))
    }

    /// Books one evaluation that was made elsewhere (a residual vector, a lane of a batch).
    pub fn record(&mut self, x: &[f64], cost: f64) {
        self.evaluations += 1;
        if cost < self.best_cost {
            self.best_cost = cost;
            self.best.copy_from_slice(x);
            self.curve.push((self.evaluations, cost));
        }
        (self.observer)(self.evaluations, self.best_cost);
    }

    /// What was found.
    pub fn finish(self) -> Found {
        Found {
            x: self.best,
            cost: self.best_cost,
            evaluations: self.evaluations,
            curve: self.curve,
            interrupted: self.stop.load(Ordering::Relaxed),
        }
    }
}

fn clamped(x: &[f64]) -> Vec<f64> {
    x.iter().map(|v| v.clamp(0.0, 1.0)).collect()
}

fn finite_or_infinite(cost: f64) -> f64 {
    if cost.is_nan() { f64::INFINITY } else { cost }
}

/// Result of a search.
#[derive(Clone, Debug)]
pub struct Found {
    /// Best point of the unit cube.
    pub x: Vec<f64>,
    /// Its cost.
    pub cost: f64,
    /// Model evaluations spent, all of them.
    pub evaluations: usize,
    /// Every improvement: evaluations so far, best cost.
    pub curve: Vec<(usize, f64)>,
    /// Whether the user stopped it.
    pub interrupted: bool,
}

/// A search method. The same seed gives the same evaluations in the same order.
pub trait Solver: Sync {
    /// Its name on the command line.
    fn name(&self) -> &'static str;
    /// Searches until it has converged or `evaluator` says [`Stop`].
    fn search(&self, evaluator: &mut Evaluator<'_>, seed: u64);
}

/// Every method, with its usual settings.
pub fn all() -> Vec<Box<dyn Solver>> {
    vec![
        Box::new(levenberg_marquardt::LevenbergMarquardt::default()),
        Box::new(nelder_mead::NelderMead::default()),
        Box::new(cma_es::CmaEs::default()),
        Box::new(differential_evolution::DifferentialEvolution::default()),
        Box::new(ga::Ga::default()),
        Box::new(swarm::ParticleSwarm::default()),
        Box::new(swarm::Fireflies::default()),
        Box::new(swarm::Random),
    ]
}

/// Names of all methods.
pub fn names() -> Vec<&'static str> {
    all().iter().map(|solver| solver.name()).collect()
}

/// The method called `name`.
pub fn by_name(name: &str) -> Option<Box<dyn Solver>> {
    all().into_iter().find(|solver| solver.name() == name)
}
