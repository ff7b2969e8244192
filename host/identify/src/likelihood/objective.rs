//! Minus the logarithm of the likelihood of the innovations, with Huber's loss beyond four standard deviations.

use super::huber::huber;
use super::kalman::{Innovations, innovations};
use super::observed::Observed;
use super::parameters::{Coordinate, Parameters};
use std::sync::Arc;

/// Standard deviation of the prior on the offset, part of the largest command. It is weak: it keeps Coulomb friction and offset
/// from running away along their sum where the motor turns one way.
const OFFSET_PRIOR: f64 = 0.03;
/// The same for Coulomb friction. A step of one level shows inertia, damping and what is left of the command only by their ratios.
const COULOMB_PRIOR: f64 = 0.2;

/// Recordings with the readings that are used.
#[derive(Clone, Debug)]
pub(super) struct Objective<'a> {
    recordings: Vec<(&'a Observed, Vec<usize>)>,
    largest: f64,
}

/// A model with what the filter says of it.
#[derive(Clone, Debug)]
pub(super) struct Evaluated {
    pub(super) parameters: Parameters,
    /// Means of the command by recording, with the delay that they have.
    inputs: Vec<(f64, Arc<Vec<f64>>)>,
    pub(super) innovations: Vec<Innovations>,
    /// Minus the logarithm of the likelihood.
    pub(super) cost: f64,
    /// The same with the prior, which is minimised.
    pub(super) posterior: f64,
}

impl<'a> Objective<'a> {
    pub(super) fn new(recordings: &[&'a Observed], update_s: f64) -> Self {
        let largest = recordings
            .iter()
            .fold(0.0f64, |most, r| most.max(r.largest));
        Objective {
            recordings: recordings.iter().map(|&r| (r, r.used(update_s))).collect(),
            largest,
        }
    }

    /// Readings that are predicted.
    pub(super) fn count(&self) -> usize {
        self.recordings.iter().map(|(_, used)| used.len()).sum()
    }

    /// The recording and the time of each innovation, in the innovations' order.
    pub(super) fn times(&self) -> impl Iterator<Item = (usize, f64)> {
        (self.recordings.iter().enumerate())
            .flat_map(|(k, (r, used))| used.iter().map(move |&at| (k, r.time_s[at])))
    }

    /// Curvature of the prior on a number, SI; nothing where it has none.
    pub(super) fn prior_weight(&self, c: Coordinate) -> f64 {
        match c {
            Coordinate::Offset => (OFFSET_PRIOR * self.largest).powi(-2),
            Coordinate::Coulomb => (COULOMB_PRIOR * self.largest).powi(-2),
            _ => 0.0,
        }
    }

    /// `near` has inputs that are taken where the delay is the same.
    pub(super) fn at(&self, parameters: Parameters, near: Option<&Evaluated>) -> Evaluated {
        let mut inputs = Vec::with_capacity(self.recordings.len());
        let mut all = Vec::with_capacity(self.recordings.len());
        let mut cost = 0.0;
        for (k, (observed, used)) in self.recordings.iter().enumerate() {
            let delay = parameters.delays.get(k).copied().unwrap_or(0.0);
            let known = near
                .map(|near| &near.inputs[k])
                .filter(|(at, _)| *at == delay);
            let (_, volts) = known.cloned().unwrap_or_else(|| {
                (
                    delay,
                    Arc::new(observed.command.means(&observed.time_s, delay)),
                )
            });
            let found = innovations(observed, used, &volts, &parameters);
            cost += minus_log_likelihood(&found);
            inputs.push((delay, volts));
            all.push(found);
        }
        let prior = [Coordinate::Offset, Coordinate::Coulomb]
            .map(|c| 0.5 * c.get(&parameters).powi(2) * self.prior_weight(c));
        Evaluated {
            parameters,
            inputs,
            innovations: all,
            cost,
            posterior: cost + prior.iter().sum::<f64>(),
        }
    }
}

impl Evaluated {
    /// Innovations and variances of all recordings.
    pub(super) fn each(&self) -> impl Iterator<Item = (f64, f64)> {
        (self.innovations.iter())
            .flat_map(|i| i.errors.iter().copied().zip(i.variances.iter().copied()))
    }
}

fn minus_log_likelihood(innovations: &Innovations) -> f64 {
    let each = innovations.errors.iter().zip(&innovations.variances);
    each.map(|(error, variance)| {
        let square = error * error / variance;
        let loss = huber(square);
        0.5 * (loss + libm::log(std::f64::consts::TAU * variance))
    })
    .sum()
}
