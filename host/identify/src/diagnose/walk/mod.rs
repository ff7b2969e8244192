//! The walk over sets of effects with one score: from the best set known its neighbours are fitted, until none is better.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `node` | a set of effects with its best fit |
//! | `moves` | from a set to its neighbours |
//! | `pool` | all nodes, fitted and scored alike |
//! | `answer` | the model that is chosen, and what leads to it |

mod answer;
mod moves;
mod node;
mod pool;
mod settings;

pub use answer::{Answer, answer};
pub use pool::Pool;

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

/// Walks from the linear motor `base`; the nodes, best first. `done` is called after each piece of work.
pub fn walk<'a>(
    context: &'a Context<'a>,
    base: &FittedModel,
    done: &(dyn Fn() + Sync),
) -> Pool<'a> {
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
        let before = pool.best().effects.clone();
        let starts = moves::neighbours(context, pool.best(), &pool, MOST_EFFECTS);
        pool.fit_from_best(starts, done);
        pool.anneal();
        context.budget.checkpoint();
        if pool.best().effects == before {
            break;
        }
    }
    pool
}

/// For trials: walks along recordings and prints what it finds.
pub fn walk_report(data: &servoid_engine::problem::Data, held_out: &servoid_engine::problem::Data, options: &crate::fit::Options, window: Option<f64>) {
    let stop = std::sync::atomic::AtomicBool::new(false);
    let budget = crate::diagnose::Budget::of(20_000_000_000, &stop);
    let t = std::time::Instant::now();
    let options = crate::fit::Options { window_s: window, ..options.clone() };
    let prepared = Context::new(data, held_out, &options, &budget);
    let linear = crate::diagnose::linear::fit_linear_motor(prepared, &options).unwrap();
    println!("linear {:.1} s, {:?}, {:?}", t.elapsed().as_secs_f64(), linear.base.ran(), linear.context.span.reason);
    let mut pool = walk(&linear.context, &linear.base, &|| {});
    println!("walk {:.1} s, {} nodes, correlation {:.2}, noise {:?}", t.elapsed().as_secs_f64(), pool.nodes.len(), pool.correlation(), pool.noise().collect::<Vec<_>>());
    for node in pool.nodes.iter().take(8) {
        let names: Vec<&str> = node.effects.iter().map(|k| k.name()).collect();
        println!("  {:9.1} {:9.1} {} {:?}", node.score - pool.best().score, node.score, names.join("+"), node.nats.iter().map(|n| n.round()).collect::<Vec<_>>());
    }
    let a = answer(&linear.context, &linear.base, &mut pool, &|| {});
    println!("answer {:.1} s {:?} floor {:?}", t.elapsed().as_secs_f64(), a.chosen.map(|m| (m.effects.iter().map(|k| k.name()).collect::<Vec<_>>(), m.windowed)), a.floor);
    for node in pool.nodes.iter().take(3) {
        let m = pool.model(node).unwrap();
        println!("    {:?} free {:.2} {:.2} windows {:?}", m.effects.iter().map(|k| k.name()).collect::<Vec<_>>(), m.rms_counts, m.validate_rms_counts, m.windowed.map(|w| (w.fitted, w.held_out)));
        for (u, v) in node.structure.unknowns.iter().zip(node.structure.values(&node.x)) { print!(" {}={:.4}", u.name, v); }
        println!();
    }
}

