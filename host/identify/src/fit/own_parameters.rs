//! Recordings of one motor with parameters of their own beside the common ones: another amplifier's offset, another logger's
//! delay, a warmer winding. One least-squares fit has the common unknowns once and the others once a recording.

use super::options::Options;
use super::recordings::standard_deviation;
use super::report::{Fit, Solved};
use super::sensitivity::{Sensitivity, sensitivity};
use super::uncertainty::{Uncertainty, effective_samples, solve};
use crate::error::Error;
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::{
    Candidate, Data, FitProblem, Horizon, START_OFFSET, START_SPEED, Structure,
};
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use servoid_engine::solve::{Evaluator, Found, Objective, Solver};
use servoid_io::input::suggest::did_you_mean;
use shared::cost::Cost;
use std::sync::atomic::AtomicBool;

/// A parameter that one recording has for itself.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnParameter {
    /// Name, as among the fit's parameters.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// Unit symbol.
    pub unit: &'static str,
    /// Standard error; `None` where the recording does not determine it.
    pub std: Option<f64>,
}

/// Recordings that were fitted together, with parameters of their own.
pub struct OwnFit {
    /// Where the search ended; of what the recordings have for themselves, the mean.
    pub found: Found,
    /// The common model's unknowns there.
    pub solved: Solved,
    /// What each recording has for itself.
    pub recordings: OwnParameters,
}

/// What each recording has for itself.
pub struct OwnParameters {
    /// A list for each recording.
    own: Vec<Vec<OwnParameter>>,
    /// RMS error of each recording, counts.
    rms_counts: Vec<f64>,
}

impl OwnParameters {
    /// Writes each recording's parameters and error into a `fit` of the common model, and how far the recordings differ.
    pub fn write_into(&self, fit: &mut Fit) {
        let fitted = fit.recordings.iter_mut().filter(|one| !one.held_out);
        for ((recording, own), rms) in fitted.zip(&self.own).zip(&self.rms_counts) {
            recording.own.clone_from(own);
            recording.rms_counts = *rms;
        }
        for (k, own) in self.own.first().into_iter().flatten().enumerate() {
            let values: Vec<f64> = self.own.iter().map(|all| all[k].value).collect();
            let named = fit.parameters.iter_mut().filter(|p| p.name == own.name);
            for parameter in named.filter(|p| p.unit == own.unit) {
                parameter.spread = Some(standard_deviation(&values));
            }
        }
        let names: Vec<&str> = (self.own.first().into_iter().flatten())
            .map(|own| own.name.as_str())
            .collect();
        fit.notes.insert(0, format!(
            "each recording has its own {}: the value among the parameters is their mean, which every held-out recording is \
             predicted with",
            names.join(" and ")
        ));
    }
}

/// Refuses what cannot be searched for in each recording.
///
/// # Errors
/// [`Error::Usage`] for one recording, for another cost than squares, and for a name that is no unknown of the model.
pub fn check(problem: &FitProblem<'_>, options: &Options) -> Result<(), Error> {
    let Some(first) = options.own.first() else {
        return Ok(());
    };
    if !problem.data.recordings.are_several() {
        return Err(Error::Usage(format!(
            "--own {first}: with one recording every parameter is its own; give several recordings of the motor"
        )));
    }
    if problem.cost != Cost::Squared {
        return Err(Error::Usage(format!(
            "--own {first}: parameters of each recording are fitted by least squares; leave out --cost"
        )));
    }
    let names: Vec<&str> = (problem.structure.unknowns.iter())
        .map(|unknown| unknown.name.as_str())
        .filter(|name| !is_start(name))
        .collect();
    for name in &options.own {
        if !names.contains(&name.as_str()) {
            return Err(Error::Usage(format!(
                "--own {name}: not an unknown of this model; {}",
                did_you_mean(name, &names)
            )));
        }
    }
    Ok(())
}

/// Fits the recordings of `problem` from where the search for common unknowns ended.
///
/// # Errors
/// [`Error::Failed`] where the model cannot run along one of the recordings.
pub fn fit_own(
    problem: &FitProblem<'_>,
    common: &Found,
    options: &Options,
    stop: &AtomicBool,
) -> Result<OwnFit, Error> {
    let parts: Vec<Data> = problem.data.parts().collect();
    let candidate = problem.structure.candidate_at(&common.x);
    let structure = structure(problem, &candidate, &parts);
    let start = structure.coordinates(&values_with_start(problem, &structure, &candidate));
    let together = Together::new(&parts, problem, structure, &start, options);
    let mut observer = |_, _| ();
    let mut evaluator = Evaluator::new(&together, options.budget, stop, &mut observer);
    LevenbergMarquardt::default().search(&mut evaluator, options.seed);
    let found = evaluator.finish();
    let (solved, recordings) = together.concluded(problem, &found.x).ok_or_else(|| {
        Error::Failed(format!(
            "--own {}: the model cannot run along one of the recordings with it; fit that recording alone to see why",
            options.own.join(",")
        ))
    })?;
    Ok(OwnFit {
        found: Found {
            x: problem.structure.coordinates(&solved.values),
            evaluations: common.evaluations + found.evaluations,
            interrupted: common.interrupted || found.interrupted,
            ..found
        },
        solved,
        recordings,
    })
}

