//! The innovations of a model as a least-squares problem.

use super::gains::Filter;
use super::readings::Readings;
use super::settings::PRIOR_SD;
use crate::likelihood::huber;
use servoid_engine::problem::{FitProblem, Horizon, StartAngle, Structure};
use servoid_engine::simulation::Method;
use servoid_engine::solve::Objective;
use shared::cost::Cost;
use shared::motor::Machine;

/// What is known of the machine before: its gain and time constant, or inertia where a current loop drives it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Prior {
    /// The machine about which it lies.
    pub about: Machine<f64>,
}

impl Prior {
    /// Distance from it in standard deviations, one entry a number that it knows.
    pub fn distances(&self, structure: &Structure, values: &[f64]) -> Vec<f64> {
        let response = self.about.response();
        let numbers = [
            ("gain", response.gain),
            ("a1", response.a1),
            ("inertia", self.about.inertia),
        ];
        let unknowns = structure.unknowns.iter().zip(values);
        unknowns
            .filter_map(|(unknown, value)| {
                let (_, about) = numbers.iter().find(|(name, _)| *name == unknown.name)?;
                let distance = libm::log(value / about) / PRIOR_SD;
                distance.is_finite().then_some(distance)
            })
            .collect()
    }
}

/// Innovations over their standard deviations, one residual a reading, and the prior's distances behind them. Half their sum
/// of squares is minus the logarithm of the posterior, nats, up to a constant of the filter.
pub struct Innovations<'a> {
    readings: &'a Readings<'a>,
    filter: &'a Filter,
    prior: Prior,
    problem: FitProblem<'a>,
}

impl<'a> Innovations<'a> {
    /// The problem of the unknowns of `structure`.
    pub fn new(
        readings: &'a Readings<'a>,
        filter: &'a Filter,
        prior: Prior,
        structure: Structure,
        method: Method,
    ) -> Self {
        Innovations {
            readings,
            filter,
            prior,
            problem: FitProblem {
                data: readings.data,
                structure,
                cost: Cost::Squared,
                weight: 1.0,
                horizon: Horizon::Corrected(filter.corrections.clone()),
                start_angle: StartAngle::Free,
                method,
                start: None,
            },
        }
    }

    /// Weighted residuals from model minus measured angle at every sample.
    fn weighted(&self, errors: &[f64]) -> Vec<f64> {
        let readings = self.readings;
        let each = readings.samples.iter().zip(&readings.weights);
        each.zip(&self.filter.variances)
            .map(|((&sample, weight), variance)| {
                let error = errors[sample];
                let size = (weight * huber(error * error / variance)).sqrt();
                size.copysign(error)
            })
            .collect()
    }

    fn distances(&self, x: &[f64]) -> Vec<f64> {
        let structure = &self.problem.structure;
        self.prior.distances(structure, &structure.values(x))
    }

    fn residuals(&self, x: &[f64], errors: &[f64]) -> Vec<f64> {
        let mut residuals = self.weighted(errors);
        residuals.extend(self.distances(x));
        residuals
    }
}

impl Objective for Innovations<'_> {
    fn dim(&self) -> usize {
        self.problem.dim()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.residuals_and_cost(x)
            .map_or(f64::INFINITY, |(_, cost)| cost)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let (errors, _) = self.problem.residuals_and_cost(x)?;
        let residuals = self.residuals(x, &errors);
        let cost: f64 = residuals.iter().map(|r| r * r).sum();
        cost.is_finite().then_some((residuals, cost))
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        let Some((errors, _)) = self.problem.residuals_and_cost(x) else {
            return vec![None; moved.len()];
        };
        let here = self.residuals(x, &errors);
        let changes = self.problem.changes(x, moved);
        let change = |(change, x): (Option<Vec<f64>>, &Vec<f64>)| {
            let there: Vec<f64> = change?.iter().zip(&errors).map(|(c, e)| c + e).collect();
            let there = self.residuals(x, &there);
            Some(there.iter().zip(&here).map(|(t, h)| t - h).collect())
        };
        changes.into_iter().zip(moved).map(change).collect()
    }
}
