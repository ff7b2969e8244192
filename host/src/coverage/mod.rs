//! Whether standard errors hold what they promise: random motors on the virtual bench, fitted, and the error of each
//! parameter in its standard errors.
//!
//! | file | holds |
//! |---|---|
//! | `condition` | drives and encoders, and the recordings of random motors under them |
//! | `tally` | how the errors lie |
//! | `join` | the joint table of several machines' shards |
//! | `report` | the table as text |

mod condition;
mod join;
pub mod report;
mod tally;

use crate::error::Error;
use crate::prove::Shard;
pub use condition::Condition;
use condition::Standardised;
pub use join::join;
use rayon::prelude::*;
use servoid_results::schema::coverage::Coverage;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is fitted.
pub struct Plan {
    /// Seed of everything random.
    pub seed: u64,
    /// Recordings of each condition.
    pub cases: u64,
    /// Which of them.
    pub shard: Shard,
    /// The conditions.
    pub conditions: Vec<Condition>,
}

impl Plan {
    /// Fits the recordings. `done` is called after each; when `stop` is set the rest is left out.
    ///
    /// # Errors
    /// A motor that cannot be drawn.
    pub fn run(&self, stop: &AtomicBool, done: &(dyn Fn() + Sync)) -> Result<Coverage, Error> {
        let numbers: Vec<u64> = self.shard.numbers(self.cases).collect();
        let work: Vec<(usize, u64)> = (0..self.conditions.len())
            .flat_map(|place| numbers.iter().map(move |&number| (place, number)))
            .collect();
        let fitted = |&(place, number): &(usize, u64)| {
            if stop.load(Ordering::Relaxed) {
                return None;
            }
            let errors = self.conditions[place].errors(self.seed, number);
            done();
            Some(errors.map(|errors| (place, errors)))
        };
        let found: Vec<(usize, Option<Vec<Standardised>>)> =
            (work.par_iter().filter_map(fitted)).collect::<Result<_, _>>()?;
        let interrupted = stop.load(Ordering::Relaxed);
        Ok(tally::tally(
            self.seed,
            &self.conditions,
            &found,
            interrupted,
        ))
    }

    /// How many recordings are fitted.
    pub fn recordings(&self) -> u64 {
        (self.conditions.len() * self.shard.numbers(self.cases).count()) as u64
    }
}
