//! The exact step of the linear machine for a held command, in SI: what an observer on the device computes with.
//!
//! It is the step of `shared` ([`Increments`], zero-order hold by scaling and squaring) with one volt, one radian a second
//! and one radian as bases, so that its coefficients are SI. The states are `c = R·i`, the voltage that the current uses up
//! in the resistance (V), and the speed (rad/s).

use super::error::ExportError;
use super::subject::Subject;
use shared::discretise::Discretisation;
use shared::effects::EffectSet;
use shared::model::{Increments, Plan};
use shared::units::PerUnit;
use std::f64::consts::TAU;

/// Increments of one step of `period` seconds; the angle's in rad.
///
/// # Errors
/// A period that is none, or a machine too fast for it.
pub fn step(subject: &Subject, period: f64) -> Result<Increments, ExportError> {
    let plan = Plan {
        machine: subject.machine,
        effects: EffectSet::default(),
        units: PerUnit::new(1.0, 1.0, period, TAU)?,
        discretisation: Discretisation::Exact,
        substeps: 1,
    };
    Ok(Increments::new(&plan)?)
}
