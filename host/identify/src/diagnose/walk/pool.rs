//! Every set that was fitted, all scored with the same noise.

use super::moves::{self, Start};
use super::node::Node;
use super::settings::{FAR_NATS, FAR_PART, LEADERS, PROMISING, ROUNDS, SETTLED_NATS};
use crate::diagnose::candidate::descent::{Descent, Settings};
use crate::diagnose::candidate::score::score_candidate;
use crate::diagnose::candidate::search::search;
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, same};
use crate::diagnose::score::settings::{NOISE_RUNS, UNDAMPED_INTERVAL_S};
use crate::diagnose::score::{
    Filter, Foretold, Innovations, Noise, Plant, Prior, Readings, correlation_length, estimate,
    foretold, likelihoods, repeatability_counts,
};
use crate::diagnose::screening::{restart, screen};
use crate::error::Error;
use rayon::prelude::*;
use servoid_engine::problem::{
    Candidate, Horizon, START_OFFSET, START_SPEED, StartAngle, Structure, errors,
};
use servoid_engine::solve::Objective;
use shared::cost::Cost;
use shared::effects::Kind;

/// Of a fit of innovations that is to converge.
const CONVERGED: Settings = Settings {
    evaluations: 150,
    tolerance: 1e-4,
    damping: 1e-6,
    secant: true,
    again: false,
    ..Settings::THOROUGH
};
/// Of one that shows whether more is worth it.
const ROUGH: Settings = Settings {
    evaluations: 40,
    tolerance: 1e-2,
    ..CONVERGED
};

/// The recordings on one side with their observer.
struct Side<'a> {
    readings: Readings<'a>,
    noise: Vec<Noise>,
    filter: Filter,
}

/// Every set that was fitted.
pub struct Pool<'a> {
    context: &'a Context<'a>,
    base: FittedModel,
    plant: Plant,
    prior: Prior,
    fitted: Side<'a>,
    held_out: Side<'a>,
    /// Readings for each independent one.
    correlation: f64,
    /// Best first.
    pub nodes: Vec<Node>,
}

impl<'a> Pool<'a> {
    /// A pool that holds the linear motor alone.
    pub fn begun(context: &'a Context<'a>, base: &FittedModel) -> Self {
        let plant = Plant::of(&base.candidate.machine);
        let interval_s = if context.data.drive.is_voltage() {
            plant.time_constant_s
        } else {
            UNDAMPED_INTERVAL_S
        };
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
        let mut pool = Pool {
            context,
            base: base.clone(),
            plant,
            prior: Prior {
                about: base.candidate.machine,
            },
            fitted: side(context.data),
            held_out: side(context.held_out),
            correlation: 1.0,
            nodes: Vec::new(),
        };
        pool.estimate_noise_under(&base.candidate);
        let linear = pool.fit(&base.structure, std::slice::from_ref(&base.x), CONVERGED);
        let standing = || Node::new(base.structure.clone(), base.x.clone());
        pool.put(vec![linear.unwrap_or_else(standing)]);
        pool
    }

    /// The best node.
    pub fn best(&self) -> &Node {
        &self.nodes[0]
    }

    /// The node of a set.
    pub fn node(&self, effects: &[Kind]) -> Option<&Node> {
        self.nodes.iter().find(|node| same(&node.effects, effects))
    }

