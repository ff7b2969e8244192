//! By what sets of effects are judged: all recordings with their observers and noise.

use super::node::Node;
use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use crate::diagnose::score::settings::NOISE_RUNS;
use crate::diagnose::score::{
    Filter, Foretold, Innovations, Noise, Plant, Prior, Readings, correlation_length, estimate,
    foretold, likelihoods, repeatability_counts, standard_errors,
};
use servoid_engine::problem::{
    Candidate, Horizon, START_OFFSET, START_SPEED, StartAngle, Structure, errors,
};
use shared::cost::Cost;
use std::collections::BTreeMap;

/// The recordings on one side with their observer.
struct Side<'a> {
    readings: Readings<'a>,
    noise: Vec<Noise>,
    filter: Filter,
}

/// All recordings of a walk.
pub struct Evidence<'a> {
    context: &'a Context<'a>,
    plant: Plant,
    prior: Prior,
    fitted: Side<'a>,
    held_out: Side<'a>,
    /// Readings for each independent one.
    correlation: f64,
}

impl<'a> Evidence<'a> {
    /// Of the recordings of `context`, with the noise that the encoder makes; `base` is the linear motor.
    pub fn new(context: &'a Context<'a>, base: &FittedModel) -> Self {
        let plant = Plant::of(&base.candidate.machine);
        let interval_s = plant.interval_s(context.data.drive);
        let side = |data| {
            let readings = Readings::every(data, interval_s);
            let noise = vec![
                Noise {
                    torque: 0.0,
                    reading: readings.floor,
                };
                readings.recordings.len()
            ];
            let filter = Filter::new(&readings, plant, &noise);
            Side {
                readings,
                noise,
                filter,
            }
        };
        Evidence {
            context,
            plant,
            prior: Prior {
                about: base.candidate.machine,
            },
            fitted: side(context.data),
            held_out: side(context.held_out),
            correlation: 1.0,
        }
    }

    /// Estimates the noise of every recording under a model.
    pub fn estimate_noise(&mut self, candidate: &Candidate) {
        let elsewhere = self.elsewhere(candidate);
        let (plant, context) = (self.plant, self.context);
        for (side, candidate) in [
            (&mut self.fitted, candidate),
            (&mut self.held_out, &elsewhere),
        ] {
            let stop = context.budget.stop();
            side.noise = estimate(
                &side.readings,
                plant,
                candidate,
                context.method,
                &side.noise,
                stop,
            );
            let runs = NOISE_RUNS * side.readings.data.len();
            context.budget.book(runs as u64);
            side.filter = Filter::new(&side.readings, plant, &side.noise);
        }
    }

    /// Estimates how many readings make an independent one under a model.
    pub fn estimate_correlation(&mut self, candidate: &Candidate) {
        if let Some(errors) = self.errors_at(&self.fitted, candidate) {
            let Side {
                readings, filter, ..
            } = &self.fitted;
            self.correlation = correlation_length(readings, filter, &errors);
        }
    }

    /// Scores a node.
    pub fn rate(&self, node: &mut Node) {
        let values = node.structure.values(&node.x);
        let candidate = node.structure.candidate(&values);
        let sides = [
            (&self.fitted, candidate),
            (&self.held_out, self.elsewhere(&candidate)),
        ];
        let nats: f64 = sides
            .iter()
            .flat_map(|(side, candidate)| match self.errors_at(side, candidate) {
                Some(errors) => likelihoods(&side.readings, &side.filter, &errors),
                None => vec![f64::NEG_INFINITY],
            })
            .sum();
        let distances = self.prior.distances(&node.structure, &values);
        let prior: f64 = distances.iter().map(|d| 0.5 * d * d).sum();
        let starts = [START_SPEED, START_OFFSET];
        let of_start = node
            .structure
            .unknowns
            .iter()
            .filter(|u| starts.contains(&u.name.as_str()));
        let parameters = (node.freedom() - of_start.count()) as f64;
        let readings = self.fitted.readings.weight() + self.held_out.readings.weight();
        let independent = (readings / self.correlation).max(2.0);
        let score = nats / self.correlation - prior - 0.5 * parameters * libm::log(independent);
        // A run that ends in no number is worse than any other.
        node.score = if score.is_nan() {
            f64::NEG_INFINITY
        } else {
            score
        };
    }

    /// The innovations on the fitted recordings of models with these unknowns.
    pub fn innovations(&self, structure: &Structure) -> Innovations<'_> {
        let method = self.context.method;
        let Side {
            readings, filter, ..
        } = &self.fitted;
        Innovations::new(readings, filter, self.prior, structure.clone(), method)
    }

    /// Standard errors of a model's unknowns, by name.
    pub fn standard_errors(&self, model: &FittedModel) -> BTreeMap<String, f64> {
        let innovations = self.innovations(&model.structure);
        standard_errors(&innovations, &model.structure, &model.x, self.correlation)
    }

    /// What is foretold of the innovations of a node on the fitted recordings.
    pub fn foretold(&self, candidate: &Candidate) -> Option<Foretold> {
        let Side {
            readings, filter, ..
        } = &self.fitted;
        let errors = self.errors_at(&self.fitted, candidate)?;
        foretold(readings, filter, &errors)
    }

    /// RMS by which a right model's free run would miss the fitted recordings in windows, counts.
    pub fn repeatability_counts(&self, candidate: &Candidate, window_s: f64) -> f64 {
        let plant = Plant::of(&candidate.machine);
        let noise = &self.fitted.noise;
        let squares = noise
            .iter()
            .map(|noise| repeatability_counts(noise, plant, window_s).powi(2));
        (squares.sum::<f64>() / noise.len().max(1) as f64).sqrt()
    }

    /// The model with the start of the held-out recording.
    fn elsewhere(&self, candidate: &Candidate) -> Candidate {
        Candidate {
            start_speed: self.held_out.readings.data.start_speed(0),
            start_offset: 0.0,
            ..*candidate
        }
    }

    /// Innovations of a model at the readings of one side, counts.
    fn errors_at(&self, side: &Side<'_>, candidate: &Candidate) -> Option<Vec<f64>> {
        let data = side.readings.data;
        let horizon = Horizon::Corrected(side.filter.corrections.clone());
        let (start, cost) = (StartAngle::Free, Cost::Squared);
        let all = errors(data, candidate, self.context.method, &horizon, start, cost).ok()?;
        Some(side.readings.errors(&all))
    }
}
