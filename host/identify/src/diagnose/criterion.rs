//! By which errors models of two recordings are judged: those of whole runs (simulation), or those of windows, each run from the
//! measured state (prediction some way ahead).

use super::context::{Budget, Context, Span};
use super::linear::fit_linear_motor;
use super::models::{Errors, FittedModel};
use crate::error::Error;
use crate::fit::{Fit, Options};
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle, errors, rms_counts};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use shared::encoder::FLOOR_RMS_COUNTS;

/// How far models of two recordings run on their own before they are set back to the measured state, and the error that the
/// reading's own noise makes of a right model over that span.
#[derive(Clone, Debug, PartialEq)]
pub struct Criterion {
    /// How far models run, and why.
    pub span: Span,
    /// RMS error of a right model, counts.
    pub floor: f64,
}

impl Criterion {
    /// That of a diagnosis of the same recordings: the linear motor is fitted, and where its free run says little, models run in
    /// windows. Where no linear motor can be fitted, what the kind of recording demands.
    pub fn of(data: &Data, held_out: &Data, options: &Options, budget: &Budget<'_>) -> Self {
        let prepared = Context::new(data, held_out, options, budget);
        match fit_linear_motor(prepared, options) {
            Ok(linear) => Criterion {
                span: linear.context.span,
                floor: linear.context.floor,
            },
            Err(_) => Criterion {
                span: Span::of(data, options),
                floor: FLOOR_RMS_COUNTS,
            },
        }
    }

    /// The errors by which a fit is judged.
    ///
    /// # Errors
    /// Where the model cannot run.
    pub fn errors(&self, data: &Data, held_out: &Data, fit: &Fit) -> Result<Errors, Error> {
        if self.span.window_s.is_none() {
            return Ok(Errors {
                fitted: fit.rms_counts,
                held_out: fit.validate_rms_counts.unwrap_or(fit.rms_counts),
                floor: self.floor,
            });
        }
        self.in_windows(data, held_out, &fit.candidate, fit.method)
    }

    /// The same of a model of a search, which may have run over some of the windows only.
    pub(super) fn errors_of(
        &self,
        data: &Data,
        held_out: &Data,
        model: &FittedModel,
    ) -> Result<Errors, Error> {
        if self.span.window_s.is_none() {
            return Ok(model.ran());
        }
        self.in_windows(data, held_out, &model.candidate, model.method)
    }

    fn in_windows(
        &self,
        data: &Data,
        held_out: &Data,
        candidate: &Candidate,
        method: Method,
    ) -> Result<Errors, Error> {
        let rms = |data: &Data| -> Result<f64, Error> {
            Ok(rms_counts(data, &self.run(data, candidate, method)?))
        };
        Ok(Errors {
            fitted: rms(data)?,
            held_out: rms(held_out)?,
            floor: self.floor,
        })
    }

    /// Model minus measured angle over the span, counts, one a sample; a floored reading stands for the middle of its cell.
    ///
    /// # Errors
    /// Where the model cannot run.
    pub fn residual(
        &self,
        data: &Data,
        candidate: &Candidate,
        method: Method,
    ) -> Result<Vec<f64>, Error> {
        let errors = self.run(data, candidate, method)?;
        let centre = data.half_cell();
        Ok(errors.iter().map(|error| error - centre).collect())
    }

    /// Model minus reading; every window of them, also where a search runs over some.
    fn run(&self, data: &Data, candidate: &Candidate, method: Method) -> Result<Vec<f64>, Error> {
        let horizon = match self.span.window_s {
            Some(seconds) => Horizon::windows(data, seconds),
            None => Horizon::Whole,
        };
        let (cost, start) = (Cost::Squared, StartAngle::Free);
        Ok(errors(data, candidate, method, &horizon, start, cost)?)
    }

    /// What fits of a diagnosis need, over this span.
    pub(super) fn context<'a>(
        &self,
        data: &'a Data,
        held_out: &'a Data,
        options: &Options,
        budget: &'a Budget<'a>,
    ) -> Context<'a> {
        let context = Context::new(data, held_out, options, budget).over(self.span.clone());
        Context {
            floor: self.floor,
            ..context
        }
    }
}
