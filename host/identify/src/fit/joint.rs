//! The unknowns of a search with their covariance: what a fit says of all of them together.

use super::uncertainty::Uncertainty;
use servoid_engine::problem::FitProblem;

/// Unknowns that the data determine, as the search has them: torques in volts at the winding.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Joint {
    /// Their names.
    pub names: Vec<String>,
    /// Their units.
    pub units: Vec<&'static str>,
    /// Their values.
    pub values: Vec<f64>,
    /// A row and a column for each, in the product of their units.
    pub covariance: Vec<Vec<f64>>,
}

impl Joint {
    /// Of the unknowns that have a standard error. None where there is none of these.
    pub(super) fn of(
        problem: &FitProblem<'_>,
        values: &[f64],
        spread: Option<&Uncertainty>,
    ) -> Option<Self> {
        let spread = spread?;
        let unknowns = &problem.structure.unknowns;
        let own: Vec<usize> = (0..unknowns.len().min(spread.covariance.nrows()))
            .filter(|&k| {
                let unknown = &unknowns[k];
                !unknown.whole && !unknown.ends_at(values[k]) && spread.std(k).is_some()
            })
            .collect();
        let row = |j: &usize| own.iter().map(|&k| spread.covariance[(*j, k)]).collect();
        let joint = Joint {
            names: own.iter().map(|&k| unknowns[k].name.clone()).collect(),
            units: own
                .iter()
                .map(|&k| problem.data.drive.unit(unknowns[k].unit))
                .collect(),
            values: own.iter().map(|&k| values[k]).collect(),
            covariance: own.iter().map(row).collect(),
        };
        let finite = joint
            .covariance
            .iter()
            .flatten()
            .all(|entry| entry.is_finite());
        (finite && !joint.names.is_empty()).then_some(joint)
    }
}
