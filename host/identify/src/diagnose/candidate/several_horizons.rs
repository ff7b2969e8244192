//! One fit over several horizons together: free runs over windows show the motor's dynamics, whole runs show what acts
//! slowly. Neither alone predicts well over the other's span.

use super::descent::{Settings, descend};
use super::score::score_candidate;
use super::search::fit_problem;
use super::settings::{HORIZONS_SETTLED, ROUNDS};
use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use servoid_engine::problem::{FitProblem, Horizon};
use servoid_engine::solve::Objective;

/// Of one round with constant weights.
const ROUND: Settings = Settings {
    evaluations: 60,
    tolerance: 1e-3,
    damping: 1e-6,
    secant: true,
    again: false,
    ..Settings::THOROUGH
};

/// The residuals of several problems with the same unknowns, each weighted.
struct Weighted<'a> {
    problems: Vec<(FitProblem<'a>, f64)>,
}

impl Objective for Weighted<'_> {
    fn dim(&self) -> usize {
        self.problems
            .first()
            .map_or(0, |(problem, _)| problem.dim())
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.residuals_and_cost(x)
            .map_or(f64::INFINITY, |(_, cost)| cost)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let mut all = Vec::new();
        let mut sum = 0.0;
        for (problem, weight) in &self.problems {
            let (residuals, cost) = problem.residuals_and_cost(x)?;
            all.extend(residuals.into_iter().map(|r| r * weight));
            sum += cost * weight * weight;
        }
        Some((all, sum))
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let mut all: Vec<Option<Vec<f64>>> = vec![Some(Vec::new()); moved.len()];
        for (problem, weight) in &self.problems {
            for (own, change) in all.iter_mut().zip(problem.changes(x, moved)) {
                match (own.as_mut(), change) {
                    (Some(own), Some(change)) => own.extend(change.into_iter().map(|c| c * weight)),
                    _ => *own = None,
                }
            }
        }
        all
    }
}

/// Fits a model over all of `horizons` together: minimises the product of their RMS errors, by least squares whose weights are
/// each round's reciprocal errors. `None` where the model cannot run, or is no better for it.
pub fn fit_over_horizons(
    context: &Context<'_>,
    model: &FittedModel,
    horizons: &[Horizon],
) -> Option<FittedModel> {
    let problems = horizons.iter().map(|horizon| {
        let problem = fit_problem(context, &model.structure, model.method);
        let horizon = horizon.clone();
        (FitProblem { horizon, ..problem }, 1.0)
    });
    let mut weighted = Weighted {
        problems: problems.collect(),
    };
    let logarithms = |weighted: &Weighted<'_>, x: &[f64]| -> f64 {
        let costs = weighted.problems.iter().map(|(problem, _)| problem.cost(x));
        costs
            .map(|cost| 0.5 * libm::log(cost.max(f64::MIN_POSITIVE)))
            .sum()
    };
    let mut x = model.x.clone();
    let mut left = logarithms(&weighted, &x);
    let mut best = None;
    for _ in 0..ROUNDS {
        for (problem, weight) in &mut weighted.problems {
            *weight = 1.0 / problem.cost(&x).max(f64::MIN_POSITIVE).sqrt();
        }
        let Some(found) = descend(&weighted, &x, ROUND, context.budget) else {
            break;
        };
        let runs = horizons.len() * found.evaluations * usize::from(model.method.substeps.max(1));
        context.budget.book((context.data.len() * runs) as u64);
        let now = logarithms(&weighted, &found.x);
        let fell = left - now;
        if fell.is_nan() || fell <= 0.0 {
            break;
        }
        (x, left) = (found.x.clone(), now);
        best = Some(found);
        if fell < HORIZONS_SETTLED {
            break;
        }
    }
    let found = best?;
    let fitted = score_candidate(
        context,
        model.structure.clone(),
        &found,
        model.predicted_rms_counts,
        model.method,
    );
    fitted.ok().map(|fitted| FittedModel {
        evaluations: model.evaluations + fitted.evaluations,
        chaotic: model.chaotic,
        ..fitted
    })
}
