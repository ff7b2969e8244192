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
//! | `floor` | what stands below its error |
//! | `told` | what a score tells of one model |
//! | `ring` | the neighbours of one model on their own |

mod answer;
mod evidence;
mod floor;
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
use pool::Pool;

use crate::diagnose::context::Context;
use crate::diagnose::models::FittedModel;
use settings::{MOST_EFFECTS, MOST_RINGS};
use shared::effects::Kind;

/// Sets from which the walk starts besides the linear motor: what nearly every motor has, and what an arm has. Noise that is estimated
/// without them swallows them: it then prefers a motor that ignores its voltage.
const SEEDS: [&[Kind]; 2] = [
    &[Kind::Coulomb],
    &[Kind::Coulomb, Kind::Unbalance, Kind::LoadFriction],
];

/// Walks from the linear motor `base`, and answers. `done` is called after each piece of work.
pub fn walk(context: &Context<'_>, base: &FittedModel, done: &(dyn Fn() + Sync)) -> Answer {
    answer(context, &mut walked(context, base, done), done)
}

/// The nodes, best first.
fn walked<'a>(context: &'a Context<'a>, base: &FittedModel, done: &(dyn Fn() + Sync)) -> Pool<'a> {
    let mut pool = Pool::begun(context, base);
    for seed in SEEDS {
        if seed.iter().all(|kind| context.candidates.contains(kind)) {
            pool.add_seed(seed);
            done();
        }
    }
    pool.anneal();
    for _ in 0..MOST_RINGS {
        if context.budget.exhausted() || pool.is_explained() {
            break;
        }
        let from = pool.best().clone();
        let starts = moves::neighbours(context, &from, &pool, MOST_EFFECTS);
        pool.fit_from_node(&from, starts, done);
        pool.anneal();
        context.budget.checkpoint();
        if pool.best().effects == from.effects {
            break;
        }
    }
    pool
}
