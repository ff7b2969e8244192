//! What the walk ends with: the model that is chosen, the ladder that leads to it, and what else is as probable.

use super::moves;
use super::node::Node;
use super::pool::Pool;
use super::settings::{CANDIDATES, CLASS_NATS, FINALISTS, NEAR};
use crate::diagnose::candidate::several_horizons::fit_over_horizons;
use crate::diagnose::chosen::Level;
use crate::diagnose::context::Context;
use crate::diagnose::gain::removes;
use crate::diagnose::models::{FittedModel, same};
use crate::diagnose::negligible::small_in;
use crate::diagnose::ordered::in_order;
use shared::effects::Kind;

/// What the walk ends with.
pub struct Answer {
    /// The model; its effects in the order in which the error falls. `None` where the linear motor is enough.
    pub chosen: Option<FittedModel>,
    /// The ladder: models with one effect, with two, and so on up to the chosen one.
    pub levels: Vec<Level>,
    /// Other models that were fitted, best first.
    pub known: Vec<FittedModel>,
    /// Sets of effects with their scores, nats.
    pub scores: Vec<(Vec<Kind>, f64)>,
    /// Whether free runs of the chosen model leave the encoder's own error only.
    pub explained: bool,
}

/// The answer of a pool that was walked through.
pub fn answer(context: &Context<'_>, pool: &mut Pool<'_>, done: &(dyn Fn() + Sync)) -> Answer {
    prune(context, pool, done);
    let (finalists, explained, best) = loop {
        let finalists = finalists(context, pool);
        let explained = explained(context, pool, &finalists);
        let best = explained.clone().or_else(|| {
            let worth = |node: &&Node| finalists.iter().any(|m| same(&m.effects, &node.effects));
            let chosen = simplest_of_class(pool.nodes.iter().filter(worth))?;
            pool.model(chosen).ok()
        });
        match &best {
            Some(best) if any_vanishes(context, best) => pool.drop_set(&best.effects),
            _ => break (finalists, explained, best),
        }
    };
    let best = match best {
        Some(best) if explained.is_none() && context.span.window_s.is_none() => {
            Some(earned(pool, best, done))
        }
        best => best,
    };
    let Some(mut best) = best.filter(|model| !model.effects.is_empty()) else {
        return Answer {
            chosen: None,
            levels: Vec::new(),
            known: finalists,
            scores: scores(pool),
            explained: explained.is_some(),
        };
    };
    let mut known = finalists;
    if let Some(node) = pool.node(&best.effects).cloned() {
        pool.fit_substitutes(&node, done);
        if best.is_proven() {
            let alike = alike(context, pool, &node, &best);
            known.push(best.clone());
            known.extend(alike.iter().cloned());
            best = simplest_then_nearest(best, alike);
        }
    }
    let order = order_of_fall(pool, &best, done);
    let chosen = in_order(&best, &order);
    Answer {
        levels: levels(pool, &chosen),
        chosen: Some(chosen),
        known,
        scores: scores(pool),
        explained: explained.is_some(),
    }
}

fn scores(pool: &Pool<'_>) -> Vec<(Vec<Kind>, f64)> {
    let nodes = pool.nodes.iter();
    nodes
        .map(|node| (node.effects.clone(), node.score))
        .collect()
}

/// Fits the best set again without each of its effects, as long as a smaller set becomes the best: when the smaller ones were fitted, more
/// noise was thought of.
fn prune(context: &Context<'_>, pool: &mut Pool<'_>, done: &(dyn Fn() + Sync)) {
    loop {
        let best = pool.best().clone();
        pool.fit_again(&best, moves::simpler(context, &best), done);
        if same(&best.effects, &pool.best().effects) {
            return;
        }
    }
}

/// The best sets without any effect that is too small to matter or as large as is searched for, with their free runs.
fn finalists(context: &Context<'_>, pool: &Pool<'_>) -> Vec<FittedModel> {
    let models = pool.nodes.iter().filter_map(|node| pool.model(node).ok());
    models
        .filter(|model| small_in(context.data, model).is_none() && !model.any_at_wall())
        .take(FINALISTS)
        .collect()
}

