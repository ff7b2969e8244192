//! The least-squares problem of a model, and the search for its parameters within the budget.

use super::descent::{Descent, Settings, descend};
use crate::diagnose::context::Context;
use servoid_engine::problem::{FitProblem, StartAngle, Structure};
use servoid_engine::simulation::Method;
use servoid_engine::solve::Objective;
use shared::cost::Cost;

/// The recording, run over the span that was chosen.
pub fn fit_problem<'a>(
    context: &'a Context<'_>,
    structure: &Structure,
    method: Method,
) -> FitProblem<'a> {
    FitProblem {
        data: context.data,
        structure: structure.clone(),
        cost: Cost::Squared,
        weight: 1.0,
        horizon: context.fitted_horizon.clone(),
        start_angle: StartAngle::Free,
        method,
        start: None,
    }
}

/// Descends, and books what it took. `None` where the model cannot run at the start.
pub fn search(
    context: &Context<'_>,
    problem: &dyn Objective,
    start: &[f64],
    settings: Settings,
    method: Method,
) -> Option<Descent> {
    let found = descend(problem, start, settings, context.budget)?;
    let steps = context.samples() * usize::from(method.substeps.max(1)) * found.evaluations;
    context.budget.book(steps as u64);
    Some(found)
}

/// Searches by `search`, and again in a wider range where that ends at the end of one that may be wider. Keeps what fits better. Not
/// in windows: there an effect that is as large as is searched for does another one's work (see `FittedModel::any_at_wall`).
pub fn search_widening(
    context: &Context<'_>,
    structure: &Structure,
    start: &[f64],
    search: impl Fn(&Structure, &[f64]) -> Option<Descent>,
) -> Option<(Structure, Descent)> {
    let mut structure = structure.clone();
    let mut found = search(&structure, start)?;
    while context.span.window_s.is_none()
        && let Some(wider) = structure.widened_at(&found.x)
    {
        let start = wider.coordinates(&structure.values(&found.x));
        let again = search(&wider, &start)?;
        if again.squares >= found.squares {
            break;
        }
        (structure, found) = (wider, again);
    }
    Some((structure, found))
}
