//! The likelihood of a quantised reading: the probability that the model's angle, with normal noise before the counter, lies in the
//! cell that was read.
//!
//! Least squares take a reading for the centre of its cell, as if rounding were noise. It is none: a reading says for certain that
//! the angle was within a cell, and near an edge that it was within the noise of it. Where the noise is small, almost all that a
//! recording knows is in the readings near edges. What is minimised is `−Σ ln P(cell)` over the unknowns, the start angle of each
//! recording where it is free, and the noise `σ`, by Newton's steps with Levenberg's damping: `−ln P` is convex in the angle. Standard
//! errors are from its own curvature, and in no direction below the sandwich over time segments.
//!
//! The noise is a meter of misfit as well: a right model of a clean encoder leaves nothing, and whatever else is wrong, down to
//! hundredths of a count, is noise here.
//!
//! Sources: F. Gustafsson and R. Karlsson, *Automatica* 45(12), 2794, 2009 (identification from quantised readings); J. W. Pratt,
//! *J. Am. Stat. Assoc.* 76, 103, 1981 (the likelihood of grouped data is concave).
//!
//! When it fails: with a misfit that is not white over time, as every likelihood of independent readings; the noise is then
//! large, and a fit with process noise ([`crate::likelihood`]) the better one.

mod cell;
mod information;

use super::options::Options;
use super::report::Solved;
use super::sensitivity::columns;
use super::uncertainty::{self, Uncertainty};
use crate::error::Error;
use crate::identify::LEAST_SQUARES;
use cell::Cell;
use information::{Information, Shifts};
use nalgebra::DVector;
use servoid_engine::problem::{FitProblem, Horizon, rms_counts};
use servoid_engine::solve::Found;
use shared::cost::Cost;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::sync::atomic::{AtomicBool, Ordering};

/// Noise is not followed below this, counts: the arithmetic of a stepped model and the clock of a bench are no better.
pub const LEAST_NOISE: f64 = 1e-3;
/// Most steps.
const STEPS: usize = 100;
/// Dampings that are tried from one point.
const TRIALS: usize = 12;
/// A step that promises less than this of the logarithm of the likelihood ends the search: a hundredth of a standard error.
const LEFT: f64 = 1e-4;
/// Largest change of the noise in one step, a factor's logarithm: it leads the unknowns, and must not outrun them.
const NOISE_STEP: f64 = 0.7;

/// The noise before the counter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadingNoise {
    /// Standard deviation, counts.
    pub counts: f64,
    /// Its standard error, counts; `None` where it stands at the least that is followed, [`LEAST_NOISE`].
    pub std: Option<f64>,
}

/// Whether the options ask for this likelihood where it can be maximised: least squares begin, readings are whole counts, and the
/// model runs on its own all along.
pub fn applies(problem: &FitProblem<'_>, options: &Options) -> bool {
    matches!(options.cost, Cost::Interval { .. })
        && options.algorithm == LEAST_SQUARES
        && problem.data.quantised
        && problem.horizon == Horizon::Whole
}

/// What a user should know where the options ask for this likelihood and its noise cannot be found.
pub fn note(problem: &FitProblem<'_>, options: &Options) -> Option<String> {
    let Cost::Interval { noise_counts } = options.cost else {
        return None;
    };
    let why = if options.algorithm != LEAST_SQUARES {
        "which only --algorithm lm estimates"
    } else if !problem.data.quantised {
        "since the angle is no whole count"
    } else if problem.horizon != Horizon::Whole {
        "which is not estimated with --window"
    } else {
        return None;
    };
    Some(format!(
        "the noise before the counter is taken as {noise_counts} counts, {why}"
    ))
}

/// The most likely model from where least squares ended, and the search that has found it.
///
/// # Errors
/// Where no model runs.
pub fn most_likely(
    problem: &FitProblem<'_>,
    found: &Found,
    stop: &AtomicBool,
) -> Result<(Found, Solved), Error> {
    let mut search = Search {
        problem,
        stop,
        evaluations: 0,
    };
    let start = search
        .begin(problem.structure.values(&found.x))
        .ok_or_else(|| Error::Failed(format!("{}: the model cannot run", problem.data.source)))?;
    let (end, information) = search.descend(start);
    let evaluations = found.evaluations + search.evaluations;
    let found = Found {
        x: problem.structure.coordinates(&end.values),
        cost: end.surprise,
        evaluations,
        curve: vec![(evaluations, end.surprise)],
        interrupted: found.interrupted || stop.load(Ordering::Relaxed),
    };
    let solved = Solved {
        rms_counts: rms_counts(problem.data, &end.errors),
        uncertainty: information
            .as_ref()
            .map(|information| end.uncertainty(problem, information)),
        reading_noise: Some(end.noise(information.as_ref())),
        values: end.values,
    };
    Ok((found, solved))
}

/// A point of the search.
struct Point {
    /// Values of the unknowns.
    values: Vec<f64>,
    /// The model above the lower edges of the cells, counts, shifted.
    errors: Vec<f64>,
    /// Shift of each recording, counts.
    shifts: Vec<f64>,
    /// Noise, counts.
    noise: f64,
    /// −Σ ln P.
    surprise: f64,
}

