//! Models with one effect more: all are sketched, the promising ones refitted.

use super::judge::{is_exact, look_alikes, removes};
use super::substitution::swapped;
use crate::diagnose::candidate::fit::fit_screened;
use crate::diagnose::candidate::observer::observe_all;
use crate::diagnose::context::Workshop;
use crate::diagnose::lost_counts;
use crate::diagnose::models::{Refit, Sketch};
use crate::diagnose::screening::{free_run_ratio, rescreen, screen};
use rayon::prelude::*;
use shared::effects::{Kind, MAX_EFFECTS};

/// Most refits of one call, unless they leave something unexplained.
const MOST_REFITS: usize = 6;
/// The same where models run in windows.
const MOST_IN_WINDOWS: usize = 12;
/// Sketches within this factor of the best are refitted in any case.
const CLOSE: f64 = 1.5;
/// Beyond this factor of the best they are not, but for look-alikes of the best.
const FAR: f64 = 4.0;
/// Refits made at a time, whatever the number of processors, so that the result is always the same.
const AT_A_TIME: usize = 2;

/// The same model must not be sketched twice, whichever parent it comes from.
fn sets(parents: &[&Refit]) -> Vec<(usize, Kind)> {
    let mut seen: Vec<Vec<Kind>> = Vec::new();
    let mut pairs = Vec::new();
    for (index, parent) in parents.iter().enumerate() {
        if parent.structure.effects.len() >= MAX_EFFECTS || parent.losses.is_some() {
            continue;
        }
        for &kind in Kind::ALL {
            // Losses are found, not sketched.
            if parent.effects.contains(&kind) || kind == Kind::MissedCounts {
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
pub fn extend(workshop: &Workshop<'_>, parents: &[&Refit], done: &(dyn Fn() + Sync)) -> Vec<Refit> {
    let mut models: Vec<Refit> = parents
        .iter()
        // In windows a jump is forgotten with the window.
        .filter(|_| workshop.span.window_s.is_none())
        .filter_map(|parent| {
            let found = lost_counts::found(workshop, parent);
            done();
            found
        })
        .collect();
    // Jumps of whole counts that leave the encoder's own error: nothing smooth does the same.
    if models.iter().all(|model| !model.free().at_floor()) {
        for parent in parents.iter().filter(|parent| parent.losses.is_some()) {
            models.extend(lost_counts::beside(workshop, parent, |workshop, bare| {
                extend(workshop, &[bare], done)
            }));
        }
        models.extend(smooth(workshop, parents, done));
    }
    sort(workshop, &mut models);
    models
}

/// Every model that adds one effect that can be simulated. Bristles cost much: they, and what builds on them,
/// are tried where nothing else will do.
fn smooth(workshop: &Workshop<'_>, parents: &[&Refit], done: &(dyn Fn() + Sync)) -> Vec<Refit> {
    let (plain, bristles): (Vec<_>, Vec<_>) = sets(parents).into_iter().partition(|(at, kind)| {
        *kind != Kind::Lugre && !parents[*at].effects.contains(&Kind::Lugre)
    });
    let sketch_all = |sets: &[(usize, Kind)], dry: &[Sketch]| -> Vec<Sketch> {
        sets.par_iter()
            .filter(|_| !workshop.effort.halted())
            .filter_map(|&(parent, kind)| {
                let sketch = screen(workshop, parents[parent], kind, dry);
                done();
                sketch
            })
            .collect()
    };
    let mut sketches: Vec<Sketch> = Vec::new();
    let mut models: Vec<Refit> = Vec::new();
    // The best parent first: where it is half of the truth, the others need not be tried.
    for parent in 0..parents.len() {
        workshop.effort.take_stock();
        let own: Vec<_> = plain
            .iter()
            .copied()
            .filter(|(at, _)| *at == parent)
            .collect();
        let mut more = sketch_all(&own, &[]);
        let worth = free_run_ratio(workshop, parents[parent]);
        for sketch in &mut more {
            sketch.worth = worth;
        }
        sort_sketches(&mut more);
        again_from_best(workshop, parents, &mut more);
        let further = parent == 0 && workshop.span.window_s.is_none();
        models = refits(workshop, &more, models, done, |best| {
            further && !removes(parents[parent], best)
        });
        sketches.extend(more);
        if models.first().is_some_and(|model| model.ran().at_floor()) {
            break;
        }
    }
    sort_sketches(&mut sketches);
    // Beside other effects, dry friction is tried against bristles at the end.
    let first = parents.iter().all(|parent| parent.effects.is_empty());
    let explained = models.first().is_some_and(|model| {
        if first {
            is_exact(model, workshop.floor)
        } else {
            parents.iter().all(|parent| removes(parent, model))
        }
    });
    if explained || bristles.is_empty() {
        if !first {
            models.extend(bristled(workshop, &models));
            sort(workshop, &mut models);
        }
        return models;
    }
    // Bristles cannot be led: they start from dry friction, where that comes near the best.
    let least = sketches.first().map_or(f64::INFINITY, Sketch::foreseen);
    let dry = |sketch: &Sketch| {
        matches!(sketch.newest(), Some(Kind::Coulomb | Kind::Stribeck))
            && sketch.foreseen() < NEAR_DRY * least.max(FLOOR)
    };
    let near_dry = sketches.iter().any(dry);
    let bristles: Vec<_> = bristles
        .into_iter()
        .filter(|(parent, kind)| *kind != Kind::Lugre || (*parent == 0 && near_dry))
        .collect();
    let mut more = sketch_all(&bristles, &sketches);
    sort_sketches(&mut more);
    refits(workshop, &more, models, done, |_| false)
}

/// The first of the `models` with bristles in the place of its dry friction, where it leaves something to
/// explain.
fn bristled(workshop: &Workshop<'_>, models: &[Refit]) -> Option<Refit> {
    let best = models.first().filter(|model| !model.ran().at_floor())?;
    let dry = |kind: &&Kind| matches!(kind, Kind::Coulomb | Kind::Stribeck);
    let place = *best.effects.iter().find(dry)?;
    swapped(workshop, best, place, Kind::Lugre, models)
}

/// Best first.
fn sort_sketches(sketches: &mut [Sketch]) {
    sketches.sort_by(|a, b| a.foreseen().total_cmp(&b.foreseen()));
}

/// The parent's machine may be far off for want of the effect. The best sketch has a better one: its
/// look-alikes get a second start there, lest they lose for their start alone.
fn again_from_best(workshop: &Workshop<'_>, parents: &[&Refit], sketches: &mut [Sketch]) {
    let Some((best, others)) = sketches.split_first_mut() else {
        return;
    };
    let Some(kind) = best.newest() else { return };
    let (best, least) = (&*best, best.foreseen());
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
    others.par_iter_mut().for_each(|sketch| {
        let Some(newest) = sketch.newest() else {
            return;
        };
        let beside = sketch.structure.effects.starts_with(&parent.effects);
        if beside && look_alikes(kind, newest) && sketch.foreseen() > CLOSE * least {
            let with_all = rescreen(workshop, sketch, &parent, best);
            let again = screen(workshop, &parent, newest, &[]);
            for mut again in [with_all, again].into_iter().flatten() {
                again.worth = sketch.worth;
                if again.foreseen() < sketch.foreseen() {
                    *sketch = again;
                }
            }
        }
    });
    sort_sketches(sketches);
}

/// Full fits of promising sketches beside the models that were `made` before, best first. Not more than what is usual,
/// unless the best of them leaves something that is `unexplained`: a sketch may have ended early in a long valley.
fn refits(
    workshop: &Workshop<'_>,
    sketches: &[Sketch],
    made: Vec<Refit>,
    done: &(dyn Fn() + Sync),
    unexplained: impl Fn(&Refit) -> bool,
) -> Vec<Refit> {
    // In windows more of them are alike.
    let windows = workshop.span.window_s.is_some();
    let most = if windows {
        MOST_IN_WINDOWS
    } else {
        MOST_REFITS
    };
    let before = made.len();
    let mut refits = made;
    for chunk in sketches.chunks(AT_A_TIME) {
        workshop.effort.take_stock();
        let enough = refits.len() >= before + most;
        if workshop.effort.halted() || (enough && !refits.first().is_some_and(&unexplained)) {
            break;
        }
        let best = refits.first();
        let made: Vec<Refit> = chunk
            .par_iter()
            .filter(|sketch| worth(sketch, sketches, best))
            .filter_map(|sketch| {
                let refit = fit_screened(workshop, sketch).ok();
                done();
                refit
            })
            .collect();
        refits.extend(made);
        sort(workshop, &mut refits);
    }
    refits
}

/// Best first, all in one measure: if free runs of any of them are chaotic, all are tracked.
pub fn sort(workshop: &Workshop<'_>, refits: &mut [Refit]) {
    if refits.iter().any(|refit| refit.tracked.is_some()) {
        observe_all(workshop, refits);
    }
    refits.sort_by(Refit::by_score);
}

/// Whether a sketch deserves a full fit, `best` being the best so far.
fn worth(sketch: &Sketch, all: &[Sketch], best: Option<&Refit>) -> bool {
    let Some(best) = best else { return true };
    let least = all.first().map_or(1.0, Sketch::foreseen);
    // What is led and what is simulated foresee with different errors: like is compared with like.
    let foreseen = sketch.foreseen() / least.max(best.foreseen_rms_counts).max(FLOOR);
    let look_alike = best.effects.last().is_some_and(|kind| {
        let names = kind.description().look_alikes;
        sketch
            .newest()
            .is_some_and(|kind| names.contains(&kind.name()))
    });
    if sketch.newest() == Some(Kind::Lugre) && sketch.foreseen() > BRISTLED * best.ran().fitted {
        // Their fit takes as long as a dozen others.
        return false;
    }
    if best.ran().at_floor() {
        // The rest is for rivals that may do as well.
        foreseen < CLOSE || (look_alike && foreseen < FAR)
    } else {
        foreseen < FAR
    }
}

/// Dry friction is near the best if what it leaves is within this factor.
const NEAR_DRY: f64 = 3.0;
/// Bristles are fitted beyond a sketch that leaves at most this part of the best model's error.
const BRISTLED: f64 = 0.9;
/// Errors that are foreseen below this many counts are as good as each other.
const FLOOR: f64 = 0.35;
