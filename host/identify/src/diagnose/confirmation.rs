//! Stage 4: every effect that was selected must still hold beside the others, against its look-alikes, and against
//! simpler effects in its place, and be large enough to matter. What was selected first was judged without the rest.

use super::baseline::{Baseline, Prediction};
use super::built_up::added;
use super::context::{Context, constant_drive};
use super::lost_counts;
use super::models::FittedModel;
use super::negligible::without_negligible;
use super::outcome::Floor;
use super::selection::{Level, Selected, backward_elimination, nested_models, substitution};
use shared::effects::Kind;

/// The model that holds, and what it was tried against.
pub struct Confirmed<'a> {
    /// The recordings.
    pub context: Context<'a>,
    /// The linear motor.
    pub base: FittedModel,
    /// The levels of the selection up to the one that was believed.
    pub levels: Vec<Level>,
    /// The model with the effects that hold; `None` where none was believed.
    pub chosen: Option<FittedModel>,
    /// Models with as many effects, and those in which one of its effects is another.
    pub known: Vec<FittedModel>,
    /// The newest effect of the first level beyond those, which was not believed.
    pub not_named: Option<Kind>,
    /// What the chosen model predicts, where it was held against the baseline.
    pub predicts: Option<Prediction>,
    /// The baseline that it was held against.
    pub baseline: Option<Baseline>,
    /// Whether the chosen effects are named together although others would do as well in the place of one.
    pub as_one: bool,
    /// Sets of effects with their scores, nats; none where the sets were judged by their errors.
    pub scores: Vec<(Vec<Kind>, f64)>,
    /// What stands below the chosen model's error, where more than the encoder is known of it.
    pub floor: Option<Floor>,
}

/// Takes the last level that was believed, and tries its best model without each effect and with others in its place.
pub fn confirm(selected: Selected<'_>) -> Confirmed<'_> {
    let Selected {
        context,
        base,
        mut levels,
    } = selected;
    let believed = levels.iter().rposition(|level| level.believed);
    let depth = believed.map_or(0, |last| last + 1);
    let next = levels.get(depth);
    let not_named = next.and_then(|level| level.best.effects.last().copied());
    levels.truncate(depth);
    let (mut chosen, mut known) = (None, Vec::new());
    if let Some(last) = levels.last() {
        known = last.models.clone();
        let held = held_against_others(&context, last.best.clone(), levels.len() > 1, &mut known);
        known.extend(sums(&context, &held));
        chosen = without_negligible(&context, held, &known);
    }
    Confirmed {
        context,
        base,
        levels,
        chosen,
        known,
        not_named,
        predicts: None,
        baseline: None,
        as_one: false,
        scores: Vec::new(),
        floor: None,
    }
}

/// `chosen` or what stands against it better, `several` effects having been selected. Every model that was fitted goes
/// to `known`.
fn held_against_others(
    context: &Context<'_>,
    chosen: FittedModel,
    several: bool,
    known: &mut Vec<FittedModel>,
) -> FittedModel {
    if !several {
        return nested_models::simplify(context, chosen, known);
    }
    let mut chosen = backward_elimination::eliminate(context, chosen, known);
    for place in chosen.effects.clone() {
        context.budget.checkpoint();
        let substitutes = if chosen.losses.is_some() {
            lost_counts::beside(context, &chosen, |context, bare| {
                substitution::substitutes(context, bare, place, &[])
            })
        } else {
            substitution::substitutes(context, &chosen, place, known)
        };
        if let Some(better) = substitution::better(&chosen, &substitutes) {
            chosen = better;
        }
        known.extend(substitutes);
    }
    let chosen = nested_models::simplify(context, chosen, known);
    backward_elimination::eliminate(context, chosen, known)
}

/// Models in which an effect is the sum of a simpler one that it contains and a constant drive: as many parameters, and the
/// same equation under another name.
fn sums(context: &Context<'_>, chosen: &FittedModel) -> Vec<FittedModel> {
    let mut sums = Vec::new();
    let constant = constant_drive(context.data.drive);
    for &sum in &chosen.effects {
        let parts = |kind: Kind| kind.parameters().len();
        let contained = sum.facts().contains.iter();
        for part in contained.filter_map(|simpler| Kind::by_name(simpler.name)) {
            if parts(sum) != parts(part) + parts(constant) || chosen.effects.contains(&constant) {
                continue;
            }
            let simpler = added(context, &chosen.without(sum), part);
            sums.extend(simpler.and_then(|model| added(context, &model, constant)));
        }
    }
    sums
}
