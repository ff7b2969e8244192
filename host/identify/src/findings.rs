//! Where the models of a diagnosis fail, and whether the last one leaves anything but the encoder's steps.

use crate::diagnose::{Diagnosis, FittedModel, evidence};
use crate::discovery::Curve;
use crate::error::Error;
use crate::fit::scores;
use crate::residual_analysis::{ResidualAnalysis, Whiteness, analyse_residual, whiteness};
use servoid_engine::problem::Data;
use shared::effects::Kind;

/// What the drawings show.
pub struct Findings {
    /// Of the linear motor.
    pub base: ResidualAnalysis,
    /// Of each step's model without the effect that it adds, with its other constants.
    pub steps: Vec<Option<ResidualAnalysis>>,
    /// The effect of each step in the last model beside a curve of no stated form; `None` where no variable alone carries it.
    pub curves: Vec<Option<Curve>>,
    /// Of the last model.
    pub last: ResidualAnalysis,
    /// Of the last model, on what was held out.
    pub held_out: ResidualAnalysis,
    /// What is left of the linear motor's error.
    pub base_whiteness: Option<Whiteness>,
    /// What is left of the last model's error.
    pub last_whiteness: Option<Whiteness>,
    /// Error of the linear motor's free run at each sample, model less measured, counts.
    pub base_errors: Vec<f64>,
    /// The same of the last model.
    pub last_errors: Vec<f64>,
}

/// Looks at the fitted recording, and with the last model at what was held out.
///
/// # Errors
/// Where a model cannot run, which it could before.
pub fn findings(diagnosis: &Diagnosis, data: &Data, held_out: &Data) -> Result<Findings, Error> {
    let complete = &diagnosis.last.candidate;
    let look = |refit: &FittedModel| {
        analyse_residual(data, &refit.candidate, complete, diagnosis.last.method)
    };
    let centre = data.half_cell();
    let errors = |refit: &FittedModel| -> Result<Vec<f64>, Error> {
        let errors = scores::whole(data, &refit.candidate, refit.method)?;
        Ok(errors.into_iter().map(|error| error - centre).collect())
    };
    let base_errors = errors(&diagnosis.base)?;
    let last_errors = errors(&diagnosis.last)?;
    let steps = 0..diagnosis.steps.len();
    let added: Vec<Kind> = diagnosis.steps.iter().map(|step| step.added).collect();
    Ok(Findings {
        base: look(&diagnosis.base)?,
        steps: steps
            .map(|index| evidence::asked_for(diagnosis, index, data))
            .collect::<Result<_, _>>()?,
        curves: Curve::of_each(data, complete, &added),
        last: look(&diagnosis.last)?,
        held_out: analyse_residual(held_out, complete, complete, diagnosis.last.method)?,
        base_whiteness: whiteness(data, &base_errors),
        last_whiteness: whiteness(data, &last_errors),
        base_errors,
        last_errors,
    })
}
