//! One ring of the walk on its own: what an effect more would gain beside a given model.

use super::floor::floor;
use super::moves;
use super::node::Node;
use super::pool::Pool;
use super::settings::CLASS_NATS;
use crate::diagnose::context::Context;
use crate::diagnose::gain::removes;
use crate::diagnose::models::FittedModel;
use crate::diagnose::negligible::small_in;
use crate::diagnose::outcome::Floor;
use shared::effects::Kind;

/// A model with one effect more.
pub struct Neighbour {
    /// The effect that comes.
    pub added: Kind,
    /// The model, its newest effect last.
    pub model: FittedModel,
    /// Whether its score is better than that of the given model by more than what makes two sets equally probable, by an effect that is
    /// neither negligible nor as large as is searched for, and its free runs are not worse on both recordings.
    pub believed: bool,
}

/// What a look around one model gave.
pub struct Ring {
    /// Models with one effect more, best first.
    pub neighbours: Vec<Neighbour>,
    /// What stands below the error of the given model.
    pub floor: Option<Floor>,
}

/// Fits the neighbours of `standing` that have one effect more, and scores all alike. `done` is called after each piece of work.
pub fn ring(context: &Context<'_>, standing: &FittedModel, done: &(dyn Fn() + Sync)) -> Ring {
    let mut pool = Pool::begun(context, standing);
    pool.anneal();
    let from = pool.best().clone();
    let starts = moves::additions(context, &from, &pool);
    pool.fit_from_node(&from, starts, done);
    pool.anneal();
    if context.span.window_s.is_none() {
        if !pool.is_explained() {
            pool.fit_from_node(&from, moves::costly(context, &from), done);
            pool.anneal();
        }
        if let Some(best) = added(pool.best(), &from) {
            pool.fit_alike(standing, best, done);
        }
    }
    let own = pool.node(&standing.effects).unwrap_or(&from).clone();
    let given = pool.model(&own).unwrap_or_else(|_| standing.clone());
    let neighbours = pool.nodes.iter().filter_map(|node| {
        let added = added(node, &own)?;
        let model = pool.model(node).ok()?;
        let (ran, before) = (model.ran(), given.ran());
        let worse = ran.fitted > before.fitted && ran.held_out > before.held_out;
        let worth = small_in(context.data, &model).is_none() && !model.any_at_wall() && !worse;
        Some(Neighbour {
            added,
            believed: worth && node.score - own.score > CLASS_NATS,
            model,
        })
    });
    // Losses are found, not searched for: where they are what is left, nothing smooth does the same.
    let losses = pool.with_losses(&given).map(|model| Neighbour {
        added: Kind::MissedCounts,
        believed: removes(&given, &model),
        model,
    });
    let neighbours = losses.into_iter().chain(neighbours).collect();
    let floor = (context.span.window_s).map(|window_s| floor(&pool.evidence, &given, window_s));
    Ring { neighbours, floor }
}

/// The effect that `node` has and `own` has not.
fn added(node: &Node, own: &Node) -> Option<Kind> {
    let mut new = node.effects.iter().copied();
    new.find(|kind| !own.effects.contains(kind))
}
