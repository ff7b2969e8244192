//! All that a diagnosis found.

use super::floor::{Floor, FloorKind};
use super::step::Step;
use super::verdict::Verdict;
use crate::diagnose::baseline::{Baseline, Prediction};
use crate::diagnose::context::Span;
use crate::diagnose::hypotheses::ProbableSet;
use crate::diagnose::models::{FittedModel, NOISE_COUNTS};
use shared::effects::Kind;

/// A diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// How far models ran on their own, and why.
    pub span: Span,
    /// The linear motor.
    pub base: FittedModel,
    /// The verdict.
    pub verdict: Verdict,
    /// The effects, in the order in which they were added.
    pub steps: Vec<Step>,
    /// The model with all of them.
    pub last: FittedModel,
    /// Sets of effects that may be what is missing, the last model's first.
    pub hypotheses: Vec<ProbableSet>,
    /// Models with as many effects as the last one, and those in which one of its effects is another.
    pub rivals: Vec<FittedModel>,
    /// The best candidate that was not added, if one reduced the error but not beyond doubt.
    pub not_named: Option<Kind>,
    /// What the last model predicts over windows and whole runs, where it does not explain the recordings.
    pub predicts: Option<Prediction>,
    /// The best linear motor with Coulomb friction, offset and delay, against which it was held.
    pub baseline: Option<Baseline>,
    /// What stands below the last model's error; `None` where that is not the encoder and nothing more is known.
    pub floor: Option<Floor>,
    /// What to do next, in words.
    pub advice: Vec<String>,
    /// Whether the steps that it may take did not suffice: then not all effects were tried.
    pub ran_out: bool,
    /// Steps of a model that it took.
    pub steps_taken: u64,
}

impl Diagnosis {
    /// Part of the linear motor's error beyond the floor, as squares over the span in which models were judged, that the last model takes
    /// away; of what repeats have in common, where there are any. `None` where no floor is known.
    pub fn explained_share(&self) -> Option<f64> {
        let floor = self.floor?;
        if floor.kind == FloorKind::Encoder {
            return Some(1.0);
        }
        if let Some(repeats) = floor.repeats {
            return Some(repeats.last.explained_share(&repeats.base));
        }
        let (before, after) = (self.base.windowed?.fitted, self.last.windowed?.fitted);
        let explainable = (before.powi(2) - floor.counts.powi(2)).max(f64::MIN_POSITIVE);
        Some(((before.powi(2) - after.powi(2)) / explainable).clamp(0.0, 1.0))
    }

    /// Whether the last model explains the fitted recording down to the encoder, and what was held out not.
    pub fn fits_only_its_own(&self) -> bool {
        let errors = self.last.judged();
        errors.fitted < NOISE_COUNTS
            && errors.held_out >= NOISE_COUNTS
            && !self.last.explains_both()
    }
}