/// Whether an effect of a model is too small to matter once the model is fitted by its free runs in windows: there the score has taken it
/// for something else.
fn any_vanishes(context: &Context<'_>, model: &FittedModel) -> bool {
    if context.span.window_s.is_none() {
        return false;
    }
    let horizon = context.fitted_horizon.clone();
    let refitted = fit_over_horizons(context, model, &[horizon]);
    refitted.is_some_and(|refitted| small_in(context.data, &refitted).is_some())
}

/// The simplest model whose free runs leave the encoder's own error only.
fn explained(
    context: &Context<'_>,
    pool: &mut Pool<'_>,
    finalists: &[FittedModel],
) -> Option<FittedModel> {
    let polished = pool.polished.iter();
    let polished = polished.filter(|model| small_in(context.data, model).is_none());
    let known: Vec<FittedModel> = polished.chain(finalists).cloned().collect();
    let found = simplified(context, pool, simplest(&known)?);
    // What was fitted to innovations is at the floor, and not yet where its free runs err least.
    let polished = pool.polish(&found).filter(FittedModel::is_proven);
    Some(polished.unwrap_or(found))
}

/// The simplest of those that leave the encoder's own error only.
fn simplest(models: &[FittedModel]) -> Option<FittedModel> {
    let at_floor = models.iter().filter(|model| model.is_proven());
    at_floor.min_by_key(|model| simplicity(model)).cloned()
}

/// Numbers that were fitted, and effects.
fn simplicity(model: &FittedModel) -> (usize, usize) {
    (model.freedom(), model.effects.len())
}

/// The simplest model that does what `found` does: simpler sets that come near it are polished as it was.
fn simplified(context: &Context<'_>, pool: &mut Pool<'_>, found: FittedModel) -> FittedModel {
    let mut found = found;
    while let Some(node) = pool.node(&found.effects).cloned() {
        let simpler = near(pool, &node, &found, &moves::simpler(context, &node));
        let simpler = simpler.iter().filter_map(|model| pool.polish(model));
        let simpler: Vec<FittedModel> = simpler
            .filter(|model| small_in(context.data, model).is_none())
            .collect();
        match simplest(&simpler) {
            Some(simpler) => found = simpler,
            None => break,
        }
    }
    found
}

/// Models of the sets to which `starts` lead that come near `found`, which stands at `node`: by their free runs, or by their score. Over
/// detents a free run may be chaotic until it is polished.
fn near(
    pool: &Pool<'_>,
    node: &Node,
    found: &FittedModel,
    starts: &[moves::Start],
) -> Vec<FittedModel> {
    let nodes = starts
        .iter()
        .filter_map(|start| pool.node(&start.effects()));
    nodes
        .filter_map(|other| {
            let model = pool.model(other).ok()?;
            let behind = model.ran().score() - found.ran().score();
            let near = behind < NEAR || other.score > node.score - CLASS_NATS;
            near.then_some(model)
        })
        .collect()
}

/// Models with a look-alike in the place of an effect that leave the encoder's error only, as `best` does: those that come near it are polished as
/// it was, so that their errors can be compared.
fn alike(
    context: &Context<'_>,
    pool: &mut Pool<'_>,
    node: &Node,
    best: &FittedModel,
) -> Vec<FittedModel> {
    let models = near(pool, node, best, &moves::substitutes(context, node));
    let polished = models.iter().filter_map(|model| pool.polish(model));
    polished.filter(FittedModel::is_proven).collect()
}

/// The simplest of `best` and its `alike`, and of those as simple as it the one that errs least.
fn simplest_then_nearest(best: FittedModel, alike: Vec<FittedModel>) -> FittedModel {
    let squares = |model: &FittedModel| {
        let ran = model.ran();
        ran.fitted * ran.fitted + ran.held_out * ran.held_out
    };
    let before = |a: &FittedModel, b: &FittedModel| {
        let simpler = simplicity(a).cmp(&simplicity(b));
        simpler.then(squares(a).total_cmp(&squares(b)))
    };
    let mut first = best;
    for other in alike {
        if before(&other, &first).is_lt() {
            first = other;
        }
    }
    first
}