/// Whether an unknown describes the begin of a recording, which each has for itself anyway.
fn is_start(name: &str) -> bool {
    name == START_SPEED || name == START_OFFSET
}

/// The unknowns of the common fit, and the speed at the first sample where a recording may start in motion.
fn structure(problem: &FitProblem<'_>, candidate: &Candidate, parts: &[Data]) -> Structure {
    let common = &problem.structure;
    let windows = matches!(problem.horizon, Horizon::Windows(_));
    let moving = !windows && parts.iter().any(|part| part.may_start_moving(0));
    let mut structure = Structure::around(
        problem.data,
        common.base,
        &common.effects,
        &candidate.machine,
        moving || common.start_speed,
    );
    for unknown in &mut structure.unknowns {
        if let Some(known) = common.unknowns.iter().find(|u| u.name == unknown.name) {
            unknown.clone_from(known);
        }
    }
    structure
}

/// The values of `candidate`, which has the unknowns of the common fit, in those of `structure`.
fn values_with_start(
    problem: &FitProblem<'_>,
    structure: &Structure,
    candidate: &Candidate,
) -> Vec<f64> {
    let common = &problem.structure;
    let values = common.values(&common.point(candidate));
    let of_common = |name: &str| {
        let at = common.unknowns.iter().position(|u| u.name == name)?;
        values.get(at).copied()
    };
    (structure.unknowns.iter())
        .map(|unknown| of_common(&unknown.name).unwrap_or(0.0))
        .collect()
}

/// Errors of one recording's model from the centres of the cells, counts.
struct Run {
    residuals: Vec<f64>,
}

impl Run {
    /// `None` where the model cannot run.
    fn of(part: &FitProblem<'_>, values: &[f64]) -> Option<Self> {
        let mut residuals = part.errors(&part.structure.candidate(values)).ok()?;
        let centre = part.data.centre(0) - part.data.counts[0];
        for residual in &mut residuals {
            *residual -= centre;
        }
        Some(Run { residuals })
    }

    fn squares(&self) -> f64 {
        self.residuals.iter().map(|r| r * r).sum()
    }

    fn rms(&self) -> f64 {
        (self.squares() / self.residuals.len().max(1) as f64).sqrt()
    }
}

/// The least-squares problem: the common unknowns, then those of each recording in turn.
struct Together<'a> {
    parts: Vec<FitProblem<'a>>,
    structure: Structure,
    /// Whether each unknown of the structure is the recordings' own.
    own: Vec<bool>,
    start: Vec<f64>,
}

impl<'a> Together<'a> {
    fn new(
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
    fn concluded(&self, problem: &FitProblem<'_>, x: &[f64]) -> Option<(Solved, OwnParameters)> {
        let values: Vec<Vec<f64>> = (0..self.parts.len())
            .map(|part| self.structure.values(&self.of_part(x, part)))
            .collect();
        let runs: Option<Vec<Run>> = (self.parts.iter().zip(&values))
            .map(|(part, values)| Run::of(part, values))
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
                        unit: unknown.unit,
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
        let squares: f64 = runs.iter().map(Run::squares).sum();
        let samples: usize = runs.iter().map(|run| run.residuals.len()).sum();
        let solved = Solved {
            values: (&means * DVector::from_column_slice(&all)).data.into(),
            uncertainty,
            rms_counts: (squares / samples as f64).sqrt(),
        };
        let recordings = OwnParameters {
            own,
            rms_counts: runs.iter().map(Run::rms).collect(),
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
    fn solution(&self, values: &[Vec<f64>], runs: &[Run], x: &[f64]) -> Option<Uncertainty> {
        let dim = self.dim();
        let mut joint = Sensitivity {
            squares: DMatrix::zeros(dim, dim),
            gradients: Vec::new(),
            roundings: Vec::new(),
        };
        let many = (self.parts.len() as f64).sqrt();
        for (index, part) in self.parts.iter().enumerate() {
            let found = sensitivity(part, &values[index], &runs[index].residuals)?;
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
            joint
                .roundings
                .extend(found.roundings.iter().map(|g| placed(g, many)));
        }
        let squares = runs.iter().map(Run::squares).sum();
        let effective = (self.parts.iter().zip(runs))
            .map(|(part, run)| effective_samples(part.data, &run.residuals))
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
