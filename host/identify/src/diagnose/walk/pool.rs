//! Every set that was fitted, all scored with the same noise.

use super::evidence::Evidence;
use super::moves::{self, Start};
use super::node::Node;
use super::settings::{FAR_NATS, FAR_PART, LEADERS, PROMISING, ROUNDS, SETTLED_NATS};
use crate::diagnose::candidate::descent::{Descent, Settings};
use crate::diagnose::candidate::score::score_candidate;
use crate::diagnose::candidate::search::{search, search_widening};
use crate::diagnose::context::Context;
use crate::diagnose::models::{FittedModel, ScreenedModel, same};
use crate::diagnose::screening::{self, follows, restart, screen, screen_begun};
use crate::error::Error;
use rayon::prelude::*;
use servoid_engine::problem::{Candidate, Structure};
use servoid_engine::solve::Objective;
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

/// Every set that was fitted.
pub struct Pool<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) base: FittedModel,
    /// By what the sets are judged.
    pub evidence: Evidence<'a>,
    /// Best first.
    pub nodes: Vec<Node>,
    /// Sets that were taken away.
    dropped: Vec<Vec<Kind>>,
    /// Models whose free runs were fitted until they converged, with finer steps if need be.
    pub polished: Vec<FittedModel>,
}

impl<'a> Pool<'a> {
    /// A pool that holds `base` alone: the linear motor, or a model whose neighbours are looked for.
    pub fn begun(context: &'a Context<'a>, base: &FittedModel) -> Self {
        let mut pool = Pool {
            context,
            base: base.clone(),
            evidence: Evidence::new(context, base),
            nodes: Vec::new(),
            dropped: Vec::new(),
            polished: Vec::new(),
        };
        pool.evidence.estimate_noise(&base.candidate);
        let fitted = pool.fit(&base.structure, std::slice::from_ref(&base.x), CONVERGED);
        let standing = || Node::new(base.structure.clone(), base.x.clone());
        pool.put(vec![fitted.unwrap_or_else(standing)]);
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

    /// Fits a set from the linear motor, one effect after the other.
    pub fn add_seed(&mut self, effects: &[Kind]) {
        let mut parent = self.base.clone();
        for &kind in effects {
            let Some(screened) = screen(self.context, &parent, kind) else {
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
                self.evidence.rate(&mut node);
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

    /// Fits sets again from where a node stands, or from where they stood if that is better, until they converge.
    pub fn fit_again(&mut self, node: &Node, starts: Vec<Start>, done: &(dyn Fn() + Sync)) {
        let Ok(model) = self.model(node) else { return };
        let nodes: Vec<Node> = (starts.par_iter())
            .filter(|_| !self.context.budget.exhausted())
            .filter_map(|start| {
                let begun = self.begin(node, &model, start)?;
                let known = self.node(&begun.effects);
                let known = known.map(|known| begun.structure.point(&known.candidate()));
                let starts: Vec<Vec<f64>> = known.into_iter().chain([begun.x]).collect();
                let fitted = self.fit(&begun.structure, &starts, CONVERGED);
                done();
                fitted
            })
            .collect();
        self.put(nodes);
    }

    /// The node from which the walk goes on, if it has not been there: the best, then the best few of each size. One effect may stand in
    /// for two, and leaves each of them behind. A set that costs much to simulate has no neighbours: it takes the place of one that has.
    pub fn next(&self, visited: &[Vec<Kind>], few: usize) -> Option<Node> {
        let new =
            |node: &&Node| !node.is_costly() && !visited.iter().any(|set| same(set, &node.effects));
        let of_size = |size: usize| {
            let nodes = self.nodes.iter();
            let nodes = nodes.filter(move |node| node.effects.len() == size);
            nodes.take(few).find(new)
        };
        let best = Some(self.best()).filter(new);
        best.or_else(|| (0..=self.best().effects.len()).find_map(of_size))
            .cloned()
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
        let begun = screening::begin(self.context, &rest, kind)?;
        // A free run may be chaotic where innovations are not: behind a gap a load bounces.
        let unscreened = (!follows(kind)).then(|| self.nearest(&begun)).flatten();
        let screened = screen_begun(self.context, &rest, kind, begun)?;
        // Where the effect was screened, or where the parent stands with the effect as it was screened.
        let beside = self.beside(&rest, &screened.structure, &screened.values());
        let problem = self.evidence.innovations(&screened.structure);
        let foreseen = screened.predicted();
        let starts = [screened.x, beside];
        let costs = starts.into_iter().map(|x| (problem.cost(&x), x));
        let (cost, x) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let node = match unscreened {
            Some((nearer, node)) if nearer < cost => node,
            _ => Node::new(screened.structure, x),
        };
        Some(Node { foreseen, ..node })
    }

    /// The one of some models whose innovations cost least, and what they cost.
    fn nearest(&self, begun: &[ScreenedModel]) -> Option<(f64, Node)> {
        let cost =
            |model: &ScreenedModel| self.evidence.innovations(&model.structure).cost(&model.x);
        let costs = begun.iter().map(|model| (cost(model), model));
        let (cost, model) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        Some((cost, Node::new(model.structure.clone(), model.x.clone())))
    }

    /// The parameters of `rest` with those of the newest effect from `values`.
    fn beside(&self, rest: &FittedModel, structure: &Structure, values: &[f64]) -> Vec<f64> {
        let mut parameters = rest.parameters.clone();
        parameters.extend_from_slice(&values[rest.parameters.len()..]);
        let speed = rest.candidate.start_speed;
        let values = structure.values_of(&rest.candidate.machine, &parameters, speed);
        structure.coordinates(&values)
    }

    /// A node fitted on from where it stands; not scored.
    fn go_on(&self, node: &Node, settings: Settings) -> Option<Node> {
        self.fit(&node.structure, std::slice::from_ref(&node.x), settings)
    }

    /// The fit from the best of several starts; not scored. Where whole runs may come down to the encoder's error a range is widened where it ends at
    /// its end.
    fn fit(&self, structure: &Structure, starts: &[Vec<f64>], settings: Settings) -> Option<Node> {
        let cost = |start: &&Vec<f64>| match starts {
            [_] => 0.0,
            _ => self.evidence.innovations(structure).cost(start),
        };
        let costs = starts.iter().map(|start| (cost(&start), start));
        let (_, start) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        let (structure, found) =
            search_widening(self.context, structure, start, |within, start| {
                let problem = self.evidence.innovations(within);
                search(self.context, &problem, start, settings, self.context.method)
            })?;
        Some(Node {
            converged: found.evaluations < settings.evaluations
                && settings.tolerance <= CONVERGED.tolerance,
            ..Node::new(structure, found.x)
        })
    }

    /// Adds nodes, or puts them in the place of worse ones of the same set, and sorts.
    pub(super) fn put(&mut self, nodes: Vec<Node>) {
        for mut node in nodes {
            if self.is_dropped(&node.effects) {
                continue;
            }
            self.evidence.rate(&mut node);
            let known = self
                .nodes
                .iter()
                .position(|other| same(&other.effects, &node.effects));
            match known {
                Some(place) if self.nodes[place].score <= node.score => {
                    node.foreseen = node.foreseen.min(self.nodes[place].foreseen);
                    self.nodes[place] = node;
                }
                Some(place) => self.nodes[place].converged |= node.converged,
                None => self.nodes.push(node),
            }
        }
        self.sort();
    }

    /// Takes a set away, and all that hold it: none of them is fitted again.
    pub fn drop_set(&mut self, effects: &[Kind]) {
        self.dropped.push(effects.to_vec());
        let mut nodes = std::mem::take(&mut self.nodes);
        nodes.retain(|node| !self.is_dropped(&node.effects));
        self.nodes = nodes;
        let mut polished = std::mem::take(&mut self.polished);
        polished.retain(|model| !self.is_dropped(&model.effects));
        self.polished = polished;
    }

    fn is_dropped(&self, effects: &[Kind]) -> bool {
        let holds = |set: &Vec<Kind>| set.iter().all(|kind| effects.contains(kind));
        self.dropped.iter().any(holds)
    }

    fn sort(&mut self) {
        self.nodes.sort_by(|a, b| b.score.total_cmp(&a.score));
    }

    /// Estimates the noise under a model, and scores all again.
    fn estimate_noise(&mut self, candidate: &Candidate) {
        self.evidence.estimate_noise(candidate);
        self.evidence.estimate_correlation(candidate);
        let mut nodes = std::mem::take(&mut self.nodes);
        nodes.par_iter_mut().for_each(|node| {
            node.converged = false;
            self.evidence.rate(node);
        });
        self.nodes = nodes;
        self.sort();
    }

    /// Lets the best nodes converge and estimates the noise under the best, in turn: as the model becomes better the noise becomes less.
    pub fn anneal(&mut self) {
        self.converge_leaders();
        for _ in 0..ROUNDS {
            let noise_of = self.best().effects.clone();
            let candidate = self.best().candidate();
            self.estimate_noise(&candidate);
            let before = self.best().score;
            self.converge_leaders();
            let best = self.best();
            if same(&best.effects, &noise_of) && best.score - before < SETTLED_NATS {
                return;
            }
        }
    }

    /// Lets the best nodes converge, until the best are those that did.
    pub fn converge_leaders(&mut self) {
        for _ in 0..ROUNDS {
            let leaders = &self.nodes[..LEADERS.min(self.nodes.len())];
            let linear = self.node(&[]).map_or(0.0, |linear| linear.score);
            let far = FAR_NATS.max(FAR_PART * (self.best().score - linear));
            let best = self.best();
            let near = |node: &&Node| {
                let dear = node.is_costly() && !same(&node.effects, &best.effects);
                !node.converged && !dear && best.score - node.score < far
            };
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
            node.foreseen,
            method,
        )
    }
}
