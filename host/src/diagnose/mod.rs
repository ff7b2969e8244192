//! Names the physics that a model lacks: fits the linear motor, and while the error is above the
//! encoder's floor, refits with every effect of the catalogue in turn and judges them on the fitted
//! and on a held-out recording together.
//!
//! An effect is named only where the held-out error agrees; otherwise the verdict says that
//! something is missing and that nothing in the catalogue explains it.

mod descent;
mod judge;
mod led;
mod motion;
mod orders;
mod refit;
mod starts;

pub use judge::{Ruling, judge};
pub use refit::{Refit, Sketch, Workshop};

use crate::error::Error;
use crate::fit::Options;
use crate::problem::Data;
use rayon::prelude::*;
use shared::effects::{Kind, MAX_EFFECTS};
use std::sync::atomic::{AtomicBool, Ordering};

/// Most effects that are added.
const MOST_STEPS: usize = 3;
/// Errors below this are the encoder's own, counts RMS: its floor of 0.2887 with room for a recording
/// whose readings dwell in one part of their cells.
pub const NOISE_COUNTS: f64 = 0.33;

/// What the recording says of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The linear motor explains the recording down to the encoder.
    Complete,
    /// The named effects were missing, and with them the rest is the encoder's.
    MissingEffects,
    /// What is left is not the encoder's, and no effect of the catalogue explains it.
    Unexplained,
    /// The recording cannot tell.
    Inconclusive,
}

impl Verdict {
    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Complete => "complete",
            Verdict::MissingEffects => "missing_effects",
            Verdict::Unexplained => "unexplained",
            Verdict::Inconclusive => "inconclusive",
        }
    }
}

/// One effect that was added, and what it was chosen from.
#[derive(Clone, Debug)]
pub struct Step {
    /// The effect.
    pub added: Kind,
    /// Effects that explain this recording as well.
    pub indistinguishable_from: Vec<Kind>,
    /// From one half (no lead over the best rival that is no look-alike) to one.
    pub confidence: f64,
    /// All candidates with their refits, best first.
    pub candidates: Vec<Refit>,
    /// Chance of so large a gain if the effect were absent, for each candidate.
    pub p_values: Vec<f64>,
}

/// A diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The linear motor.
    pub base: Refit,
    /// The verdict.
    pub verdict: Verdict,
    /// The effects, in the order in which they were added.
    pub steps: Vec<Step>,
    /// The model with all of them.
    pub last: Refit,
    /// The best candidate that was not added, if one reduced the error but not beyond doubt.
    pub not_named: Option<Kind>,
    /// What to do next, in words.
    pub advice: Vec<String>,
}

