//! Stage 5: no diagnosis predicts worse than the baseline, the model that an engineer fits in an afternoon: a linear motor
//! with Coulomb friction, an offset and a delay.
//!
//! Where the model that was confirmed reaches the encoder's floor there is nothing to do. Elsewhere something is missing that no
//! effect of the catalogue explains, and selection by one measure may have ended with a model that predicts worse over
//! another span than simpler ones do.

mod models;
mod prediction;

use super::candidate::several_horizons::fit_over_horizons;
use super::confirmation::Confirmed;
use super::context::{Context, moves_both_ways};
use super::models::{FittedModel, same};
use models::{baseline_models, with_baseline_terms};
pub use prediction::Prediction;
use prediction::Windows;

/// A model may predict worse than the baseline by this part before it is given up: less is chance.
const AS_GOOD: f64 = 0.01;

/// A model and what it predicts.
struct Rated {
    model: FittedModel,
    prediction: Prediction,
}

/// Holds the confirmed model against the baseline, on both recordings, in windows and over whole runs.
pub fn hold_to_baseline(confirmed: Confirmed<'_>) -> Confirmed<'_> {
    let mut confirmed = confirmed;
    let chosen = confirmed.chosen.as_ref().unwrap_or(&confirmed.base).clone();
    if chosen.explains() || chosen.losses.is_some() {
        return confirmed;
    }
    let context = &confirmed.context;
    let windows = Windows::of(context);
    let rate = |model: FittedModel| -> Option<Rated> {
        let prediction = windows.prediction(context, &model)?;
        Some(Rated { model, prediction })
    };
    let baseline = baseline_models(context, &confirmed.base);
    let Some(limit) = baseline.last().cloned().and_then(rate) else {
        return confirmed;
    };
    let further = with_baseline_terms(context, &chosen);
    let mut rated: Vec<Rated> = Vec::new();
    for model in std::iter::once(&chosen).chain(&further).chain(&baseline) {
        let refitted = fit_over_horizons(context, model, &windows.fitted);
        rated.extend(refitted.and_then(rate));
        rated.extend(rate(model.clone()));
    }
    confirmed.known.extend(further);
    confirmed.known.extend(baseline);
    if let Some(best) = select(context, rated, &chosen, &limit.prediction) {
        confirmed.predicts = Some(best.prediction);
        if best.model.effects.is_empty() {
            confirmed.base = best.model;
            confirmed.chosen = None;
        } else {
            confirmed.as_one |= !same(&best.model.effects, &chosen.effects);
            confirmed.chosen = Some(best.model);
        }
    }
    confirmed
}

/// The best of those that predict no worse than the baseline; of these the ones with the chosen effects first.
fn select(
    context: &Context<'_>,
    rated: Vec<Rated>,
    chosen: &FittedModel,
    limit: &Prediction,
) -> Option<Rated> {
    // A motor that never reverses tells friction from an offset only where something else does: the fewest terms.
    let penalty = |rated: &Rated| {
        let terms = rated.model.parameters.len() as f64;
        let price = if moves_both_ways(context.data) { AS_GOOD } else { 4.0 * AS_GOOD };
        rated.prediction.score() + price * terms
    };
    let (feasible, others): (Vec<Rated>, Vec<Rated>) = rated
        .into_iter()
        .partition(|rated| rated.prediction.no_worse_than(limit, AS_GOOD));
    let best = |from: Vec<Rated>| {
        from.into_iter()
            .min_by(|a, b| penalty(a).total_cmp(&penalty(b)))
    };
    let (own, rest): (Vec<Rated>, Vec<Rated>) = feasible
        .into_iter()
        .partition(|rated| same(&rated.model.effects, &chosen.effects));
    best(own).or_else(|| best(rest)).or_else(|| best(others))
}