    /// Whether a set was fitted.
    pub fn knows(&self, effects: &[Kind]) -> bool {
        self.node(effects).is_some()
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

    /// Fits a set from the linear motor, one effect after the other.
    pub fn add_seed(&mut self, effects: &[Kind]) {
        let mut parent = self.base.clone();
        for &kind in effects {
            let Some(screened) = screen(self.context, &parent, kind, &[]) else {
                return;
            };
            let Some(node) = self.fit(&screened.structure, &[screened.x], CONVERGED) else {
                return;
            };
            let Ok(model) = self.model(&node) else { return };
            parent = model;
            self.put(vec![node]);
        }
    }

    /// Fits neighbours of a node.
    pub fn fit_from_node(&mut self, parent: &Node, starts: Vec<Start>, done: &(dyn Fn() + Sync)) {
        if starts.is_empty() {
            return;
        }
        let Ok(model) = self.model(parent) else {
            return;
        };
        let mut begun: Vec<Node> = starts
            .par_iter()
            .filter(|_| !self.context.budget.exhausted())
            .filter_map(|start| {
                let mut node = self.begin(parent, &model, start)?;
                self.rate(&mut node);
                done();
                Some(node)
            })
            .collect();
        begun.sort_by(|a, b| b.score.total_cmp(&a.score));
        // What starts far behind the others is not fitted.
        let fitted: Vec<Node> = begun
            .par_iter()
            .take(PROMISING)
            .filter_map(|node| self.go_on(node, ROUGH))
            .collect();
        self.put(begun);
        self.put(fitted);
    }

    /// Fits a node with each look-alike in the place of an effect, until those converge that come near.
    pub fn fit_substitutes(&mut self, node: &Node, done: &(dyn Fn() + Sync)) {
        let all = moves::substitutes(self.context, node);
        let unknown = |start: &Start| !self.knows(&start.effects());
        let (new, known): (Vec<Start>, Vec<Start>) = all.into_iter().partition(unknown);
        self.fit_from_node(node, new, done);
        let sets = known.iter().map(Start::effects);
        let old: Vec<Node> = sets.filter_map(|set| self.node(&set).cloned()).collect();
        let again: Vec<Node> = old
            .par_iter()
            .filter(|other| !other.converged && node.score - other.score < FAR_NATS)
            .filter_map(|other| self.go_on(other, CONVERGED))
            .collect();
        self.put(again);
        self.converge_leaders();
    }

    /// Fits a node without each of its effects, from where it stands, until it converges.
    pub fn fit_without_each(&mut self, node: &Node) {
        let Ok(model) = self.model(node) else { return };
        let nodes: Vec<Node> = (node.effects.par_iter())
            .filter(|_| !self.context.budget.exhausted())
            .filter_map(|&gone| {
                let rest = model.without(gone);
                let start = restart(self.context, &rest);
                let known = self.node(&rest.effects);
                let known = known.map(|known| start.structure.point(&known.candidate()));
                let starts: Vec<Vec<f64>> = known.into_iter().chain([start.x]).collect();
                self.fit(&start.structure, &starts, CONVERGED)
            })
            .collect();
        self.put(nodes);
    }

    /// A neighbour of a node where its fit starts.
    fn begin(&self, parent: &Node, model: &FittedModel, start: &Start) -> Option<Node> {
        let gone = parent
            .effects
            .iter()
            .filter(|kind| !start.kept.contains(kind));
        let rest = gone.fold(model.clone(), |model, &kind| model.without(kind));
        let rest = FittedModel {
            rms_counts: model.rms_counts,
            ..rest
        };
        let Some(kind) = start.added else {
            let start = restart(self.context, &rest);
            return Some(Node::new(start.structure, start.x));
        };
        let first = kind.facts().starts.after();
        let first = first.and_then(|simpler| screen(self.context, &rest, simpler, &[]));
        let screened = screen(self.context, &rest, kind, first.as_slice())?;
        // Where the effect was screened, or where the parent stands with the effect as it was screened.
        let beside = self.beside(&rest, &screened.structure, &screened.values());
        let problem = self.innovations(&screened.structure);
        let starts = [screened.x, beside];
        let costs = starts.into_iter().map(|x| (problem.cost(&x), x));
        let (_, x) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Node::new(screened.structure, x))
    }

    /// The parameters of `rest` with those of the newest effect from `values`.
    fn beside(&self, rest: &FittedModel, structure: &Structure, values: &[f64]) -> Vec<f64> {
        let mut parameters = rest.parameters.clone();
        parameters.extend_from_slice(&values[rest.parameters.len()..]);
        let speed = rest.candidate.start_speed;
        let values = structure.values_of(&rest.candidate.machine, &parameters, speed);
        structure.coordinates(&values)
    }

