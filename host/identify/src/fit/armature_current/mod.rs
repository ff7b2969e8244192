//! What a measured armature current says of the machine.
//!
//! | file | holds |
//! |---|---|
//! | `torque` | the current as the shaft's torque: inertia and viscous friction, where the model explains the motion |
//! | `winding` | the current as the winding's: resistance and back-EMF, whatever moves the shaft |
//! | `decay` | the electrical time constant, from one current to the next |
//! | `plane` | the regression of a current on a voltage and a speed |
//! | `least_squares` | slopes over a few columns, with errors that are correlated over time |

mod decay;
mod least_squares;
mod plane;
mod torque;
mod winding;

use super::physical::CurrentEvidence;
use super::remarks::EXPLAINED_COUNTS;
use super::uncertainty::Uncertainty;
use servoid_engine::problem::{Candidate, FitProblem, rms_counts};
use servoid_io::channel::Measured;
use torque::{Torque, torque_evidence};
use winding::{Winding, winding_evidence};

/// What the current says. `None` without one, or where it says little.
///
/// Where the model explains the motion down to the encoder, its own current has no noise, and the torque's equation tells most. A
/// torque that the model lacks is in the current and moves the shaft, so that it looks like one that depends on the speed: then the
/// winding's equation, which knows of no torque. Where that has no logged voltage, the inertia alone is taken from the current.
pub fn current_evidence(
    problem: &FitProblem<'_>,
    candidate: &Candidate,
    spread: &Uncertainty,
) -> Option<CurrentEvidence> {
    // Without one there is nothing to run the model for.
    problem.data.measured.get(Measured::Current)?;
    let is_reckoned = problem.data.recordings.loops().next().is_some();
    let explained = explained(problem, candidate);
    if !explained
        && !is_reckoned
        && let Some(Winding { resistance, kb }) = winding_evidence(problem.data, candidate)
    {
        return Some(CurrentEvidence::Winding { resistance, kb });
    }
    let Torque {
        inertia,
        mut friction,
    } = torque_evidence(problem, candidate, spread)?;
    if !explained {
        // It is then anything between nothing and all of the damping.
        let machine = &candidate.machine;
        let resistance = machine.inertia / inertia.value;
        friction.std = libm::hypot(friction.std, (machine.kb + machine.damping) / resistance);
    }
    Some(CurrentEvidence::Torque { inertia, friction })
}

/// Whether the free run leaves no more than the encoder.
fn explained(problem: &FitProblem<'_>, candidate: &Candidate) -> bool {
    let errors = problem.errors(candidate);
    let rms = errors.map(|errors| rms_counts(problem.data, &errors));
    !problem.data.quantised || rms.is_ok_and(|rms| rms <= EXPLAINED_COUNTS)
}
