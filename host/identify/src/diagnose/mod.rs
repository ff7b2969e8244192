//! Names the physics that a model lacks: fits the linear motor, and while the error is above the
//! encoder's floor, refits with every effect of the catalogue in turn and judges them on the fitted
//! and on a held-out recording together.
//!
//! An effect is named only where the held-out error agrees; otherwise the verdict says that
//! something is missing and that nothing in the catalogue explains it.

pub mod advice;
mod built_up;
mod carried;
mod conclude;
mod descent;
mod duel;
mod effort;
mod errors;
pub mod evidence;
mod extend;
mod findings;
mod follow;
pub mod holdout;
mod judge;
mod led;
mod levels;
mod missed;
mod motion;
mod needless;
mod orders;
pub mod pair;
mod plainer;
mod polish;
mod refit;
mod remark;
mod settle;
mod sketch;
mod span;
mod spectrum;
mod starts;
pub mod steady;
mod suggest;
mod swap;
mod track;
pub mod usable;
mod waves;
pub mod whereabouts;
mod workshop;

pub use built_up::{built_up, is_lost};
pub use effort::{Effort, USUAL_STEPS};
pub use errors::Errors;
pub use findings::{Findings, findings};
pub use holdout::HeldOut;
pub use missed::{Loss, Losses};
pub use orders::{Line, lines as order_lines};
pub use refit::Refit;
pub use remark::Remark;
pub use settle::settle;
pub use span::{Span, moves_both_ways};
pub use spectrum::Spectrum;
pub use suggest::{Suggestion, Suggestions, suggest};
pub use swap::same;
pub use track::Tracked;

use crate::error::Error;
use crate::fit::Options;
use conclude::conclude;
use levels::levels;
use servoid_engine::problem::Data;
use shared::effects::Kind;
use workshop::Workshop;

/// A constant that lowers the linear motor's error to this part shows that the motor is another.
const STEADIED: f64 = 0.2;
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
    /// From one half (no lead over the best rival that is no look-alike) to one; less where look-alikes stand beside it,
    /// and by the part of the error that the whole model leaves unexplained.
    pub confidence: f64,
    /// All candidates with their refits, best first.
    pub candidates: Vec<Refit>,
    /// Chance of so large a gain if the effect were absent, for each candidate.
    pub p_values: Vec<f64>,
    /// All orders of a cogging torque, of which the model holds the strongest.
    pub spectrum: Option<Spectrum>,
}

/// A diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// How far models ran on their own, and why.
    pub span: Span,
    /// The linear motor.
    pub base: Refit,
    /// The verdict.
    pub verdict: Verdict,
    /// The effects, in the order in which they were added.
    pub steps: Vec<Step>,
    /// The model with all of them.
    pub last: Refit,
    /// Models with as many effects as the last one, and those in which one of its effects is another.
    pub rivals: Vec<Refit>,
    /// The best candidate that was not added, if one reduced the error but not beyond doubt.
    pub not_named: Option<Kind>,
    /// What to do next, in words.
    pub advice: Vec<String>,
    /// Whether the steps that it may take did not suffice: then not all effects were tried.
    pub ran_out: bool,
    /// Steps of a model that it took.
    pub steps_taken: u64,
}

impl Diagnosis {
    /// Whether the last model explains the fitted recording down to the encoder, and what was held out not.
    pub fn fits_only_its_own(&self) -> bool {
        let errors = self.last.judged();
        errors.fitted < NOISE_COUNTS && errors.held_out >= NOISE_COUNTS
    }
}

/// Diagnoses `data`, judging by `held_out`, which is never fitted.
///
/// # Errors
/// [`Error::Failed`] where not even the linear motor can be fitted.
pub fn diagnose(
    data: &Data,
    held_out: &Data,
    options: &Options,
    effort: &Effort<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<Diagnosis, Error> {
    let mut workshop = Workshop::new(data, held_out, options, effort);
    let mut base = workshop.base(options)?;
    let steadied = (!base.free().at_floor())
        .then(|| workshop.steadied(options))
        .flatten();
    let left = steadied.map_or(f64::INFINITY, |(_, rms)| rms);
    let span = workshop.span.clone().after(data, &base, left);
    if span != workshop.span {
        workshop = workshop.over(span);
        base = workshop.base(options)?;
    }
    let workshop = workshop;
    // Where the motor has another gain beside a constant, that is where the search for effects starts.
    let mut anchored = base.clone();
    if let Some((machine, _)) = steadied.filter(|(_, rms)| *rms < STEADIED * base.rms_counts) {
        anchored.candidate.machine = machine;
    }
    let mut levels = levels(&workshop, &anchored, done);
    effort.conclude();
    // A search that ended early looks like missing physics: the linear motor is fitted again from where the
    // best model has it.
    if let Some(again) = levels
        .first()
        .and_then(|level| workshop.base_again(&base, &level.best.candidate.machine))
    {
        base = again;
        levels.clear();
    }
    let chosen = levels.iter().rposition(|level| level.believed);
    let mut diagnosis = Diagnosis {
        span: workshop.span.clone(),
        last: base.clone(),
        base,
        verdict: Verdict::Complete,
        steps: Vec::new(),
        rivals: Vec::new(),
        not_named: None,
        advice: Vec::new(),
        ran_out: false,
        steps_taken: 0,
    };
    if let Some(depth) = chosen {
        conclude(&workshop, &levels[..=depth], &mut diagnosis);
    }
    diagnosis.ran_out = effort.ran_out();
    diagnosis.steps_taken = effort.spent();
    let next = levels.get(chosen.map_or(0, |depth| depth + 1));
    diagnosis.not_named = next.and_then(|level| level.best.effects.last().copied());
    if diagnosis.last.explains() {
        if !diagnosis.steps.is_empty() {
            diagnosis.verdict = Verdict::MissingEffects;
        }
    } else {
        diagnosis.verdict = Verdict::Unexplained;
    }
    if !moves_both_ways(data) {
        // In windows a one-sided run may look complete that is not.
        if diagnosis.verdict != Verdict::Complete || !diagnosis.last.free().at_floor() {
            diagnosis.verdict = Verdict::Inconclusive;
        }
        diagnosis.advice.push(
            "the motor never reverses in this recording: friction, an offset and a load look alike, and may pass for \
             another gain; record steps of both signs, or a slow triangle through zero"
                .to_owned(),
        );
    }
    advice::advise(&mut diagnosis);
    Ok(diagnosis)
}
