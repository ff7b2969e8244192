//! The recordings and how models are run: what every fit of a diagnosis needs.

mod budget;
mod motion;
mod settings;
mod span;

pub use budget::{Budget, USUAL_STEPS};
pub use motion::Motion;
use settings::{GOLDEN, MOST_SAMPLES};
pub use span::{Span, floor_counts, moves_both_ways, noise_counts, together_move_both_ways};

use crate::fit::Options;
use servoid_engine::problem::{Data, Horizon, rms_counts};
use servoid_engine::simulation::Method;
use servoid_io::recording::Drive;
use shared::effects::Kind;
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
    /// Effects that models may have.
    pub candidates: Vec<Kind>,
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
            candidates: [&options.catalogue[..], &options.candidates].concat(),
            budget,
        }
    }

    /// Samples of the fitted recording that models run over.
    pub fn samples(&self) -> usize {
        samples(&self.fitted_horizon, self.data)
    }

    /// RMS of errors over the samples of a horizon of `data`, counts.
    pub fn rms_over(&self, data: &Data, horizon: &Horizon, errors: &[f64]) -> f64 {
        let part = samples(horizon, data) as f64 / data.len().max(1) as f64;
        rms_counts(data, errors) / part.max(f64::MIN_POSITIVE).sqrt()
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
            candidates: self.candidates.clone(),
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
        Some(seconds) => thinned(data, Horizon::windows(data, seconds)),
        None => Horizon::Whole,
    }
}

/// One window of each group of neighbours, where there are more samples than a search needs. Only of an angle that is no
/// count: the windows of counts are judged by the encoder's own error, sample by sample.
fn thinned(data: &Data, horizon: Horizon) -> Horizon {
    let Horizon::Windows(windows) = horizon else {
        return horizon;
    };
    let each = data.len().div_ceil(MOST_SAMPLES);
    if data.quantised || each < 2 {
        return Horizon::Windows(windows);
    }
    let chosen = windows.chunks(each).enumerate().map(|(group, windows)| {
        let place = (group as f64 * GOLDEN).fract() * windows.len() as f64;
        windows[place as usize].clone()
    });
    Horizon::Windows(chosen.collect())
}

/// Number of samples that are run over.
fn samples(horizon: &Horizon, data: &Data) -> usize {
    match horizon {
        Horizon::Windows(windows) => windows.iter().map(|window| window.range.len()).sum(),
        Horizon::Whole | Horizon::Observer(_) | Horizon::Corrected(_) => data.len(),
    }
}

/// The effect of a constant that adds to the command: behind a current loop it acts as a torque.
pub fn constant_drive(drive: Drive) -> Kind {
    match drive {
        Drive::Voltage => Kind::OffsetVoltage,
        Drive::Current | Drive::Torque => Kind::LoadTorque,
    }
}
