//! A recording and a model with unknowns as a cost over the unit cube, with its residuals.

use super::moments::Moments;
use super::residuals::{centre, errors, is_centred, reading_shift};
use super::structure::Structure;
use super::tangent::TangentBuilder;
use crate::data::Data;
use crate::simulation::{Batch, Candidate, Horizon, Method, Simulation, StartAngle, segments};
use crate::solve::{Compressed, Objective, Tangent};
use shared::cost::Cost;
use shared::error::ModelError;

/// A recording, a model with unknowns, and a cost.
pub struct FitProblem<'a> {
    /// The data.
    pub data: &'a Data,
    /// The unknowns.
    pub structure: Structure,
    /// What is summed.
    pub cost: Cost,
    /// Factor on the sum: the sample interval for an integral, 1 for a plain sum.
    pub weight: f64,
    /// How far the model runs on its own.
    pub horizon: Horizon,
    /// What is known of the start.
    pub start_angle: StartAngle,
    /// How the model is run.
    pub method: Method,
    /// A start from regression, a point of the unit cube.
    pub start: Option<Vec<f64>>,
}

impl<'a> FitProblem<'a> {
    /// The same problem, started at a model, or at the nearest point of the cube.
    pub fn begun_at(&self, candidate: &Candidate) -> FitProblem<'a> {
        let x = self.structure.point(candidate);
        let start = x.into_iter().map(|x| x.clamp(0.0, 1.0)).collect();
        self.with_structure(self.structure.clone(), start)
    }

    /// The same problem with these unknowns, started at the point `start` of their unit cube.
    pub fn with_structure(&self, structure: Structure, start: Vec<f64>) -> FitProblem<'a> {
        FitProblem {
            data: self.data,
            structure,
            cost: self.cost,
            weight: self.weight,
            horizon: self.horizon.clone(),
            start_angle: self.start_angle,
            method: self.method,
            start: Some(start),
        }
    }
}

impl FitProblem<'_> {
    /// Model minus reading, counts, one entry a sample. A correct model lies half a count above a floored reading.
    ///
    /// # Errors
    /// Parameters from which no model can be made.
    pub fn errors(&self, candidate: &Candidate) -> Result<Vec<f64>, ModelError> {
        errors(
            self.data,
            candidate,
            self.method,
            &self.horizon,
            self.start_angle,
            self.cost,
        )
    }

    /// The cost of a model: the weighted sum over the samples; infinite where the model cannot run.
    pub fn cost_of(&self, candidate: &Candidate) -> f64 {
        match self.errors(candidate) {
            Ok(errors) => self.sum(&errors),
            Err(_) => f64::INFINITY,
        }
    }

    /// As [`errors`](Self::errors); `None` where the model cannot run, and once the sum of squares exceeds `limit`.
    fn errors_within(&self, candidate: &Candidate, limit: f64) -> Option<Vec<f64>> {
        let (data, horizon, start_angle) = (self.data, &self.horizon, self.start_angle);
        let simulation = Simulation::new(data, candidate, self.method).ok()?;
        let segments = segments(data, candidate, horizon, start_angle);
        let centred = is_centred(data, candidate, horizon, start_angle);
        let zero = self.zero();
        // The sum of squares about the mean never falls as samples are added.
        let mut moments = Moments::default();
        let too_many = |errors: &[f64]| {
            moments.add(errors);
            let squares = if centred {
                moments.squares_about_mean()
            } else {
                moments.squares_about(zero)
            };
            squares > limit * (1.0 + ROUNDING)
        };
        let mut errors = simulation.errors_unless(horizon.mode(), &segments, too_many)?;
        centre(
            data,
            candidate,
            horizon,
            start_angle,
            self.cost,
            &mut errors,
        );
        Some(errors)
    }

    /// Errors of each of the `others` less those of `here`, counts; `None` for a model that cannot run.
    pub(super) fn changes_of(
        &self,
        here: &Candidate,
        others: &[Candidate],
    ) -> Vec<Option<Vec<f64>>> {
        let (data, horizon, start_angle) = (self.data, &self.horizon, self.start_angle);
        self.batch().changes(
            here,
            others,
            |candidate| segments(data, candidate, horizon, start_angle),
            |candidate, errors| {
                centre(data, candidate, horizon, start_angle, self.cost, errors);
            },
        )
    }

    /// The problem's data and settings for runs in lanes.
    pub(super) fn batch(&self) -> Batch<'_> {
        Batch {
            data: self.data,
            method: self.method,
            mode: self.horizon.mode(),
        }
    }

    /// Whether the start angle of a model is free.
    pub(super) fn is_centred(&self, candidate: &Candidate) -> bool {
        is_centred(self.data, candidate, &self.horizon, self.start_angle)
    }

    /// Where residuals are zero, counts above the reading.
    fn zero(&self) -> f64 {
        shared::encoder::FLOOR_OFFSET_COUNTS - reading_shift(self.data)
    }

    /// Residuals and cost from a model's errors; `None` where one is not finite.
    fn residuals_and_cost_of(&self, mut errors: Vec<f64>) -> Option<(Vec<f64>, f64)> {
        let cost = self.sum(&errors);
        // Residuals are zero where the cost is.
        let zero = match self.cost {
            Cost::Absolute {
                model_floored: false,
            } => 0.0,
            _ => self.data.half_cell(),
        };
        for error in &mut errors {
            *error -= zero;
        }
        errors
            .iter()
            .all(|e| e.is_finite())
            .then_some((errors, cost))
    }

    fn candidate(&self, x: &[f64]) -> Candidate {
        self.structure.candidate_at(x)
    }

    fn sum(&self, errors: &[f64]) -> f64 {
        let shift = reading_shift(self.data);
        let sum: f64 = errors.iter().map(|&e| self.cost.sample(e + shift)).sum();
        if sum.is_nan() {
            f64::INFINITY
        } else {
            sum * self.weight
        }
    }
}

