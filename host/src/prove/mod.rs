//! The blind proving ground: how good is the diagnosis, on random motors with random hidden physics?
//!
//! ```text
//! seed, number → case (motor, hidden effects, two recordings) → diagnosis → outcome → tally
//! ```
//!
//! | file | holds |
//! |---|---|
//! | `draws` | random draws from a stream that belongs to seed, case and purpose |
//! | `motor`, `hide` | a random motor; random effects with random strength and shape |
//! | `law` | a law outside the catalogue, and what was found of it |
//! | `case` | all that is drawn for a case, and its recordings |
//! | `report` | the table as text |
//! | `outcome`, `judge` | the diagnosis of a case beside its truth, and what it got right |
//! | `store`, `header`, `content` | finished cases in a file: written, what they are, read and joined |
//! | `tally`, `interval`, `confusion` | how often which |
//! | `reliability` | whether probabilities are as often right as they say |
//!
//! Case `k` of a seed is the same whatever the shard, the number of threads and the order.

mod case;
mod confusion;
mod content;
mod draws;
mod header;
mod hide;
mod interval;
mod judge;
mod law;
mod motor;
#[cfg(test)]
mod orders_law;
mod outcome;
mod reliability;
pub mod report;
mod store;
mod store_error;
mod tally;
#[cfg(test)]
mod tests;

pub use case::{Case, Drawn};
pub use content::{Content, merge, read};
pub(crate) use draws::Draws;
pub use header::Header;
pub use hide::{draw as draw_hidden, surprise};
pub(crate) use interval::Count;
pub use judge::COMPLETE_COUNTS;
pub use law::{DrawnLaw, FoundLaw};
pub use motor::Motor;
pub use outcome::{DETECTABLE_COUNTS, Errors, Naming, Outcome};
pub use servoid_batch::{BadShard, Shard};
pub use store::Store;
pub use store_error::{Fault, StoreError};
pub use tally::tally;

use crate::error::Error;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc;

/// How many effects a case hides.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum HowMany {
    /// None: whatever is named is wrong
    None,
    /// One of the catalogue
    One,
    /// Two that act in different ways
    Two,
    /// A fifth none, two fifths one, two fifths two
    Mix,
    /// A law that is none of the catalogue; --discover is set
    Formula,
}

/// How the motor is driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Excite {
    /// The commissioning sequence at 0.6 to 1 of the supply
    Commissioning,
    /// Any single shape but rest at any amplitude, and coarse encoders too
    Mixed,
}

/// By which curves the hidden effects act, where the bench has several for one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Laws {
    /// The model's own equations
    #[default]
    Own,
    /// Other curves from other sources; of the effects that have one
    Other,
    /// Either, as it falls
    Any,
}

impl Laws {
    /// Its name on the command line.
    pub fn name(self) -> String {
        value_name(&self)
    }
}

impl HowMany {
    /// Its name on the command line.
    pub fn name(self) -> String {
        value_name(&self)
    }
}

impl Excite {
    /// Its name on the command line.
    pub fn name(self) -> String {
        value_name(&self)
    }
}

fn value_name(value: &impl clap::ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or(String::new(), |value| value.get_name().to_owned())
}

/// What the cases follow from, beside their numbers.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SetUp {
    /// Seed of everything random.
    pub seed: u64,
    /// How many effects a case hides.
    pub hidden: HowMany,
    /// How the motor is driven.
    pub excite: Excite,
    /// Names of the effects to choose from; empty for all.
    pub effects: Vec<String>,
    /// By which curves they act.
    #[serde(default)]
    pub laws: Laws,
    /// Whether laws are proposed for what the catalogue leaves.
    #[serde(default)]
    pub discover: bool,
}

/// Proves the cases of these `numbers`, each in one thread, as many at a time as there are threads (see
/// `RAYON_NUM_THREADS`), and hands each outcome to `finished` as it comes. When `stop` is set the cases
/// under way are dropped: half a diagnosis says nothing.
///
/// # Errors
/// A case that cannot be drawn, or what `finished` returns.
pub fn run(
    set_up: &SetUp,
    numbers: &[u64],
    stop: &AtomicBool,
    finished: &mut dyn FnMut(Outcome) -> Result<(), Error>,
) -> Result<(), Error> {
    let next = AtomicUsize::new(0);
    let over = AtomicBool::new(false);
    let threads = rayon::current_num_threads().min(numbers.len());
    std::thread::scope(|scope| {
        let (sender, outcomes) = mpsc::channel();
        for _ in 0..threads {
            let sender = sender.clone();
            let (next, over) = (&next, &over);
            scope.spawn(move || {
                while !stop.load(Ordering::Relaxed) && !over.load(Ordering::Relaxed) {
                    let Some(&number) = numbers.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        break;
                    };
                    let outcome = Case::record(set_up, number)
                        .and_then(|case| Outcome::of(&case, set_up, stop));
                    let complete = !stop.load(Ordering::Relaxed);
                    if !complete || sender.send(outcome).is_err() {
                        break;
                    }
                }
            });
        }
        drop(sender);
        let collect = || -> Result<(), Error> {
            for outcome in outcomes {
                finished(outcome?)?;
            }
            Ok(())
        };
        let collected = collect();
        over.store(true, Ordering::Relaxed);
        collected
    })
}
