//! Whether one motor is behind both recordings. What the fitted one determines only roughly may miss the held-out one by more than the
//! encoder does, although the same motor made it: then one set of parameters leaves the encoder's own error on both.

use super::descent::Settings;
use super::score::run_errors;
use super::search::{fit_problem, search};
use super::settings::FAR_HELD_OUT;
use crate::diagnose::context::Context;
use crate::diagnose::models::{Errors, FittedModel};
use servoid_engine::problem::FitProblem;
use servoid_engine::solve::Objective;

/// Of a fit that begins near its end.
const NEAR: Settings = Settings {
    evaluations: 120,
    again: false,
    ..Settings::THOROUGH
};

/// Both recordings, run on their own.
struct Both<'a> {
    fitted: FitProblem<'a>,
    held_out: FitProblem<'a>,
}

impl Objective for Both<'_> {
    fn dim(&self) -> usize {
        self.fitted.dim()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.fitted.cost(x) + self.held_out.cost(x)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let (mut residuals, cost) = self.fitted.residuals_and_cost(x)?;
        let (others, further) = self.held_out.residuals_and_cost(x)?;
        residuals.extend(others);
        Some((residuals, cost + further))
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let fitted = self.fitted.changes(x, moved);
        let held_out = self.held_out.changes(x, moved);
        let both = fitted.into_iter().zip(held_out);
        both.map(|(own, other)| Some([own?, other?].concat()))
            .collect()
    }
}

/// The errors of `model`, fitted to both recordings from where it stands. `None` where its errors show already what it is worth, and where
/// its run begins at an unknown speed or angle, which the two do not share.
pub fn fit_both(context: &Context<'_>, model: &FittedModel) -> Option<Errors> {
    let ran = model.ran();
    let structure = &model.structure;
    let asks = ran.fitted_at_floor() && !ran.at_floor() && ran.held_out < FAR_HELD_OUT * ran.floor;
    if !asks || context.span.window_s.is_some() || structure.start_speed || structure.start_offset {
        return None;
    }
    let fitted = fit_problem(context, structure, model.method);
    let held_out = FitProblem {
        data: context.held_out,
        horizon: context.held_out_horizon.clone(),
        ..fit_problem(context, structure, model.method)
    };
    let both = Both { fitted, held_out };
    let found = search(context, &both, &model.x, NEAR, model.method)?;
    let candidate = structure.candidate(&structure.values(&found.x));
    run_errors(context, &candidate, model.method).ok()
}
