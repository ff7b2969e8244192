//! The fit of a screened model by full simulation.

use super::descent::{Descent, Settings};
use super::observer::observe_all;
use super::score::score_candidate;
use super::search::{fit_problem, search, search_widening};
pub use super::settings::LOST;
use super::settings::{AS_GOOD, ASTRAY, FIT_MEMORIES_S};
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, NOISE_COUNTS, ROOM, ScreenedModel};
use crate::error::Error;
use servoid_engine::problem::{FitProblem, Horizon, Structure};

/// Of a fit by full simulation.
const FULL: Settings = Settings {
    tolerance: 1e-3,
    stride: 2,
    damping: 1e-6,
    secant: true,
    ..Settings::THOROUGH
};

/// Fits a screened model by full simulation.
///
/// # Errors
/// [`Error::Failed`] where the model cannot run from there.
pub fn fit_screened(context: &Context<'_>, screened: &ScreenedModel) -> Result<FittedModel, Error> {
    // Where the simulation is far worse than the series-parallel model predicted, the free run has lost its way.
    if context.span.window_s.is_some()
        || screened.simulated <= LOST * screened.series_parallel.max(NOISE_COUNTS)
    {
        fit_from(context, screened, &screened.x)
    } else {
        fit_chaotic(context, screened)
    }
}

/// Fits a screened model whose free runs are chaotic: under an observer first, which forgets later from stage to stage.
///
/// # Errors
/// [`Error::Failed`] where the model cannot run from there.
pub fn fit_chaotic(context: &Context<'_>, screened: &ScreenedModel) -> Result<FittedModel, Error> {
    let faded = fit_with_growing_memory(context, &screened.structure, &screened.x);
    let free = fit_from(context, screened, &faded)?;
    if free.ran().at_floor() {
        return Ok(free);
    }
    // A free run that is chaotic leads the search astray; then what the observer learnt stands.
    let stand = Descent {
        squares: 0.0,
        evaluations: free.evaluations,
        x: faded,
    };
    let faded = score_candidate(
        context,
        screened.structure.clone(),
        &stand,
        screened.predicted(),
        context.method,
    )?;
    let mut both = [free, faded];
    observe_all(context, &mut both);
    let score = |model: &FittedModel| {
        let errors = model.observed.map(|observed| observed.errors);
        errors.map_or(f64::INFINITY, |errors| errors.score())
    };
    let [free, faded] = both;
    let better = if score(&free) < score(&faded) + AS_GOOD {
        free
    } else {
        faded
    };
    Ok(FittedModel {
        chaotic: true,
        ..better
    })
}

/// Fits a screened model over the span of the diagnosis, from `start`.
fn fit_from(
    context: &Context<'_>,
    screened: &ScreenedModel,
    start: &[f64],
) -> Result<FittedModel, Error> {
    let settings = Settings {
        enough: (context.floor * ROOM).powi(2) * context.samples() as f64,
        ..FULL
    };
    let widened = search_widening(context, &screened.structure, start, |structure, start| {
        let problem = fit_problem(context, structure, context.method);
        search(context, &problem, start, settings, context.method)
    });
    let (structure, found) = widened
        .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", context.data.source)))?;
    score_candidate(
        context,
        structure,
        &found,
        screened.predicted(),
        context.method,
    )
}

/// Descends with a memory that grows from stage to stage, so that the search meets the rough cost of the
/// free run only when it is near.
fn fit_with_growing_memory(context: &Context<'_>, structure: &Structure, x: &[f64]) -> Vec<f64> {
    let mut x = x.to_vec();
    let mut last = f64::INFINITY;
    for memory_s in FIT_MEMORIES_S {
        let problem = FitProblem {
            horizon: Horizon::Observer(memory_s),
            ..fit_problem(context, structure, context.method)
        };
        let Some(found) = search(context, &problem, &x, Settings::ROUGH, context.method) else {
            break;
        };
        let rms = (found.squares / context.data.len() as f64).sqrt();
        if rms > ASTRAY * last.max(NOISE_COUNTS) {
            break;
        }
        last = rms;
        x = found.x;
    }
    x
}

/// A model that stands at the end of a range that may be wider, fitted in a wider one; `None` where it does not.
pub fn fit_widening(context: &Context<'_>, model: &FittedModel) -> Option<FittedModel> {
    model.structure.widened_at(&model.x)?;
    let start = ScreenedModel::at(model.structure.clone(), model.x.clone());
    fit_from(context, &start, &model.x).ok()
}