    fn innovations(&self, structure: &Structure) -> Innovations<'_> {
        let method = self.context.method;
        let Side {
            readings, filter, ..
        } = &self.fitted;
        Innovations::new(readings, filter, self.prior, structure.clone(), method)
    }

    /// A node fitted on from where it stands; not scored.
    fn go_on(&self, node: &Node, settings: Settings) -> Option<Node> {
        self.fit(&node.structure, std::slice::from_ref(&node.x), settings)
    }

    /// The fit from the best of several starts; not scored.
    fn fit(&self, structure: &Structure, starts: &[Vec<f64>], settings: Settings) -> Option<Node> {
        let problem = self.innovations(structure);
        let method = self.context.method;
        let cost = |start: &&Vec<f64>| match starts {
            [_] => 0.0,
            _ => problem.cost(start),
        };
        let costs = starts.iter().map(|start| (cost(&start), start));
        let (_, start) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let found = search(self.context, &problem, start, settings, method)?;
        Some(Node {
            converged: found.evaluations < settings.evaluations
                && settings.tolerance <= CONVERGED.tolerance,
            ..Node::new(structure.clone(), found.x)
        })
    }

    /// Adds nodes, or puts them in the place of worse ones of the same set, and sorts.
    fn put(&mut self, nodes: Vec<Node>) {
        for mut node in nodes {
            self.rate(&mut node);
            let known = self
                .nodes
                .iter()
                .position(|other| same(&other.effects, &node.effects));
            match known {
                Some(place) if self.nodes[place].score <= node.score => self.nodes[place] = node,
                Some(place) => self.nodes[place].converged |= node.converged,
                None => self.nodes.push(node),
            }
        }
        self.sort();
    }

    fn sort(&mut self) {
        self.nodes.sort_by(|a, b| b.score.total_cmp(&a.score));
    }

    fn rate(&self, node: &mut Node) {
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

    /// Estimates the noise under the best node, and scores all again.
    pub fn estimate_noise(&mut self) {
        let candidate = self.best().candidate();
        self.estimate_noise_under(&candidate);
        if let Some(errors) = self.errors_at(&self.fitted, &candidate) {
            let Side {
                readings, filter, ..
            } = &self.fitted;
            self.correlation = correlation_length(readings, filter, &errors);
        }
        let mut nodes = std::mem::take(&mut self.nodes);
        nodes.par_iter_mut().for_each(|node| {
            node.converged = false;
            self.rate(node);
        });
        self.nodes = nodes;
        self.sort();
    }

    /// Lets the best nodes converge and estimates the noise under the best, in turn: as the model becomes better the noise becomes less.
    pub fn anneal(&mut self) {
        self.converge_leaders();
        for _ in 0..ROUNDS {
            let noise_of = self.best().effects.clone();
            self.estimate_noise();
            let before = self.best().score;
            self.converge_leaders();
            let best = self.best();
            if same(&best.effects, &noise_of) && best.score - before < SETTLED_NATS {
                return;
            }
        }
    }

    /// Whether the free runs of the best node leave the encoder's own error only.
    pub fn is_explained(&self) -> bool {
        self.model(self.best())
            .is_ok_and(|model| model.free().at_floor())
    }

    fn estimate_noise_under(&mut self, candidate: &Candidate) {
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

    /// Lets the best nodes converge, until the best are those that did.
    pub fn converge_leaders(&mut self) {
        for _ in 0..ROUNDS {
            let leaders = &self.nodes[..LEADERS.min(self.nodes.len())];
            let linear = self.node(&[]).map_or(0.0, |linear| linear.score);
            let far = FAR_NATS.max(FAR_PART * (self.best().score - linear));
            let near = |node: &&Node| !node.converged && self.best().score - node.score < far;
            let again: Vec<Node> = leaders
                .par_iter()
                .filter(near)
                .filter_map(|node| self.go_on(node, CONVERGED))
                .map(|node| Node {
                    converged: true,
                    ..node
                })
                .collect();
            if again.is_empty() {
                return;
            }
            self.put(again);
        }
    }

    /// The node with its free runs' errors.
    ///
    /// # Errors
    /// Where the model cannot run.
    pub fn model(&self, node: &Node) -> Result<FittedModel, Error> {
        let found = Descent {
            x: node.x.clone(),
            squares: 0.0,
            evaluations: 0,
        };
        let method = self.context.method;
        score_candidate(
            self.context,
            node.structure.clone(),
            &found,
            f64::INFINITY,
            method,
        )
    }
}
