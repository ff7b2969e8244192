//! The search: effects are added one by one, each level of models building on the best of the one before.

use super::extension::{extensions, sort};
use super::{cross_start, forms, judge, nested_models};
use crate::diagnose::candidate::observer::observe_like;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, same};
use crate::fit::contradictions;

/// Most effects that are added.
const MOST_STEPS: usize = 4;
/// Models of one level that the next one builds on.
const BEAM: usize = 3;
/// A model whose score is so far behind the best of its level is not built on.
const BEAM_WIDTH: f64 = 2.0;

/// Models with one effect more than the level before.
pub struct Level {
    /// Best first.
    pub models: Vec<FittedModel>,
    /// The simplest of the best.
    pub best: FittedModel,
    /// Whether its newest effect earned its place.
    pub believed: bool,
}

/// Adds effects one by one until the error is the encoder's own, or none earns its place. The first is not
/// judged alone: two effects of one size each leave the other's error.
pub fn forward_selection(
    context: &Context<'_>,
    base: &FittedModel,
    done: &(dyn Fn() + Sync),
) -> Vec<Level> {
    let mut levels: Vec<Level> = Vec::new();
    let mut before = base.clone();
    while !before.is_complete()
        && levels.len() < MOST_STEPS
        && !context.budget.exhausted()
        && levels.iter().skip(1).all(|level| level.believed)
    {
        let parents: Vec<&FittedModel> = match levels.last() {
            None => vec![base],
            Some(level) => {
                let near = |model: &&FittedModel| {
                    model.judged().score() - level.models[0].judged().score() < BEAM_WIDTH
                        && !level.models.iter().any(|m| judge::replaces(m, model))
                };
                level.models.iter().filter(near).take(BEAM).collect()
            }
        };
        let mut models = extensions(context, &parents, done);
        context.budget.checkpoint();
        // In windows a right model need not come down to the encoder's error, and what remains would be looked at for ever.
        if let Some(level) = levels.last().filter(|_| context.span.window_s.is_none()) {
            look_again(context, &level.models, &parents, &mut models, done);
        }
        cross_start::cross_start(context, &mut models);
        context.budget.checkpoint();
        polish_best(context, &mut models);
        let Some(best) = judge::best(&models).cloned() else {
            break;
        };
        // One that no observer can hold to the readings keeps the errors of its free runs.
        let _ = observe_like(context, &mut before, &best);
        let walled = best.windowed.is_some() && best.at_wall();
        let can_be = contradictions(context.data, &best.candidate).is_empty();
        let believed = judge::removes(&before, &best) && !walled && can_be;
        before = best.clone();
        levels.push(Level {
            models,
            best,
            believed,
        });
    }
    levels
}

/// Adds to `models`, which build on `parents` of a `level`, those that build on others, as long as nothing explains the
/// recording.
fn look_again(
    context: &Context<'_>,
    level: &[FittedModel],
    parents: &[&FittedModel],
    models: &mut Vec<FittedModel>,
    done: &(dyn Fn() + Sync),
) {
    let explained = |models: &[FittedModel]| models.first().is_some_and(|m| m.ran().at_floor());
    // Before more is blamed, what is there is brought to its end.
    polish_best(context, models);
    let further: [&dyn Fn() -> Vec<FittedModel>; 2] =
        [&|| from_nested(context, parents, done), &|| {
            from_beyond(context, level, parents, done)
        }];
    for find in further {
        if explained(models) {
            return;
        }
        models.extend(find());
        sort(context, models);
        context.budget.checkpoint();
    }
}

/// A friction with many parameters may have taken on what another effect does, and then leaves that one nothing to
/// explain. So the simpler frictions within the `parents` are built on as well, however far they are behind.
fn from_nested(
    context: &Context<'_>,
    parents: &[&FittedModel],
    done: &(dyn Fn() + Sync),
) -> Vec<FittedModel> {
    let mut plain: Vec<FittedModel> = Vec::new();
    for parent in parents {
        for model in nested_models::all(context, parent) {
            let known = |other: &FittedModel| same(&other.effects, &model.effects);
            if !plain.iter().any(known) && !parents.iter().any(|parent| known(parent)) {
                plain.push(model);
            }
        }
    }
    plain.sort_by(FittedModel::by_score);
    let plain: Vec<&FittedModel> = plain.iter().take(BEAM).collect();
    extensions(context, &plain, done)
}

/// One effect may stand in for two at once, and then leaves each of them far behind. So the next models of a level are
/// built on as well.
fn from_beyond(
    context: &Context<'_>,
    level: &[FittedModel],
    parents: &[&FittedModel],
    done: &(dyn Fn() + Sync),
) -> Vec<FittedModel> {
    let is_parent = |model: &FittedModel| parents.iter().any(|p| same(&p.effects, &model.effects));
    let beyond = level.iter().filter(|model| !is_parent(model));
    let beyond: Vec<&FittedModel> = beyond.take(BEAM).collect();
    extensions(context, &beyond, done)
}

/// Models of a level whose fit is brought to its end before any more physics is blamed.
const POLISHED: usize = 2;
/// A model whose score is so far behind the best is not polished.
const BEHIND: f64 = 1.0;

/// Polishes the best models of a level that are not at the floor yet, and tries them with other forms than the textbook's.
fn polish_best(context: &Context<'_>, models: &mut [FittedModel]) {
    if models.first().is_none_or(|model| model.ran().at_floor()) {
        return;
    }
    let least = models.first().map_or(0.0, |model| model.judged().score());
    for model in models.iter_mut().take(POLISHED) {
        // A model that is far behind, or cannot be polished, stays as it is.
        if model.judged().score() - least > BEHIND {
            continue;
        }
        // A model with losses was polished with them.
        if model.losses.is_some() {
            continue;
        }
        if let Ok(polished) = polish(context, model) {
            *model = polished;
        }
        if let Some(freed) = forms::with_other_forms(context, model) {
            *model = freed;
        }
    }
    models.sort_by(FittedModel::by_score);
}
