//! The least-squares problem of recordings with parameters of their own.

use super::{OwnParameter, OwnParameters, is_start};
use crate::fit::options::Options;
use crate::fit::report::Solved;
use crate::fit::sensitivity::{Sensitivity, sensitivity};
use crate::fit::uncertainty::{Uncertainty, effective_samples, residuals, solve};
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::{Data, FitProblem, Horizon, Structure};
use servoid_engine::solve::Objective;

/// Sum of squares.
fn squares(residuals: &[f64]) -> f64 {
    residuals.iter().map(|r| r * r).sum()
}

/// The least-squares problem: the common unknowns, then those of each recording in turn.
pub(super) struct Together<'a> {
    parts: Vec<FitProblem<'a>>,
    structure: Structure,
    /// Whether each unknown of the structure is the recordings' own.
    own: Vec<bool>,
    start: Vec<f64>,
}

impl<'a> Together<'a> {
    pub(super) fn new(
        parts: &'a [Data],
        problem: &FitProblem<'_>,
        structure: Structure,
        start: &[f64],
        options: &Options,
    ) -> Self {
        let part = |data: &'a Data| FitProblem {
            data,
            structure: structure.clone(),
            cost: problem.cost,
            weight: problem.weight,
            horizon: (options.window_s).map_or(Horizon::Whole, |s| Horizon::windows(data, s)),
            start_angle: problem.start_angle,
            method: problem.method,
            start: None,
        };
        let own = (structure.unknowns.iter())
            .map(|unknown| is_start(&unknown.name) || options.own.contains(&unknown.name))
            .collect();
        let mut together = Together {
            parts: parts.iter().map(part).collect(),
            own,
            start: Vec::new(),
            structure,
        };
        together.start = together.spread_out(start);
        together
    }

    /// Where unknown `k` of recording `part` stands among all.
    fn place(&self, part: usize, k: usize) -> usize {
        let own_before = self.own[..k].iter().filter(|&&own| own).count();
        let owns = self.own.iter().filter(|&&own| own).count();
        if self.own[k] {
            self.own.len() - owns + part * owns + own_before
        } else {
            k - own_before
        }
    }

    /// The unknowns of one recording.
    fn of_part(&self, x: &[f64], part: usize) -> Vec<f64> {
        (0..self.own.len())
            .map(|k| x[self.place(part, k)])
            .collect()
    }

    /// A point at which every recording has the unknowns `x`.
    fn spread_out(&self, x: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; self.dim()];
        for part in 0..self.parts.len() {
            for (k, &x) in x.iter().enumerate() {
                all[self.place(part, k)] = x;
            }
        }
        all
    }

    /// What the search found, in the unknowns of the common `problem`.
    pub(super) fn concluded(
        &self,
        problem: &FitProblem<'_>,
        x: &[f64],
    ) -> Option<(Solved, OwnParameters)> {
        let values: Vec<Vec<f64>> = (0..self.parts.len())
            .map(|part| self.structure.values(&self.of_part(x, part)))
            .collect();
        let runs: Option<Vec<Vec<f64>>> = (self.parts.iter().zip(&values))
            .map(|(part, values)| residuals(part, values).ok())
            .collect();
        let runs = runs?;
        let solution = self.solution(&values, &runs, x);
        let std = |part: usize, k: usize| solution.as_ref()?.std(self.place(part, k));
        let own = (values.iter().enumerate())
            .map(|(part, values)| {
                (self.structure.unknowns.iter().enumerate())
                    .filter(|(k, unknown)| self.own[*k] && !is_start(&unknown.name))
                    .map(|(k, unknown)| OwnParameter {
                        name: unknown.name.clone(),
                        value: values[k],
                        unit: problem.data.drive.unit(unknown.unit),
                        std: std(part, k),
                    })
                    .collect()
            })
            .collect();
        let means = self.means(problem);
        let all = self.spread_values(&values);
        let uncertainty = solution.map(|solution| Uncertainty {
            flat: (means.row_iter())
                .map(|row| {
                    let mut shares = row.iter().zip(&solution.flat);
                    shares.any(|(share, &flat)| *share != 0.0 && flat)
                })
                .collect(),
            covariance: &means * solution.finite_covariance() * means.transpose(),
            ..solution
        });
        let all_squares: f64 = runs.iter().map(|run| squares(run)).sum();
        let samples: usize = runs.iter().map(Vec::len).sum();
        let solved = Solved {
            values: (&means * DVector::from_column_slice(&all)).data.into(),
            uncertainty,
            rms_counts: (all_squares / samples as f64).sqrt(),
            reading_noise: None,
        };
        let recordings = OwnParameters {
            own,
            rms_counts: runs
                .iter()
                .map(|run| (squares(run) / run.len().max(1) as f64).sqrt())
                .collect(),
        };
        Some((solved, recordings))
    }

    /// Values of all unknowns, from those of each recording.
    fn spread_values(&self, values: &[Vec<f64>]) -> Vec<f64> {
        let mut all = vec![0.0; self.dim()];
        for (part, values) in values.iter().enumerate() {
            for (k, &value) in values.iter().enumerate() {
                all[self.place(part, k)] = value;
            }
        }
        all
    }

    /// Covariance of all unknowns: the recordings are independent of each other.
    fn solution(&self, values: &[Vec<f64>], runs: &[Vec<f64>], x: &[f64]) -> Option<Uncertainty> {
        let dim = self.dim();
        let mut joint = Sensitivity {
            squares: DMatrix::zeros(dim, dim),
            gradients: Vec::new(),
            redrawn: Vec::new(),
        };
        let many = (self.parts.len() as f64).sqrt();
        for (index, part) in self.parts.iter().enumerate() {
            let found = sensitivity(part, &values[index], &runs[index])?;
            let count = self.own.len();
            for i in 0..count {
                for k in 0..count {
                    joint.squares[(self.place(index, i), self.place(index, k))] +=
                        found.squares[(i, k)];
                }
            }
            let placed = |gradient: &DVector<f64>, factor: f64| {
                let mut all = DVector::zeros(dim);
                for k in 0..count {
                    all[self.place(index, k)] = gradient[k] * factor;
                }
                all
            };
            joint
                .gradients
                .extend(found.gradients.iter().map(|g| placed(g, 1.0)));
            // Their products are averaged over the list, and of independent recordings they add.
            let most = joint.redrawn.len().max(found.redrawn.len());
            joint.redrawn.resize_with(most, Vec::new);
            for (joint, found) in joint.redrawn.iter_mut().zip(&found.redrawn) {
                joint.extend(found.iter().map(|g| placed(g, many)));
            }
        }
        let squares = runs.iter().map(|run| squares(run)).sum();
        let effective = (self.parts.iter().zip(runs))
            .map(|(part, run)| effective_samples(part.data, run))
            .sum();
        Some(solve(&joint, x, squares, effective))
    }

    /// The unknowns of the common `problem` as means over the recordings: a row each, a column for each of all.
    fn means(&self, problem: &FitProblem<'_>) -> DMatrix<f64> {
        let common = &problem.structure.unknowns;
        let mut means = DMatrix::zeros(common.len(), self.dim());
        for (row, unknown) in common.iter().enumerate() {
            let Some(k) = (self.structure.unknowns.iter()).position(|u| u.name == unknown.name)
            else {
                continue;
            };
            // The common model begins as the first recording does.
            let parts = if is_start(&unknown.name) {
                1
            } else {
                self.parts.len()
            };
            for part in 0..parts {
                means[(row, self.place(part, k))] += 1.0 / parts as f64;
            }
        }
        means
    }
}