struct Search<'p, 'a> {
    problem: &'p FitProblem<'a>,
    stop: &'p AtomicBool,
    evaluations: usize,
}

impl Search<'_, '_> {
    fn begin(&mut self, values: Vec<f64>) -> Option<Point> {
        let count = self.problem.data.recordings.count();
        let mut start = self.at(values, vec![0.0; count], 1.0)?;
        let beyond =
            rms_counts(self.problem.data, &start.errors).powi(2) - FLOOR_RMS_COUNTS.powi(2);
        start.noise = beyond.max(0.0).sqrt().max(FLOOR_RMS_COUNTS);
        start.surprise = surprise(&start.errors, start.noise);
        Some(start)
    }

    /// `None` where the model cannot run.
    fn at(&mut self, values: Vec<f64>, shifts: Vec<f64>, noise: f64) -> Option<Point> {
        self.evaluations += 1;
        let candidate = self.problem.structure.candidate(&values);
        let mut errors = self.problem.errors(&candidate).ok()?;
        for (range, shift) in self.problem.data.recordings.ranges().zip(&shifts) {
            for error in &mut errors[range] {
                *error += shift;
            }
        }
        let surprise = surprise(&errors, noise);
        surprise.is_finite().then_some(Point {
            values,
            errors,
            shifts,
            noise,
            surprise,
        })
    }

    /// Goes down from a point. With what the readings know there; `None` where a model beside it cannot run.
    fn descend(&mut self, mut here: Point) -> (Point, Option<Information>) {
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let Some(information) = self.information(&here) else {
                return (here, None);
            };
            if self.stop.load(Ordering::Relaxed) {
                return (here, Some(information));
            }
            let mut next = None;
            for _ in 0..TRIALS {
                let Some((step, promised)) = information.step(damping) else {
                    damping = (10.0 * damping).max(1e-6);
                    continue;
                };
                if promised < LEFT && damping <= 1.0 {
                    break;
                }
                let moved = self.moved(&here, &step, &information.shifts);
                if let Some(moved) = moved.filter(|moved| moved.surprise < here.surprise) {
                    next = Some(moved);
                    break;
                }
                damping = (10.0 * damping).max(1e-6);
            }
            let Some(next) = next else {
                return (here, Some(information));
            };
            here = next;
            damping *= 0.1;
        }
        let information = self.information(&here);
        (here, information)
    }

    fn moved(&mut self, here: &Point, step: &DVector<f64>, free: &Shifts) -> Option<Point> {
        let unknowns = &self.problem.structure.unknowns;
        let values = (here.values.iter().zip(unknowns).zip(step.iter()))
            .map(|((value, unknown), step)| (value + step).clamp(unknown.range.0, unknown.range.1))
            .collect();
        let mut shifts = here.shifts.clone();
        for (recording, shift) in shifts.iter_mut().enumerate() {
            if let Some(place) = free.place(recording) {
                *shift += step[unknowns.len() + place];
            }
        }
        let louder = step[step.len() - 1].clamp(-NOISE_STEP, NOISE_STEP);
        let noise = (here.noise * libm::exp(louder)).max(LEAST_NOISE);
        self.at(values, shifts, noise)
    }

    fn information(&mut self, here: &Point) -> Option<Information> {
        let problem = self.problem;
        self.evaluations += 3 * here.values.len();
        let shifts = Shifts::of(problem, &here.values);
        let mut information = Information::new(shifts, here.values.len(), problem.data.len());
        let mut from = 0;
        columns(problem, &here.values, |columns| {
            let to = from + columns.first().map_or(0, Vec::len);
            let cells: Vec<Cell> = (here.errors[from..to].iter())
                .map(|error| Cell::at(*error, here.noise))
                .collect();
            information.add(problem, from, columns, &cells);
            from = to;
        })?;
        information.hold(&problem.structure, &here.values, here.noise <= LEAST_NOISE);
        information.is_finite().then_some(information)
    }
}

fn surprise(errors: &[f64], noise: f64) -> f64 {
    errors
        .iter()
        .map(|error| Cell::at(*error, noise).surprise)
        .sum()
}

impl Point {
    /// Of the unknowns alone; shifts and noise are estimated with them.
    fn uncertainty(&self, problem: &FitProblem<'_>, information: &Information) -> Uncertainty {
        let centre = problem.data.half_cell();
        let residuals: Vec<f64> = self.errors.iter().map(|error| error - centre).collect();
        let effective = uncertainty::effective_samples(problem.data, &residuals);
        let all = information.uncertainty(effective);
        let unknowns = self.values.len();
        Uncertainty {
            covariance: all
                .covariance
                .view((0, 0), (unknowns, unknowns))
                .into_owned(),
            flat: all.flat[..unknowns].to_vec(),
            ..all
        }
    }

    fn noise(&self, information: Option<&Information>) -> ReadingNoise {
        let std = information
            .filter(|_| self.noise > LEAST_NOISE)
            .and_then(|information| {
                let all = information.uncertainty(1.0);
                all.std(all.flat.len() - 1)
            });
        ReadingNoise {
            counts: self.noise,
            std: std.map(|std| std * self.noise),
        }
    }
}