/// Rounding error of a sum of squares, relative to it.
const ROUNDING: f64 = 1e-9;

impl Objective for FitProblem<'_> {
    fn dim(&self) -> usize {
        self.structure.dim()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.cost_of(&self.candidate(x))
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        self.residuals_and_cost_of(self.errors(&self.candidate(x)).ok()?)
    }

    fn residuals_within(&self, x: &[f64], limit: f64) -> Option<(Vec<f64>, f64)> {
        if self.compressed().is_none() {
            return self.residuals_and_cost(x);
        }
        self.residuals_and_cost_of(self.errors_within(&self.candidate(x), limit / self.weight)?)
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let candidates: Vec<Candidate> = moved.iter().map(|x| self.candidate(x)).collect();
        self.changes_of(&self.candidate(x), &candidates)
    }

    fn compressed(&self) -> Option<&dyn Compressed> {
        // One sum of squares knows one start angle.
        let one = !self.data.recordings.are_several();
        (self.cost == Cost::Squared && one).then_some(self)
    }

    fn start(&self) -> Option<Vec<f64>> {
        self.start.clone()
    }
}

impl Compressed for FitProblem<'_> {
    fn squares_and_cost(&self, x: &[f64]) -> Option<(f64, f64)> {
        let candidate = &self.candidate(x);
        let (data, horizon, start_angle) = (self.data, &self.horizon, self.start_angle);
        let simulation = Simulation::new(data, candidate, self.method).ok()?;
        let segments = segments(data, candidate, horizon, start_angle);
        let mut moments = Moments::default();
        simulation.stream(horizon.mode(), &segments, |errors| moments.add(errors));
        let squares = if is_centred(data, candidate, horizon, start_angle) {
            moments.squares_about_mean()
        } else {
            moments.squares_about(self.zero())
        };
        squares
            .is_finite()
            .then_some((squares, squares * self.weight))
    }

    fn tangent(&self, x: &[f64], moved: &[Vec<f64>]) -> Option<Tangent> {
        let here = self.candidate(x);
        let others: Vec<Candidate> = moved.iter().map(|x| self.candidate(x)).collect();
        let (horizon, start_angle) = (&self.horizon, self.start_angle);
        let centred = self.is_centred(&here);
        let segments = |candidate: &Candidate| segments(self.data, candidate, horizon, start_angle);
        let mut builder = TangentBuilder::new(moved.len(), (!centred).then(|| self.zero()));
        if self
            .batch()
            .stream(&here, &others, segments, |here, changes| {
                builder.add(here, changes);
            })
            && let Some(tangent) = builder.finish()
        {
            return Some(tangent);
        }
        // One by one: some may be impossible.
        let (residuals, _) = self.residuals_and_cost(x)?;
        let nothing = vec![0.0; residuals.len()];
        let changes = self.changes(x, moved);
        let columns: Vec<&[f64]> = changes
            .iter()
            .map(|change| change.as_ref().map_or(&nothing[..], |change| change))
            .collect();
        // Residuals are about their zero already.
        let mut builder = TangentBuilder::new(moved.len(), Some(0.0));
        builder.add(&residuals, &columns);
        let mut tangent = builder.finish()?;
        tangent.possible = changes.iter().map(Option::is_some).collect();
        Some(tangent)
    }
}
