//! What one effect takes of the drive along a motion.

use super::{filter_time, simulated};
use crate::error::Error;
use crate::fit::scores::{EquationResidual, equation_residuals};
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use shared::effects::Kind;

/// The volts that `candidate` without the effect `kind` misses along the run of the model with it: the effect's alone, whichever state of
/// it no recording shows.
///
/// # Errors
/// Where the model cannot run.
pub fn own_volts(
    data: &Data,
    candidate: &Candidate,
    kind: Kind,
    method: Method,
) -> Result<Vec<EquationResidual>, Error> {
    let mut run = simulated(data, candidate, method)?;
    // Its angles are no counts.
    run.quantised = false;
    Ok(equation_residuals(
        &run,
        &candidate.without(kind),
        filter_time(data),
    ))
}
