//! Models with one effect more: all are screened, the promising ones refitted.

use super::judge::{is_exact, removes};
use super::substitution::substituted;
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::observer::observe_all;
use crate::diagnose::context::Context;
use crate::diagnose::lost_counts;
use crate::diagnose::models::{FittedModel, ScreenedModel};
use crate::diagnose::screening::{free_run_ratio, rescreen, screen};
use rayon::prelude::*;
use shared::effects::{Kind, MAX_EFFECTS};

/// Most fits of one call, unless they leave something unexplained.
const MOST_FITS: usize = 6;
/// The same where models run in windows.
const MOST_IN_WINDOWS: usize = 12;
/// Screened models within this factor of the best are refitted in any case.
const CLOSE: f64 = 1.5;
/// Beyond this factor of the best they are not, but for look-alikes of the best.
const FAR: f64 = 4.0;
/// Refits made at a time, whatever the number of processors, so that the result is always the same.
const AT_A_TIME: usize = 2;

/// The same model must not be screened twice, whichever parent it comes from.
fn sets(candidates: &[Kind], parents: &[&FittedModel]) -> Vec<(usize, Kind)> {
    let mut seen: Vec<Vec<Kind>> = Vec::new();
    let mut pairs = Vec::new();
    for (index, parent) in parents.iter().enumerate() {
        if parent.structure.effects.len() >= MAX_EFFECTS || parent.losses.is_some() {
            continue;
        }
        for &kind in candidates {
            // Losses are found, not screened.
            if parent.effects.contains(&kind) || kind.facts().by_chance {
                continue;
            }
            let mut set = parent.effects.clone();
            set.push(kind);
            set.sort_unstable();
            if !seen.contains(&set) {
                seen.push(set);
                pairs.push((index, kind));
            }
        }
    }
    pairs
}

/// Every model that adds one effect to one of the `parents`, as far as it is promising, best first.
/// `done` is called after each piece of work.
pub fn extensions(
    context: &Context<'_>,
    parents: &[&FittedModel],
    done: &(dyn Fn() + Sync),
) -> Vec<FittedModel> {
    let mut models: Vec<FittedModel> = parents
        .iter()
        // In windows a jump is forgotten with the window.
        .filter(|_| context.span.window_s.is_none())
        .filter_map(|parent| {
            let found = lost_counts::found(context, parent);
            done();
            found
        })
        .collect();
    // Jumps of whole counts that leave the encoder's own error: nothing smooth does the same.
    if models.iter().all(|model| !model.free().at_floor()) {
        for parent in parents.iter().filter(|parent| parent.losses.is_some()) {
            models.extend(lost_counts::beside(context, parent, |context, bare| {
                extensions(context, &[bare], done)
            }));
        }
        models.extend(smooth(context, parents, done));
    }
    sort(context, &mut models);
    models
}

