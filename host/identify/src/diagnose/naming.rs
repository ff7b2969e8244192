//! Stage 5: the steps from the linear motor to the model that was confirmed. An effect is named only where not too many
//! others do as well in its place.

use super::baseline::{Baseline, Prediction};
use super::candidate::score::refine_held_out_start;
use super::confirmation::Confirmed;
use super::context::{Context, together_move_both_ways};
use super::models::{FittedModel, same};
use super::ordered::{in_order, order_of_fall};
use super::outcome::{Floor, Step};
use super::selection::judge::{self, Rivals};
use super::selection::{Level, backward_elimination};
use super::spectrum::spectrum;
use super::walk::CLASS_NATS;
use shared::effects::{Kind, Starts};

/// The effects that are named, and the models that they lead to.
pub struct Named<'a> {
    /// The recordings.
    pub context: Context<'a>,
    /// The linear motor.
    pub base: FittedModel,
    /// The effects, in the order in which they were added.
    pub steps: Vec<Step>,
    /// The model with all of them.
    pub last: FittedModel,
    /// Models with as many effects as the one that was confirmed, and those in which one of its effects is another.
    pub rivals: Vec<FittedModel>,
    /// The best candidate that was not believed.
    pub not_named: Option<Kind>,
    /// What the last model predicts, where it was held against the baseline.
    pub predicts: Option<Prediction>,
    /// The baseline.
    pub baseline: Option<Baseline>,
    /// Sets of effects with their scores, nats; none where the sets were judged by their errors.
    pub scores: Vec<(Vec<Kind>, f64)>,
    /// What stands below the chosen model's error, where more than the encoder is known of it.
    pub floor: Option<Floor>,
}

/// Writes down the steps to the model that was confirmed, up to the first effect that may not be named.
pub fn name_effects(confirmed: Confirmed<'_>) -> Named<'_> {
    let Confirmed {
        context,
        base,
        levels,
        chosen,
        known,
        not_named,
        predicts,
        baseline,
        as_one,
        scores,
        floor,
    } = confirmed;
    let chosen = chosen.map(|chosen| {
        // The walk has them in this order already.
        if !scores.is_empty() {
            return chosen;
        }
        let all = levels.iter().flat_map(|level| &level.models).chain(&known);
        let order = order_of_fall(&chosen.effects, all);
        if order == chosen.effects {
            chosen
        } else {
            in_order(&context, &chosen, &order)
        }
    });
    let (steps, last) = match &chosen {
        Some(chosen) => {
            let rivals = |place: Kind| match &scores[..] {
                [] => judge::rivals(chosen, place, &known),
                scores => judge::rivals_by_score(&chosen.effects, place, scores, CLASS_NATS),
            };
            steps_to(&context, &base, &levels, chosen, &known, as_one, &rivals)
        }
        None => (Vec::new(), base.clone()),
    };
    Named {
        context,
        base,
        steps,
        last,
        rivals: known,
        not_named,
        predicts,
        baseline,
        scores,
        floor,
    }
}

/// The steps from `base` to `chosen`, and the model after the last of them.
fn steps_to(
    context: &Context<'_>,
    base: &FittedModel,
    levels: &[Level],
    chosen: &FittedModel,
    known: &[FittedModel],
    as_one: bool,
    rivals: &dyn Fn(Kind) -> Rivals,
) -> (Vec<Step>, FittedModel) {
    // A motor that never reverses cannot tell any of them apart: they are named as one.
    let as_one = as_one
        || context.span.window_s.is_some()
            && !together_move_both_ways(context.data, context.held_out);
    let (mut steps, mut before) = (Vec::new(), base.clone());
    for (depth, &added) in chosen.effects.iter().enumerate() {
        let rivals = rivals(added);
        if !as_one && !rivals.allows(added) {
            break;
        }
        let list = levels
            .get(depth)
            .map(|level| &level.models[..])
            .unwrap_or_default();
        let Some(after) = model_at(context, chosen, depth, list, known) else {
            break;
        };
        let mut candidates = vec![after.clone()];
        candidates.extend(
            list.iter()
                .filter(|m| !same(&m.effects, &after.effects))
                .cloned(),
        );
        let p_values = candidates
            .iter()
            .map(|c| judge::p_value(context.data, &before, c))
            .collect();
        steps.push(Step {
            added,
            confidence: f64::NAN,
            indistinguishable_from: rivals.equivalent,
            candidates,
            p_values,
            spectrum: (added.facts().starts == Starts::AngleOrders)
                .then(|| spectrum(context.data, &before.candidate)),
        });
        before = after;
    }
    (steps, before)
}

/// The model with the first effects of `chosen` up to that at `depth`: from those that are `known` or in the `list` of
/// this depth, or fitted now.
fn model_at(
    context: &Context<'_>,
    chosen: &FittedModel,
    depth: usize,
    list: &[FittedModel],
    known: &[FittedModel],
) -> Option<FittedModel> {
    let prefix = &chosen.effects[..=depth];
    let after = if depth + 1 == chosen.effects.len() {
        Some(chosen.clone())
    } else {
        let fitted = |model: &&FittedModel| same(&model.effects, prefix);
        let made = list.iter().chain(known).find(fitted).cloned();
        made.or_else(|| backward_elimination::with_first(context, chosen, depth + 1))
    };
    let mut after = after.or(list.first().cloned())?;
    refine_held_out_start(context, &mut after);
    Some(after)
}
