//! How well a model predicts both recordings: in windows, and over the whole.

use crate::diagnose::context::{Context, Span};
use crate::diagnose::models::FittedModel;
use crate::fit::{scores, validate_roughly};
use servoid_engine::problem::{Data, Horizon, StartAngle, errors, rms_counts};
use shared::cost::Cost;

/// RMS errors of a model, counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prediction {
    /// In windows of the fitted recording; of a model that follows the whole of it better than readings tell it where a window starts,
    /// over the whole.
    pub windowed: f64,
    /// Over the whole fitted recording.
    pub whole: f64,
    /// In windows of the held-out recording, likewise.
    pub held_out_windowed: f64,
    /// Over the whole held-out recording.
    pub held_out_whole: f64,
    /// Length of the windows, s.
    pub window_s: f64,
}

impl Prediction {
    /// Of a model in the windows of a diagnosis; `None` where it cannot run.
    pub fn of(context: &Context<'_>, model: &FittedModel) -> Option<Self> {
        Windows::of(context).prediction(context, model)
    }

    /// Sum of the errors' logarithms.
    pub fn score(&self) -> f64 {
        [
            self.windowed,
            self.whole,
            self.held_out_windowed,
            self.held_out_whole,
        ]
        .iter()
        .map(|rms| libm::log(rms.max(f64::MIN_POSITIVE)))
        .sum()
    }

    /// Sum of the held-out errors' logarithms.
    pub fn held_out_score(&self) -> f64 {
        let positive = |rms: f64| libm::log(rms.max(f64::MIN_POSITIVE));
        positive(self.held_out_windowed) + positive(self.held_out_whole)
    }

    /// Whether neither held-out error exceeds that of `other` by more than the part `allowed`.
    pub fn no_worse_than(&self, other: &Prediction, allowed: f64) -> bool {
        self.held_out_windowed <= (1.0 + allowed) * other.held_out_windowed
            && self.held_out_whole <= (1.0 + allowed) * other.held_out_whole
    }
}

/// The windows in which predictions are compared.
pub struct Windows {
    /// Of the fitted recording.
    pub fitted: Horizon,
    held_out: Horizon,
    window_s: f64,
}

impl Windows {
    /// Those of the diagnosis, or the usual ones where it ran whole recordings.
    pub fn of(context: &Context<'_>) -> Self {
        let window_s = context
            .span
            .window_s
            .unwrap_or_else(|| Span::usual_window_s(context.data));
        let windows = |data: &Data| Horizon::windows(data, window_s);
        Windows {
            fitted: windows(context.data),
            held_out: windows(context.held_out),
            window_s,
        }
    }

    /// What a model predicts; `None` where it cannot run.
    pub fn prediction(&self, context: &Context<'_>, model: &FittedModel) -> Option<Prediction> {
        let windowed = |data: &Data, horizon: &Horizon| {
            let (cost, start) = (Cost::Squared, StartAngle::Free);
            let errors = errors(data, &model.candidate, model.method, horizon, start, cost);
            errors.ok().map(|errors| rms_counts(data, &errors))
        };
        let whole = scores::whole(context.data, &model.candidate, model.method).ok()?;
        let whole = rms_counts(context.data, &whole);
        let held_out_whole =
            validate_roughly(context.held_out, &model.candidate, model.method).ok()?;
        // A window may start where the run through the whole recording has come to by then. Speed and current at its start, from
        // readings a few milliseconds apart, can be off by more than a right model is after seconds: a motor of ten watts under full
        // reversals was by 85 counts, and a model of 0.4 counts lost to one of 28.
        let prediction = Prediction {
            windowed: windowed(context.data, &self.fitted)?.min(whole),
            whole,
            held_out_windowed: windowed(context.held_out, &self.held_out)?.min(held_out_whole),
            held_out_whole,
            window_s: self.window_s,
        };
        prediction.score().is_finite().then_some(prediction)
    }
}