/// `best` without the effects that do not earn their place. Where whole runs show that something is missing, any further parameter takes up a
/// part of it, and the likelihood, which knows of noise only, believes it.
fn earned(pool: &mut Pool<'_>, best: FittedModel, done: &(dyn Fn() + Sync)) -> FittedModel {
    let mut best = best;
    while let Some(node) = pool.node(&best.effects).cloned() {
        pool.fit_again(&node, moves::removals(&node).collect(), done);
        let simpler = moves::removals(&node).filter_map(|start| {
            let node = pool.node(&start.effects())?;
            pool.model(node).ok()
        });
        let needless = simpler.filter(|simpler| !removes(simpler, &best));
        match needless.min_by(FittedModel::by_score) {
            Some(simpler) => best = simpler,
            None => break,
        }
    }
    best
}

/// Of the sets that are as probable as the best the one with fewest effects, and of those the one with fewest parameters.
fn simplest_of_class<'n>(nodes: impl Iterator<Item = &'n Node> + Clone) -> Option<&'n Node> {
    let best = nodes
        .clone()
        .map(|node| node.score)
        .fold(f64::MIN, f64::max);
    nodes
        .filter(|node| best - node.score < CLASS_NATS)
        .min_by_key(|node| (node.effects.len(), node.freedom()))
}

/// The effects of a model, those first that lower the error most: from the whole set the one is taken that is missed least, and so on.
fn order_of_fall(pool: &mut Pool<'_>, model: &FittedModel, done: &(dyn Fn() + Sync)) -> Vec<Kind> {
    let mut order = Vec::new();
    let mut left: Vec<Kind> = model.effects.clone();
    while left.len() > 1 {
        let Some(node) = pool.node(&left).cloned() else {
            break;
        };
        // What was fitted when more noise was thought of is fitted again: each step shows what is left without the others.
        pool.fit_again(&node, moves::removals(&node).collect(), done);
        let error_without = |gone: Kind| {
            let rest: Vec<Kind> = left.iter().filter(|kind| **kind != gone).copied().collect();
            let model = pool.node(&rest).map(|node| pool.model(node));
            let model = model.and_then(Result::ok);
            model.map_or(f64::INFINITY, |model| model.ran().score())
        };
        let errors = left.iter().map(|&gone| (error_without(gone), gone));
        let least = errors.min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, least)) = least else { break };
        order.push(least);
        left.retain(|kind| *kind != least);
    }
    order.extend(left.into_iter().rev());
    order.reverse();
    order
}

/// For each step of the ladder the models that could stand there.
fn levels(pool: &Pool<'_>, chosen: &FittedModel) -> Vec<Level> {
    let mut levels = Vec::new();
    for depth in 1..=chosen.effects.len() {
        let before = &chosen.effects[..depth - 1];
        let own = &chosen.effects[..depth];
        let stands_here = |node: &&Node| {
            node.effects.len() == depth && before.iter().all(|kind| node.effects.contains(kind))
        };
        let mut models: Vec<FittedModel> = (pool.nodes.iter().filter(stands_here))
            .take(CANDIDATES)
            .filter_map(|node| pool.model(node).ok())
            .map(|model| newest_last(model, before))
            .collect();
        let place = models.iter().position(|model| same(&model.effects, own));
        let best = match place {
            _ if depth == chosen.effects.len() => chosen.clone(),
            Some(place) => models.remove(place),
            None => match pool.node(own).and_then(|node| pool.model(node).ok()) {
                Some(model) => model,
                None => continue,
            },
        };
        models.retain(|model| !same(&model.effects, own));
        let best = in_order(&best, own);
        models.insert(0, best.clone());
        levels.push(Level { models, best });
    }
    levels
}

fn newest_last(model: FittedModel, before: &[Kind]) -> FittedModel {
    let newest = model.effects.iter().filter(|kind| !before.contains(kind));
    let order: Vec<Kind> = before.iter().chain(newest).copied().collect();
    in_order(&model, &order)
}