impl Objective for Together<'_> {
    fn dim(&self) -> usize {
        let owns = self.own.iter().filter(|&&own| own).count();
        self.own.len() - owns + owns * self.parts.len()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        (self.parts.iter().enumerate())
            .map(|(index, part)| part.cost(&self.of_part(x, index)))
            .sum()
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let (mut all, mut sum) = (Vec::new(), 0.0);
        for (index, part) in self.parts.iter().enumerate() {
            let (residuals, cost) = part.residuals_and_cost(&self.of_part(x, index))?;
            all.extend(residuals);
            sum += cost;
        }
        Some((all, sum))
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let mut all: Vec<Option<Vec<f64>>> = vec![Some(Vec::new()); moved.len()];
        for (index, part) in self.parts.iter().enumerate() {
            let here = self.of_part(x, index);
            let there: Vec<Vec<f64>> = moved.iter().map(|x| self.of_part(x, index)).collect();
            let differ: Vec<Vec<f64>> = there.iter().filter(|x| **x != here).cloned().collect();
            let mut changes = part.changes(&here, &differ).into_iter();
            for (column, there) in all.iter_mut().zip(&there) {
                // Another recording's own unknown changes nothing here.
                let change = if *there == here {
                    Some(vec![0.0; part.data.len()])
                } else {
                    changes.next().flatten()
                };
                match (column.as_mut(), change) {
                    (Some(column), Some(change)) => column.extend(change),
                    _ => *column = None,
                }
            }
        }
        all
    }

    fn start(&self) -> Option<Vec<f64>> {
        Some(self.start.clone())
    }
}
