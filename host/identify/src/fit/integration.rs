//! The integration error of a fit: the model is stepped, and where its steps are too long the parameters bend themselves to make
//! up for it, far beyond what the readings' own errors allow. So a fit is repeated with half the step.

use super::report::Solved;
use super::uncertainty::Uncertainty;
use crate::error::Error;
use servoid_engine::problem::FitProblem;
use servoid_engine::simulation::Method;
use servoid_engine::solve::Found;
use shared::cost::Cost;
use shared::discretise::Discretisation;

/// A parameter that moves by more of its standard errors when the step is halved was not fitted with short enough ones.
const MOVED: f64 = 0.3;
/// Most steps to a sample.
const FINEST: u16 = 32;

/// Evaluations with shorter steps, in Jacobians: the fit with longer ones ended near enough.
const JACOBIANS: usize = 12;

/// Most evaluations that a fit of `problem` with shorter steps may take.
pub fn evaluations(problem: &FitProblem<'_>) -> usize {
    JACOBIANS * (problem.structure.dim() + 2)
}

/// A fit whose steps are short enough, or as short as they may be.
pub struct Refined<'a> {
    /// The problem, with the steps that it took.
    pub problem: FitProblem<'a>,
    /// Where its search ended.
    pub found: Found,
    /// What that says.
    pub solved: Solved,
    /// By how much each unknown still moved when the step was last halved; `None` where that no longer matters.
    pub left: Option<Vec<f64>>,
}

/// Halves the steps of a fit by least squares until no unknown moves by [`MOVED`] of its standard error. A linear motor is
/// discretised exactly, and the paper's Euler step is asked for as it is.
/// `search` is given the problem with shorter steps and the evaluations so far.
pub fn refined<'a>(
    mut refined: Refined<'a>,
    mut search: impl FnMut(&FitProblem<'a>, usize) -> Result<(Found, Solved), Error>,
) -> Refined<'a> {
    let exact = refined.problem.structure.effects.is_empty()
        || refined.problem.method.discretisation != Discretisation::Exact;
    if exact || refined.problem.cost != Cost::Squared {
        return refined;
    }
    loop {
        let Refined {
            problem,
            found,
            solved,
            ..
        } = &refined;
        let substeps = 2 * problem.method.substeps.max(1);
        if found.interrupted || substeps > FINEST {
            return refined;
        }
        // Without standard errors there is nothing that a step could be too long for.
        let Some(spread) = solved.uncertainty.as_ref().filter(|s| s.converged) else {
            return refined;
        };
        let mut finer = problem.with_structure(problem.structure.clone(), found.x.clone());
        finer.method = Method {
            substeps,
            ..problem.method
        };
        // A model that no longer runs is none to go on with.
        let Ok((again, resolved)) = search(&finer, found.evaluations) else {
            refined.left = None;
            return refined;
        };
        let moved: Vec<f64> = (resolved.values.iter().zip(&solved.values))
            .map(|(finer, coarser)| finer - coarser)
            .collect();
        if !matters(spread, &moved) {
            refined.left = None;
            return refined;
        }
        let evaluations = found.evaluations + again.evaluations;
        refined = Refined {
            problem: finer,
            found: Found {
                evaluations,
                ..again
            },
            solved: resolved,
            left: Some(moved),
        };
    }
}

/// What a user should know of the steps, where they are shorter than was `asked` for, or not short enough.
pub fn note(asked: Method, fit: &Refined<'_>) -> Option<String> {
    let steps = fit.problem.method.substeps;
    if fit.left.is_some() {
        return Some(format!(
            "the parameters still move by more than {MOVED} of their standard errors between {} and {steps} steps to a sample; \
             the standard errors are widened by that much. Record at shorter intervals",
            steps / 2
        ));
    }
    (steps != asked.substeps).then(|| {
        format!(
            "the model takes {steps} steps to a sample instead of {}: with fewer the parameters move by more than {MOVED} of \
             their standard errors",
            asked.substeps
        )
    })
}

/// Whether an unknown that the data determine moved by more than a part of its standard error.
fn matters(spread: &Uncertainty, moved: &[f64]) -> bool {
    (moved.iter().enumerate()).any(|(k, moved)| {
        let std = spread.std(k);
        std.is_some_and(|std| moved.abs() > MOVED * std)
    })
}
