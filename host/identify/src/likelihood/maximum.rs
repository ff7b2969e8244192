//! The fit of one or several recordings: their likelihoods add up, each with its own start, and with a delay each or a common one.

use super::errors::{Errors, errors};
use super::objective::{Evaluated, Objective};
use super::observed::Observed;
use super::parameters::{Coordinate, Parameters, Scale};
use super::scoring::{Effort, descend};
use super::slopes::Differences;
use super::start::starts;
use super::terms::{Delays, Terms};
use super::whiteness::{Whiteness, whiteness};
use nalgebra::DVector;
use std::sync::atomic::AtomicBool;

/// Standard deviations to each side of a 95 % interval.
const NORMAL_95: f64 = 1.96;
/// Starts that are followed to the end.
const FOLLOWED: usize = 2;
/// Iterations by which starts are told apart, the delay held.
const TASTED: usize = 2;
/// Coulomb friction, part of the found one, from which the search starts once more: where a motor reverses, whether it rests for
/// a moment makes corners and small hollows in the likelihood.
const FRICTIONS: [f64; 5] = [0.5, 0.8, 1.2, 2.0, 4.0];
/// A standard error larger than this many times the number says that it is not determined.
const UNDETERMINED: f64 = 10.0;
/// Least readings to a coordinate.
const LEAST_READINGS: usize = 4;

/// How to fit.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Least time between readings that are used, s. At 1 kHz, single steps would follow the logger's jitter.
    pub update_s: f64,
    /// Whether recordings share their delay.
    pub delays: Delays,
    /// Most iterations.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Settings {
            update_s: 0.01,
            delays: Delays::Each,
            iterations: 60,
        }
    }
}

/// The most likely model.
#[derive(Clone, Debug)]
pub struct Maximum {
    /// Its numbers.
    pub parameters: Parameters,
    /// Its terms.
    pub terms: Terms,
    /// Readings that were predicted.
    pub readings: usize,
    /// Logarithm of the likelihood.
    pub log_likelihood: f64,
    /// Bayesian information criterion (G. Schwarz, *Ann. Statist.* 6, 461, 1978): minus twice the logarithm of the likelihood,
    /// and the logarithm of the readings for each number that was fitted.
    pub bic: f64,
    /// Whether the search converged.
    pub converged: bool,
    /// Whether the innovations are white.
    pub whiteness: Option<Whiteness>,
    coordinates: Vec<Coordinate>,
    errors: Option<Errors>,
    /// Standard deviation of each recording's delay that comes from the log's ticks, s.
    timing_errors_s: Vec<f64>,
}

/// Fits the `terms` to the recordings. `None` where they move too little for a motor, or where `stop` came before any result.
pub fn fit(
    recordings: &[&Observed],
    terms: Terms,
    settings: &Settings,
    stop: &AtomicBool,
) -> Option<Maximum> {
    fit_from(recordings, terms, settings, &[], stop)
}

/// As [`fit`], started also from models that the caller knows; terms that the model has not are set to zero.
pub fn fit_from(
    recordings: &[&Observed],
    terms: Terms,
    settings: &Settings,
    known: &[Parameters],
    stop: &AtomicBool,
) -> Option<Maximum> {
    let objective = Objective::new(recordings, settings.update_s);
    let coordinates = Coordinate::all(terms, settings.delays, recordings.len());
    if objective.count() < LEAST_READINGS * coordinates.len() {
        return None;
    }
    let mut begun: Vec<Evaluated> = starts(recordings, terms)
        .into_iter()
        .filter_map(|p| tasted(&objective, p, &coordinates, recordings, stop))
        .collect();
    let known = known.iter().map(|p| restricted(p, terms, recordings.len()));
    begun.extend(
        known
            .map(|p| objective.at(p, None))
            .filter(|e| e.posterior.is_finite()),
    );
    begun.sort_by(|a, b| a.posterior.total_cmp(&b.posterior));
    begun.truncate(FOLLOWED);
    let effort = Effort {
        iterations: settings.iterations,
        differences: Differences::COARSE,
    };
    let follow = |start: Evaluated, effort: Effort| {
        let scaled = scaled(&coordinates, &start.parameters, recordings);
        descend(&objective, start, &scaled, effort, stop)
    };
    let least = |a: &Evaluated, b: &Evaluated| a.posterior.total_cmp(&b.posterior);
    let mut best = (begun.into_iter())
        .map(|start| follow(start, effort).0)
        .min_by(least)?;
    if terms.coulomb {
        for part in FRICTIONS {
            let mut p = best.parameters.clone();
            p.coulomb *= part;
            let other = follow(objective.at(p, Some(&best)), effort).0;
            if other.posterior < best.posterior {
                best = other;
            }
        }
    }
    let effort = Effort {
        differences: Differences::FINE,
        ..effort
    };
    let (best, converged) = follow(best, effort);
    let near = scaled(&coordinates, &best.parameters, recordings);
    let errors = errors(&objective, &best, &near);
    let readings = objective.count();
    best.cost.is_finite().then(|| Maximum {
        terms,
        readings,
        log_likelihood: -best.cost,
        bic: 2.0 * best.cost + coordinates.len() as f64 * libm::log(readings as f64),
        converged: converged && errors.is_some(),
        whiteness: whiteness(&best),
        coordinates,
        errors,
        timing_errors_s: recordings.iter().map(|r| r.timing_error_s()).collect(),
        parameters: best.parameters,
    })
}