/// Every model that adds one effect that can be simulated. Bristles cost much: they, and what builds on them,
/// are tried where nothing else will do.
fn smooth(
    context: &Context<'_>,
    parents: &[&FittedModel],
    done: &(dyn Fn() + Sync),
) -> Vec<FittedModel> {
    let sets = sets(&context.candidates, parents);
    let (plain, bristles): (Vec<_>, Vec<_>) = sets.into_iter().partition(|(at, kind)| {
        let beside = &parents[*at].effects;
        !beside.iter().chain([kind]).any(|kind| kind.facts().costly)
    });
    let screen_all = |sets: &[(usize, Kind)], dry: &[ScreenedModel]| -> Vec<ScreenedModel> {
        sets.par_iter()
            .filter(|_| !context.budget.exhausted())
            .filter_map(|&(parent, kind)| {
                let screened = screen(context, parents[parent], kind, dry);
                done();
                screened
            })
            .collect()
    };
    let mut screened_models: Vec<ScreenedModel> = Vec::new();
    let mut models: Vec<FittedModel> = Vec::new();
    // The best parent first: where it is half of the truth, the others need not be tried.
    for parent in 0..parents.len() {
        context.budget.checkpoint();
        let own: Vec<_> = plain
            .iter()
            .copied()
            .filter(|(at, _)| *at == parent)
            .collect();
        let mut more = screen_all(&own, &[]);
        let ratio = free_run_ratio(context, parents[parent]);
        for screened in &mut more {
            screened.free_run_ratio = ratio;
        }
        sort_screened(&mut more);
        again_from_best(context, parents, &mut more);
        let further = parent == 0 && context.span.window_s.is_none();
        models = fit_promising(context, &more, models, done, |best| {
            further && !removes(parents[parent], best)
        });
        screened_models.extend(more);
        if models.first().is_some_and(|model| model.ran().at_floor()) {
            break;
        }
    }
    sort_screened(&mut screened_models);
    // Beside other effects, dry friction is tried against bristles at the end.
    let first = parents.iter().all(|parent| parent.effects.is_empty());
    let explained = models.first().is_some_and(|model| {
        if first {
            is_exact(model, context.floor)
        } else {
            parents.iter().all(|parent| removes(parent, model))
        }
    });
    if explained || bristles.is_empty() {
        if !first {
            models.extend(bristled(context, &models));
            sort(context, &mut models);
        }
        return models;
    }
    // No series-parallel model follows bristles: they start from dry friction, where that comes near the best.
    let least = screened_models
        .first()
        .map_or(f64::INFINITY, ScreenedModel::predicted);
    let near_dry = |kind: Kind| {
        screened_models.iter().any(|screened| {
            let dry = |newest: Kind| kind.containing(newest).is_some();
            screened.newest().is_some_and(dry) && screened.predicted() < NEAR_DRY * least.max(FLOOR)
        })
    };
    let bristles: Vec<_> = bristles
        .into_iter()
        .filter(|(parent, kind)| !kind.facts().costly || (*parent == 0 && near_dry(*kind)))
        .collect();
    let mut more = screen_all(&bristles, &screened_models);
    sort_screened(&mut more);
    fit_promising(context, &more, models, done, |_| false)
}

/// The first of the `models` with bristles in the place of its dry friction, where it leaves something to
/// explain.
fn bristled(context: &Context<'_>, models: &[FittedModel]) -> Option<FittedModel> {
    let best = models.first().filter(|model| !model.ran().at_floor())?;
    let costly = Kind::ALL.iter().filter(|kind| kind.facts().costly);
    costly.copied().find_map(|kind| {
        let dry = |place: &&Kind| kind.containing(**place).is_some();
        let place = *best.effects.iter().find(dry)?;
        substituted(context, best, place, kind, models)
    })
}

/// Best first.
fn sort_screened(screened_models: &mut [ScreenedModel]) {
    screened_models.sort_by(|a, b| a.predicted().total_cmp(&b.predicted()));
}

/// The parent's machine may be far off for want of the effect. The best screened model has a better one: its
/// look-alikes get a second start there, lest they lose for their start alone.
fn again_from_best(
    context: &Context<'_>,
    parents: &[&FittedModel],
    screened_models: &mut [ScreenedModel],
) {
    let Some((best, others)) = screened_models.split_first_mut() else {
        return;
    };
    let Some(kind) = best.newest() else { return };
    let (best, least) = (&*best, best.predicted());
    let effects = best.structure.effects.clone();
    let values = best.structure.values(&best.x);
    let machine = best.structure.candidate(&values).machine;
    let Some(parent) = parents
        .iter()
        .find(|parent| effects.starts_with(&parent.effects))
    else {
        return;
    };
    let mut parent = (*parent).clone();
    parent.candidate.machine = machine;
    others.par_iter_mut().for_each(|screened| {
        let Some(newest) = screened.newest() else {
            return;
        };
        let beside = screened.structure.effects.starts_with(&parent.effects);
        if beside && kind.looks_like(newest) && screened.predicted() > CLOSE * least {
            let with_all = rescreen(context, screened, &parent, best);
            let again = screen(context, &parent, newest, &[]);
            for mut again in [with_all, again].into_iter().flatten() {
                again.free_run_ratio = screened.free_run_ratio;
                if again.predicted() < screened.predicted() {
                    *screened = again;
                }
            }
        }
    });
    sort_screened(screened_models);
}

