//! The steps from the linear motor to the model that was chosen. An effect is named only where not too many
//! others do as well in its place.

use super::baseline::{Baseline, Prediction};
use super::candidate::score::refine_held_out_start;
use super::chosen::Chosen;
use super::context::{Context, together_move_both_ways};
use super::gain::p_value;
use super::models::{FittedModel, same};
use super::ordered::with_first;
use super::outcome::{Floor, Step};
use super::rivals::Rivals;
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
    /// Other models that were fitted.
    pub rivals: Vec<FittedModel>,
    /// The effect that would raise the score most and is not believed.
    pub not_named: Option<Kind>,
    /// What the last model predicts, where it was held against the baseline.
    pub predicts: Option<Prediction>,
    /// The baseline.
    pub baseline: Option<Baseline>,
    /// Sets of effects with their scores, nats.
    pub scores: Vec<(Vec<Kind>, f64)>,
    /// What stands below the chosen model's error, where more than the encoder is known of it.
    pub floor: Option<Floor>,
}

/// Writes down the steps to the chosen model, up to the first effect that may not be named.
pub fn name_effects(chosen: Chosen<'_>) -> Named<'_> {
    let (steps, last) = match &chosen.model {
        Some(model) => steps_to(&chosen, model),
        None => (Vec::new(), chosen.base.clone()),
    };
    let not_named = next_best(&last.effects, &chosen.scores);
    let Chosen {
        context,
        base,
        known,
        predicts,
        baseline,
        scores,
        floor,
        ..
    } = chosen;
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

/// The effect that raises the score of the set `own` most, of those sets that have one effect more.
fn next_best(own: &[Kind], scores: &[(Vec<Kind>, f64)]) -> Option<Kind> {
    let (_, nats) = scores.iter().find(|(set, _)| same(set, own))?;
    let larger = scores.iter().filter(|(set, score)| {
        set.len() == own.len() + 1 && own.iter().all(|kind| set.contains(kind)) && score > nats
    });
    let (best, _) = larger.max_by(|a, b| a.1.total_cmp(&b.1))?;
    best.iter().copied().find(|kind| !own.contains(kind))
}

/// The steps from the linear motor to `chosen`, and the model after the last of them.
fn steps_to(held: &Chosen<'_>, chosen: &FittedModel) -> (Vec<Step>, FittedModel) {
    let Chosen {
        context,
        base,
        levels,
        known,
        ..
    } = held;
    // A motor that never reverses cannot tell any of them apart: they are named as one.
    let as_one = held.as_one
        || context.span.window_s.is_some()
            && !together_move_both_ways(context.data, context.held_out);
    let (mut steps, mut before) = (Vec::new(), base.clone());
    for (depth, &added) in chosen.effects.iter().enumerate() {
        let rivals = Rivals::of(chosen, added, &held.scores, CLASS_NATS, known);
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
            .map(|c| p_value(context.data, &before, c))
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
        made.or_else(|| with_first(context, chosen, depth + 1))
    };
    let mut after = after.or(list.first().cloned())?;
    refine_held_out_start(context, &mut after);
    Some(after)
}
