//! Forms of effects other than the textbook's, in a fit: they are searched for where the textbook's leave something to explain.

use servoid_engine::problem::FitProblem;
use servoid_engine::solve::Found;
use shared::cost::Cost;
use shared::encoder::FLOOR_RMS_COUNTS;

/// Part of the squared error above the encoder's floor that other forms, or a named effect, must remove.
pub(crate) const MUST_REMOVE: f64 = 0.6;

/// The problem with its forms free, begun where `found` ended. `None` where no form is held, or nothing is left to explain.
pub fn with_forms_free<'a>(problem: &FitProblem<'a>, found: &Found) -> Option<FitProblem<'a>> {
    let structure = problem.structure.with_forms_free()?;
    if problem.cost != Cost::Squared || excess(problem, found) <= 0.0 {
        return None;
    }
    let start = structure.coordinates(&problem.structure.values(&found.x));
    Some(problem.with_structure(structure, start))
}

/// Whether the forms that `freed` found remove enough of what `found` leaves.
pub fn earned(problem: &FitProblem<'_>, found: &Found, freed: &Found) -> bool {
    excess(problem, freed) < (1.0 - MUST_REMOVE) * excess(problem, found)
}

/// Squared error above what the encoder leaves.
fn excess(problem: &FitProblem<'_>, found: &Found) -> f64 {
    found.cost - FLOOR_RMS_COUNTS.powi(2) * problem.data.len() as f64
}