/// Diagnoses `data`, judging by `held_out`, which is never fitted.
///
/// # Errors
/// [`Error::Failed`] where not even the linear motor can be fitted.
pub fn diagnose(
    data: &Data,
    held_out: &Data,
    options: &Options,
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Result<Diagnosis, Error> {
    let workshop = Workshop::new(data, held_out, options);
    let base = workshop.base(options)?;
    let mut diagnosis = Diagnosis {
        last: base.clone(),
        base,
        verdict: Verdict::Complete,
        steps: Vec::new(),
        not_named: None,
        advice: Vec::new(),
    };
    while !diagnosis.last.at_floor() {
        diagnosis.verdict = Verdict::Unexplained;
        if diagnosis.steps.len() == MOST_STEPS.min(MAX_EFFECTS) || stop.load(Ordering::Relaxed) {
            break;
        }
        let candidates = candidates(&workshop, &diagnosis.last, stop, done);
        match judge(data, &diagnosis.last, candidates) {
            Ruling::Named(step) => {
                diagnosis.last = step.candidates[0].clone();
                diagnosis.steps.push(step);
            }
            Ruling::Doubtful(kind) => {
                diagnosis.not_named = kind;
                break;
            }
        }
    }
    if diagnosis.last.at_floor() && !diagnosis.steps.is_empty() {
        diagnosis.verdict = Verdict::MissingEffects;
    }
    if diagnosis.verdict != Verdict::Complete && !moves_both_ways(data) {
        diagnosis.verdict = Verdict::Inconclusive;
        diagnosis.advice.push(
            "the motor never reverses in this recording: friction, an offset and a load look alike; \
             record steps of both signs, or a slow triangle through zero"
                .to_owned(),
        );
    }
    advise(&mut diagnosis);
    Ok(diagnosis)
}

/// A sketch is worth a full refit if its error is within this factor of the best.
const WORTH: f64 = 4.0;
/// Most full refits a step.
const MOST_REFITS: usize = 7;

/// Every effect that is not in the model yet, sketched on top of it; the promising ones refitted, on all
/// cores.
fn candidates(
    workshop: &Workshop<'_>,
    last: &Refit,
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Vec<Refit> {
    let mut sketches: Vec<(Kind, Sketch)> = Kind::ALL
        .par_iter()
        .filter(|kind| !last.effects.contains(kind) && !stop.load(Ordering::Relaxed))
        .filter_map(|&kind| {
            let t = std::time::Instant::now();
            let sketch = workshop.sketches(last, kind);
            done();
            if std::env::var("TRACE").is_ok() {
                if let Some(s) = &sketch {
                    eprintln!(
                        "  sketch {:16} led {:9.3} sim {:9.3} {:.3}s {:?}",
                        kind.name(),
                        s.led,
                        s.simulated,
                        t.elapsed().as_secs_f64(),
                        s.structure.values(&s.x)
                    );
                }
            }
            Some((kind, sketch?))
        })
        .collect();
    sketches.sort_by(|(_, a), (_, b)| a.led.min(a.simulated).total_cmp(&b.led.min(b.simulated)));
    let Some(least) = sketches.first().map(|(_, s)| s.led.min(s.simulated)) else {
        return Vec::new();
    };
    sketches
        .par_iter()
        .take(MOST_REFITS)
        .filter(|(_, s)| s.led.min(s.simulated) < WORTH * least.max(0.5))
        .filter_map(|(kind, sketch)| {
            let t = std::time::Instant::now();
            let r = workshop.refit(sketch).ok();
            if std::env::var("TRACE").is_ok() {
                if let Some(r) = &r {
                    eprintln!(
                        "  refit {:16} {:9.3}/{:9.3} {} evals {:.3}s {:?}",
                        kind.name(),
                        r.rms_counts,
                        r.validate_rms_counts,
                        r.evaluations,
                        t.elapsed().as_secs_f64(),
                        r.parameters
                    );
                }
            }
            r
        })
        .collect()
}

/// Whether a twentieth of the travel at least goes against the prevailing direction.
fn moves_both_ways(data: &Data) -> bool {
    let (mut forward, mut backward) = (0.0, 0.0);
    for pair in data.counts.windows(2) {
        let step = pair[1] - pair[0];
        if step > 0.0 {
            forward += step
        } else {
            backward -= step
        }
    }
    forward.min(backward) > 0.05 * (forward + backward)
}

fn advise(diagnosis: &mut Diagnosis) {
    for step in &diagnosis.steps {
        if step.indistinguishable_from.is_empty() {
            continue;
        }
        let names: Vec<&str> = step
            .indistinguishable_from
            .iter()
            .map(|kind| kind.name())
            .collect();
        diagnosis.advice.push(format!(
            "{} and {} explain this recording alike; to separate them: {}",
            step.added.name(),
            names.join(", "),
            step.added.description().exposed_by
        ));
    }
    if diagnosis.verdict == Verdict::Unexplained {
        diagnosis.advice.push(match diagnosis.not_named {
            Some(kind) => format!(
                "{} reduces the error most, but not beyond doubt: residual, not named",
                kind.name()
            ),
            None => {
                "no effect of the catalogue reduces the error on the held-out recording".to_owned()
            }
        });
    }
}
