//! The walk over sets of effects with one score: from the best set known its neighbours are fitted, until none is better.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `node` | a set of effects with its best fit |
//! | `moves` | from a set to its neighbours |
//! | `evidence` | by what they are judged: all recordings with their observers and noise |
//! | `pool` | all nodes, fitted and scored alike |
//! | `answer` | the model that is chosen, and what leads to it |
//! | `forms` | forms of effects other than the textbook's |
//! | `free_runs` | fits by free runs, where those may come down to the encoder's error |
//! | `floor` | what stands below its error |
//! | `told` | what a score tells of one model |
//! | `ring` | the neighbours of one model on their own |

mod answer;
mod evidence;
mod floor;
mod forms;
mod free_runs;
mod moves;
mod node;
mod pool;
mod ring;
mod settings;
mod told;

pub use answer::Answer;
pub use ring::{Neighbour, Ring, ring};
pub use settings::CLASS_NATS;
pub use told::told;

use answer::answer;
use node::Node;
use pool::Pool;

use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use settings::{BEAM, MOST_EFFECTS, MOST_RINGS, PATIENCE};
use shared::effects::Kind;

/// Sets from which the walk starts in windows besides the linear motor: what nearly every motor has, and what an arm has. Noise that is
/// estimated without them swallows them: it then prefers a motor that ignores its voltage.
const SEEDS: [&[Kind]; 2] = [
    &[Kind::Coulomb],
    &[Kind::Coulomb, Kind::Unbalance, Kind::LoadFriction],
];

/// Walks from the linear motor `base`, and answers. `done` is called after each piece of work.
pub fn walk(context: &Context<'_>, base: &FittedModel, done: &(dyn Fn() + Sync)) -> Answer {
    let mut pool = Pool::begun(context, base);
    if context.span.window_s.is_some() {
        in_windows(context, &mut pool, done);
    } else {
        to_the_floor(context, &mut pool, done);
    }
    context.budget.release_reserve();
    answer(context, &mut pool, done)
}

/// From the best to its neighbours, until none is better: nobody knows before whether anything is missing.
fn in_windows(context: &Context<'_>, pool: &mut Pool<'_>, done: &(dyn Fn() + Sync)) {
    for seed in SEEDS {
        if seed.iter().all(|kind| context.candidates.contains(kind)) {
            pool.add_seed(seed);
            done();
        }
    }
    pool.anneal();
    for _ in 0..MOST_RINGS {
        if context.budget.exhausted() || pool.is_explained() {
            return;
        }
        let from = pool.best().clone();
        fit_ring(context, pool, &from, done);
        if pool.best().effects == from.effects {
            return;
        }
    }
}

/// The same where whole runs may come down to the encoder's error, and further from others than the best until they do.
fn to_the_floor(context: &Context<'_>, pool: &mut Pool<'_>, done: &(dyn Fn() + Sync)) {
    pool.polish_best();
    let mut visited: Vec<Vec<Kind>> = Vec::new();
    while visited.len() < MOST_RINGS && !context.budget.exhausted() && !pool.is_explained() {
        let Some(from) = pool.next(&visited, BEAM) else {
            break;
        };
        fit_ring(context, pool, &from, done);
        pool.polish_best();
        if from.effects.is_empty() && !pool.is_explained() {
            pool.fit_each_alone(done);
        }
        visited.push(from.effects);
        // An effect that costs much may be all that is missing.
        if visited.len() == PATIENCE {
            let alone = |node: &Node| node.effects.len() == 1;
            fit_costly(context, pool, alone, done);
        }
    }
    for set in fit_costly(context, pool, |_| true, done) {
        let model = pool.node(&set).map(|node| pool.model(node));
        if let Some(Ok(model)) = model {
            pool.polish(&model);
        }
    }
}

/// Fits the neighbours of a node, and estimates the noise again.
fn fit_ring(context: &Context<'_>, pool: &mut Pool<'_>, from: &Node, done: &(dyn Fn() + Sync)) {
    let starts = moves::neighbours(context, from, pool, MOST_EFFECTS);
    pool.fit_from_node(from, starts, done);
    pool.anneal();
    context.budget.checkpoint();
}

/// Fits effects that cost much to simulate in the place of their special cases in the best of the nodes that are `meant`, where nothing
/// explains the recording. Answers the sets that were fitted, if something is still left.
fn fit_costly(
    context: &Context<'_>,
    pool: &mut Pool<'_>,
    meant: impl Fn(&Node) -> bool,
    done: &(dyn Fn() + Sync),
) -> Vec<Vec<Kind>> {
    if pool.is_explained() || context.budget.exhausted() {
        return Vec::new();
    }
    let nodes = pool
        .nodes
        .iter()
        .filter(|node| !node.is_costly() && meant(node));
    let starts = nodes.map(|node| (node.clone(), moves::costly(context, node)));
    let Some((node, starts)) = starts.into_iter().find(|(_, starts)| !starts.is_empty()) else {
        return Vec::new();
    };
    let sets = starts.iter().map(moves::Start::effects).collect();
    pool.fit_from_node(&node, starts, done);
    pool.anneal();
    pool.polish_best();
    if pool.is_explained() {
        return Vec::new();
    }
    sets
}
