//! Models with one effect more: all are sketched, the promising ones refitted.

use super::refit::Refit;
use super::sketch::Sketch;
use super::workshop::Workshop;
use rayon::prelude::*;
use shared::effects::{Kind, MAX_EFFECTS};
use std::sync::atomic::{AtomicBool, Ordering};

/// Most refits of one call.
const MOST_REFITS: usize = 8;
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
        if parent.structure.effects.len() >= MAX_EFFECTS {
            continue;
        }
        for &kind in Kind::ALL {
            if parent.effects.contains(&kind) {
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
pub fn extend(
    workshop: &Workshop<'_>,
    parents: &[&Refit],
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Vec<Refit> {
    let mut sketches: Vec<Sketch> = sets(parents)
        .par_iter()
        .filter(|_| !stop.load(Ordering::Relaxed))
        .filter_map(|&(parent, kind)| {
            let sketch = workshop.sketch(parents[parent], kind);
            done();
            sketch
        })
        .collect();
    sketches.sort_by(|a, b| a.foreseen().total_cmp(&b.foreseen()));
    refits(workshop, &sketches, stop, done)
}

fn refits(
    workshop: &Workshop<'_>,
    sketches: &[Sketch],
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Vec<Refit> {
    // In windows more of them are alike.
    let windows = workshop.span.window_s.is_some();
    let most = if windows {
        MOST_IN_WINDOWS
    } else {
        MOST_REFITS
    };
    let mut refits: Vec<Refit> = Vec::new();
    for chunk in sketches.chunks(AT_A_TIME) {
        if stop.load(Ordering::Relaxed) || refits.len() >= most {
            break;
        }
        let best = refits.first();
        let made: Vec<Refit> = chunk
            .par_iter()
            .filter(|sketch| worth(sketch, sketches, best))
            .filter_map(|sketch| {
                let refit = workshop.refit(sketch).ok();
                done();
                refit
            })
            .collect();
        refits.extend(made);
        sort(&mut refits);
    }
    if refits.iter().any(|refit| refit.tracked.is_some()) {
        for refit in &mut refits {
            // A model that cannot be tracked keeps the errors of its free runs.
            let _ = workshop.track(refit);
        }
        sort(&mut refits);
    }
    refits
}

/// Best first.
fn sort(refits: &mut [Refit]) {
    refits.sort_by(|a, b| a.judged().score().total_cmp(&b.judged().score()));
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
    if best.ran().at_floor() {
        // The rest is for rivals that may do as well.
        foreseen < CLOSE || (look_alike && foreseen < FAR)
    } else {
        foreseen < FAR
    }
}

/// Errors that are foreseen below this many counts are as good as each other.
const FLOOR: f64 = 0.35;
