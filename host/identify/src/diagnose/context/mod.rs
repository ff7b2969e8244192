//! The recordings and how models are run: what every fit of a diagnosis needs.

mod budget;
mod motion;
mod span;

pub use budget::{Budget, USUAL_STEPS};
pub use motion::Motion;
pub use span::{Span, floor_counts, moves_both_ways};

use crate::fit::Options;
use servoid_engine::problem::{Data, Horizon};
use servoid_engine::simulation::Method;
use shared::encoder::FLOOR_RMS_COUNTS;

/// The recordings and how models are run.
pub struct Context<'a> {
    /// Fitted.
    pub data: &'a Data,
    /// Never fitted.
    pub held_out: &'a Data,
    /// The fitted recording's motion.
    pub motion: Motion,
    /// How far models run on their own.
    pub span: Span,
    /// How far models run along the fitted recording.
    pub fitted_horizon: Horizon,
    /// How far models run along the held-out recording.
    pub held_out_horizon: Horizon,
    /// RMS error that the reading's own noise makes of a right model, counts.
    pub floor: f64,
    /// How models are run at first.
    pub method: Method,
    /// How much may be computed.
    pub budget: &'a Budget<'a>,
}

impl<'a> Context<'a> {
    /// Prepares. Models are run with one part to a sample, which polishing refines where it
    /// matters.
    pub fn new(
        data: &'a Data,
        held_out: &'a Data,
        options: &Options,
        budget: &'a Budget<'a>,
    ) -> Self {
        let span = Span::of(data, options);
        Context {
            fitted_horizon: horizon(&span, data),
            held_out_horizon: horizon(&span, held_out),
            span,
            floor: FLOOR_RMS_COUNTS,
            data,
            held_out,
            motion: Motion::measured(data),
            method: Method {
                substeps: 1,
                ..options.method
            },
            budget,
        }
    }

    /// The same for runs over another span.
    #[must_use]
    pub fn over(self, span: Span) -> Self {
        Context {
            fitted_horizon: horizon(&span, self.data),
            held_out_horizon: horizon(&span, self.held_out),
            span,
            floor: FLOOR_RMS_COUNTS,
            ..self
        }
    }

    /// The same with another budget.
    pub fn with_budget<'b>(&self, budget: &'b Budget<'b>) -> Context<'b>
    where
        'a: 'b,
    {
        Context {
            budget,
            ..self.with_recordings(self.data, self.held_out)
        }
    }

    /// The same for two other recordings with the same times.
    pub fn with_recordings<'b>(&self, data: &'b Data, held_out: &'b Data) -> Context<'b>
    where
        'a: 'b,
    {
        Context {
            data,
            held_out,
            motion: Motion::measured(data),
            span: self.span.clone(),
            fitted_horizon: self.fitted_horizon.clone(),
            held_out_horizon: self.held_out_horizon.clone(),
            floor: self.floor,
            method: self.method,
            budget: self.budget,
        }
    }
}

/// How far models run along data on their own.
fn horizon(span: &Span, data: &Data) -> Horizon {
    match span.window_s {
        Some(seconds) => Horizon::windows(data, seconds),
        None => Horizon::Whole,
    }
}