/// Full fits of promising screened models beside the models that were `made` before, best first. Not more than what is usual,
/// unless the best of them leaves something that is `unexplained`: a screening may have ended early in a long valley.
fn fit_promising(
    context: &Context<'_>,
    screened_models: &[ScreenedModel],
    made: Vec<FittedModel>,
    done: &(dyn Fn() + Sync),
    unexplained: impl Fn(&FittedModel) -> bool,
) -> Vec<FittedModel> {
    // In windows more of them are alike.
    let windows = context.span.window_s.is_some();
    let most = if windows { MOST_IN_WINDOWS } else { MOST_FITS };
    let before = made.len();
    let mut models = made;
    for chunk in screened_models.chunks(AT_A_TIME) {
        context.budget.checkpoint();
        let enough = models.len() >= before + most;
        if context.budget.exhausted() || (enough && !models.first().is_some_and(&unexplained)) {
            break;
        }
        let best = models.first();
        let made: Vec<FittedModel> = chunk
            .par_iter()
            .filter(|screened| deserves_fit(screened, screened_models, best))
            .filter_map(|screened| {
                let model = fit_screened(context, screened).ok();
                done();
                model
            })
            .collect();
        models.extend(made);
        sort(context, &mut models);
    }
    models
}

/// Best first, all in one measure: if a chaotic free run hides that any of them may be better than the others, all are compared under
/// an observer.
pub fn sort(context: &Context<'_>, models: &mut [FittedModel]) {
    let by_run = |a: &&FittedModel, b: &&FittedModel| a.ran().fitted.total_cmp(&b.ran().fitted);
    let best = models.iter().min_by(by_run);
    if best.is_some_and(|best| models.iter().any(|model| model.may_rival(best))) {
        observe_all(context, models);
    } else {
        // An observer that holds wrong models to the readings makes them all alike.
        models.iter_mut().for_each(|model| model.observed = None);
    }
    models.sort_by(FittedModel::by_score);
}

/// Whether a screened model deserves a full fit, `best` being the best so far.
fn deserves_fit(
    screened: &ScreenedModel,
    all: &[ScreenedModel],
    best: Option<&FittedModel>,
) -> bool {
    let Some(best) = best else { return true };
    let least = all.first().map_or(1.0, ScreenedModel::predicted);
    // Series-parallel and simulated runs predict with different errors: like is compared with like.
    let predicted = screened.predicted() / least.max(best.predicted_rms_counts).max(FLOOR);
    let look_alike = best.effects.last().is_some_and(|kind| {
        let names = kind.description().look_alikes;
        screened
            .newest()
            .is_some_and(|kind| names.contains(&kind.name()))
    });
    if screened.newest().is_some_and(|kind| kind.facts().costly)
        && screened.predicted() > BRISTLED * best.ran().fitted
    {
        // Their fit takes as long as a dozen others.
        return false;
    }
    if best.ran().at_floor() {
        // The rest is for rivals that may do as well.
        predicted < CLOSE || (look_alike && predicted < FAR)
    } else {
        predicted < FAR
    }
}

/// Dry friction is near the best if what it leaves is within this factor.
const NEAR_DRY: f64 = 3.0;
/// Bristles are fitted beyond a screened model that leaves at most this part of the best model's error.
const BRISTLED: f64 = 0.9;
/// Errors that are predicted below this many counts are as good as each other.
const FLOOR: f64 = 0.35;