/// A start after a few iterations at its delay.
fn tasted(
    objective: &Objective<'_>,
    p: Parameters,
    coordinates: &[Coordinate],
    recordings: &[&Observed],
    stop: &AtomicBool,
) -> Option<Evaluated> {
    let start = objective.at(p, None);
    if !start.posterior.is_finite() {
        return None;
    }
    let held: Vec<Coordinate> = coordinates
        .iter()
        .copied()
        .filter(|c| !c.is_delay())
        .collect();
    let scaled = scaled(&held, &start.parameters, recordings);
    let effort = Effort {
        iterations: TASTED,
        differences: Differences::COARSE,
    };
    Some(descend(objective, start, &scaled, effort, stop).0)
}

fn restricted(p: &Parameters, terms: Terms, recordings: usize) -> Parameters {
    let zero_unless = |has: bool, value: f64| if has { value } else { 0.0 };
    let delay = |k: usize| p.delays.get(k).or(p.delays.first()).copied().unwrap_or(0.0);
    Parameters {
        asymmetry: zero_unless(terms.asymmetric_viscous, p.asymmetry),
        coulomb: zero_unless(terms.coulomb, p.coulomb),
        offset: zero_unless(terms.offset, p.offset),
        gravity: p.gravity.map(|g| zero_unless(terms.gravity, g)),
        delays: (0..recordings)
            .map(|k| zero_unless(terms.delay, delay(k)))
            .collect(),
        ..p.clone()
    }
}

fn scaled(
    coordinates: &[Coordinate],
    p: &Parameters,
    recordings: &[&Observed],
) -> Vec<(Coordinate, Scale)> {
    let largest = recordings
        .iter()
        .fold(0.0f64, |most, r| most.max(r.largest));
    let interval = recordings
        .iter()
        .fold(f64::INFINITY, |least, r| least.min(r.interval_s));
    let lsb = recordings
        .iter()
        .fold(f64::INFINITY, |least, r| least.min(r.lsb));
    (coordinates.iter())
        .map(|&c| (c, Scale::new(c, p, largest, interval, lsb)))
        .collect()
}

impl Maximum {
    /// Standard error, SI: the larger of curvature and sandwich, and for a delay that of the log's ticks beside it. `None` where
    /// the model has no such number or the readings do not determine it.
    pub fn std(&self, c: Coordinate) -> Option<f64> {
        let at = self.place(c)?;
        let errors = self.errors.as_ref()?;
        let error = errors.of(&self.weights(&[(at, 1.0)]));
        let error = libm::hypot(error, self.timing_error_s(c));
        let p = &self.parameters;
        let most = match c {
            Coordinate::Inertia | Coordinate::Damping => UNDETERMINED * c.get(p),
            _ if c.is_delay() => UNDETERMINED * c.get(p).max(p.time_constant()),
            _ => f64::INFINITY,
        };
        (!errors.unknown[at] && error > 0.0 && error < most).then_some(error)
    }

    /// The 95 % interval, SI; what cannot be negative ends at zero.
    pub fn interval(&self, c: Coordinate) -> Option<[f64; 2]> {
        let (value, half) = (c.get(&self.parameters), NORMAL_95 * self.std(c)?);
        let signed = matches!(
            c,
            Coordinate::Offset | Coordinate::Asymmetry | Coordinate::Gravity(_)
        );
        let low = if signed {
            value - half
        } else {
            (value - half).max(0.0)
        };
        Some([low, value + half])
    }

    /// Correlation of two numbers by the curvature.
    pub fn correlation(&self, a: Coordinate, b: Coordinate) -> Option<f64> {
        let (i, j) = (self.place(a)?, self.place(b)?);
        let c = &self.errors.as_ref()?.curvature;
        let correlation = c[(i, j)] / (c[(i, i)] * c[(j, j)]).sqrt();
        correlation.is_finite().then_some(correlation)
    }

    /// Delay of a recording and the time constant `a/b`, added up, s, and their standard error: what a command without edges
    /// shows of the two.
    pub fn total_lag(&self, recording: usize) -> Option<(f64, f64)> {
        let p = &self.parameters;
        let delay = p.delays.get(recording)?;
        let mut weights = vec![
            (self.place(Coordinate::Inertia)?, 1.0 / p.damping),
            (
                self.place(Coordinate::Damping)?,
                -p.inertia / (p.damping * p.damping),
            ),
        ];
        let own = [Coordinate::Delay(recording), Coordinate::CommonDelay];
        weights.extend(own.iter().find_map(|&c| self.place(c)).map(|at| (at, 1.0)));
        let std = self.errors.as_ref()?.of(&self.weights(&weights));
        let std = libm::hypot(
            std,
            self.timing_errors_s.get(recording).copied().unwrap_or(0.0),
        );
        let lag = delay + p.time_constant();
        (lag.is_finite() && std.is_finite()).then_some((lag, std))
    }

    /// What the log's ticks add to the standard error of a delay, s. A common delay is seen in each recording.
    fn timing_error_s(&self, c: Coordinate) -> f64 {
        match c {
            Coordinate::Delay(recording) => self.timing_errors_s[recording],
            Coordinate::CommonDelay => {
                let precision: f64 = (self.timing_errors_s.iter())
                    .map(|error| error.powi(-2))
                    .sum();
                libm::pow(precision, -0.5)
            }
            _ => 0.0,
        }
    }

    fn place(&self, c: Coordinate) -> Option<usize> {
        self.coordinates.iter().position(|&own| own == c)
    }

    fn weights(&self, each: &[(usize, f64)]) -> DVector<f64> {
        let mut weights = DVector::zeros(self.coordinates.len());
        for &(at, weight) in each {
            weights[at] = weight;
        }
        weights
    }
}
