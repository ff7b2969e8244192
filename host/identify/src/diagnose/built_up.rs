//! A start for a fit with given effects: they are added one by one, as a diagnosis adds them. Regression knows nothing of
//! most effects, and where runs are chaotic a search that begins there ends in the wrong valley.

use super::candidate::fit::fit_screened;
use super::candidate::polish::polish;
use super::context::{Budget, Context};
use super::linear::fit_linear;
use super::models::FittedModel;
use super::screening::screen;
use crate::diagnose::settings::LOST;
use crate::fit::Options;
use servoid_engine::problem::{Candidate, Data};
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;

/// Whether a fit may have ended in the wrong valley: it leaves more than the encoder does in so many samples.
pub fn is_lost(squares: f64, samples: usize) -> bool {
    squares > LOST * FLOOR_RMS_COUNTS.powi(2) * samples as f64
}

/// The model that is reached by adding `effects` in their order. `None` where there are none, or one of them cannot be
/// added.
pub fn built_up(
    data: &Data,
    effects: &[Kind],
    options: &Options,
    budget: &Budget<'_>,
) -> Option<Candidate> {
    if effects.is_empty() {
        return None;
    }
    let context = Context::new(data, data, options, budget);
    let (context, mut model) = fit_linear(context, options).ok()?;
    for &kind in effects {
        model = added(&context, &model, kind)?;
    }
    Some(model.candidate)
}

/// `model` with one effect more, brought to its end. `None` where it cannot be added.
pub(super) fn added(context: &Context<'_>, model: &FittedModel, kind: Kind) -> Option<FittedModel> {
    let screened = screen(context, model, kind)?;
    let fitted = fit_screened(context, &screened).ok()?;
    if fitted.judged().at_floor() {
        return Some(fitted);
    }
    polish(context, &fitted).ok()
}
