//! Whether standard errors hold what they promise: random motors on the virtual bench, fitted, and the error of each
//! parameter in its standard errors.
//!
//! | file | holds |
//! |---|---|
//! | `condition` | drives and encoders, and the recordings of random motors under them |
//! | `tally` | how the errors lie |
//! | `report` | the table as text |

mod condition;
pub mod report;
mod tally;

use crate::error::Error;
use crate::prove::Shard;
use condition::{Condition, Standardised};
use rayon::prelude::*;
use servoid_results::schema::coverage::Coverage;
use std::sync::atomic::{AtomicBool, Ordering};

/// Fits so many recordings of each condition, those of `shard`. `done` is called after each; when `stop` is set the rest is
/// left out.
///
/// # Errors
/// A motor that cannot be drawn.
pub fn run(
    seed: u64,
    cases: u64,
    shard: Shard,
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Result<Coverage, Error> {
    let conditions = Condition::all();
    let numbers: Vec<u64> = shard.numbers(cases).collect();
    let work: Vec<(usize, u64)> = (0..conditions.len())
        .flat_map(|place| numbers.iter().map(move |&number| (place, number)))
        .collect();
    let fitted = |&(place, number): &(usize, u64)| {
        if stop.load(Ordering::Relaxed) {
            return None;
        }
        let errors = conditions[place].errors(seed, number);
        done();
        Some(errors.map(|errors| (place, errors)))
    };
    let found: Vec<(usize, Option<Vec<Standardised>>)> =
        (work.par_iter().filter_map(fitted)).collect::<Result<_, _>>()?;
    let interrupted = stop.load(Ordering::Relaxed);
    Ok(tally::tally(seed, &conditions, &found, interrupted))
}

/// How many recordings [`run`] fits.
pub fn recordings(cases: u64, shard: Shard) -> u64 {
    (Condition::all().len() * shard.numbers(cases).count()) as u64
}
