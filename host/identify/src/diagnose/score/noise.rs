//! The intensities of a recording's noise, by maximum likelihood of a model's innovations.

use super::gains::{Filter, Plant};
use super::likelihood::likelihood;
use super::readings::Readings;
use super::settings::{MIDDLE, NOISE_RUNS, STARTS};
use servoid_engine::problem::{Candidate, Horizon, StartAngle};
use servoid_engine::simulation::{Method, Mode, Segment, Simulation, segments};
use servoid_engine::solve::nelder_mead::NelderMead;
use servoid_engine::solve::{Evaluator, Objective, Solver};
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// The noise of one recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Intensity of the white torque that no model knows, as the acceleration that it makes: counts²/s³.
    pub torque: f64,
    /// Variance of a reading, counts².
    pub reading: f64,
}

/// The noise of every recording in `readings` under a model. `known` is where the search starts.
pub fn estimate(
    readings: &Readings<'_>,
    plant: Plant,
    candidate: &Candidate,
    method: Method,
    known: &[Noise],
    stop: &AtomicBool,
) -> Vec<Noise> {
    let scale = Scale::of(readings, plant);
    let simulation = Simulation::new(readings.data, candidate, method).ok();
    let at = Horizon::Corrected(Vec::new().into());
    let runs = segments(readings.data, candidate, &at, StartAngle::Free);
    (0..readings.recordings.len())
        .map(|place| {
            let (Some(simulation), Some(segment)) = (&simulation, runs.get(place)) else {
                return scale.noise(&MIDDLE);
            };
            let problem = OfRecording {
                readings,
                plant,
                scale,
                simulation,
                segment: segment.clone(),
                place,
            };
            problem.solved(known.get(place), stop)
        })
        .collect()
}

/// Least and most of the speed that torque noise makes, as a part of the fastest.
const SPEED_PART: (f64, f64) = (1e-7, 10.0);
/// Least and most of a reading's variance beyond its floor, in floors.
const BEYOND: (f64, f64) = (0.01, 1e8);
/// How the unit square is stretched to a noise.
#[derive(Clone, Copy)]
struct Scale {
    /// Fastest speed, counts/s.
    fastest: f64,
    time_constant_s: f64,
    floor: f64,
}

impl Scale {
    fn of(readings: &Readings<'_>, plant: Plant) -> Self {
        let units = &readings.data.units;
        let fastest = units.speed * units.counts_per_rev / std::f64::consts::TAU;
        Scale {
            fastest,
            time_constant_s: plant.time_constant_s,
            floor: readings.floor,
        }
    }

    fn noise(&self, x: &[f64]) -> Noise {
        let stretched = |x: f64, (low, high): (f64, f64)| low * libm::pow(high / low, x);
        let speed = self.fastest * stretched(x[0], SPEED_PART);
        // White torque of an intensity i makes a speed of the variance i·τ/2.
        let torque = 2.0 * speed * speed / self.time_constant_s;
        let beyond = stretched(x[1], BEYOND) - BEYOND.0;
        Noise {
            torque,
            reading: self.floor * (1.0 + beyond),
        }
    }

    fn place(&self, noise: &Noise) -> [f64; 2] {
        let shrunk = |value: f64, (low, high): (f64, f64)| {
            (libm::log(value / low) / libm::log(high / low)).clamp(0.0, 1.0)
        };
        let speed = (0.5 * noise.torque * self.time_constant_s).sqrt() / self.fastest;
        let beyond = noise.reading / self.floor - 1.0 + BEYOND.0;
        [shrunk(speed, SPEED_PART), shrunk(beyond, BEYOND)]
    }
}

/// Minus the likelihood of one recording over the unit square.
struct OfRecording<'a> {
    readings: &'a Readings<'a>,
    plant: Plant,
    scale: Scale,
    simulation: &'a Simulation<'a>,
    segment: Segment,
    place: usize,
}

impl OfRecording<'_> {
    fn own(&self) -> Range<usize> {
        self.readings.recordings[self.place].clone()
    }

    fn solved(&self, known: Option<&Noise>, stop: &AtomicBool) -> Noise {
        let starts = STARTS.iter().map(|&torque| [torque, 0.2]);
        let starts = starts.chain(known.map(|noise| self.scale.place(noise)));
        let costs = starts.map(|x| (self.cost(&x), x));
        let Some((_, start)) = costs.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            return self.scale.noise(&MIDDLE);
        };
        let begun = Begun {
            problem: self,
            start,
        };
        let mut silent = |_: usize, _: f64| {};
        let mut evaluator = Evaluator::new(&begun, NOISE_RUNS, stop, &mut silent);
        let simplex = NelderMead {
            edge: 0.08,
            tolerance: 2e-3,
        };
        simplex.search(&mut evaluator, 1);
        self.scale.noise(&evaluator.best_or_start())
    }

    fn cost(&self, x: &[f64]) -> f64 {
        let all = vec![self.scale.noise(x); self.readings.recordings.len()];
        let filter = Filter::new(self.readings, self.plant, &all);
        let mode = Mode::Corrected(&filter.corrections);
        let errors = self
            .simulation
            .errors(mode, std::slice::from_ref(&self.segment));
        let errors = self.readings.errors(&errors);
        let cost = -likelihood(self.readings, &filter, &errors, self.own());
        if cost.is_finite() {
            cost
        } else {
            f64::INFINITY
        }
    }
}

/// A problem with a start.
struct Begun<'a> {
    problem: &'a OfRecording<'a>,
    start: [f64; 2],
}

impl Objective for Begun<'_> {
    fn dim(&self) -> usize {
        self.start.len()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.problem.cost(x)
    }

    fn start(&self) -> Option<Vec<f64>> {
        Some(self.start.to_vec())
    }
}
