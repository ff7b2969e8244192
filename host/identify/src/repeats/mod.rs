//! Runs of one command, in several recordings or as periods of one: what a motor does not repeat is no error of a model.
//!
//! The residual of a model over repeats of one command falls into two parts (pure error and lack of fit: N. R. Draper and H. Smith, *Applied
//! Regression Analysis*, 3rd ed., 1998, §2.1): what differs between the repeats no model of command and motor can explain, and what they have
//! in common it should.
//!
//! | file | holds |
//! |---|---|
//! | `settings` | every number that decides |
//! | `aligned` | which recordings repeat one command, and which of their samples belong together |
//! | `periods` | the periods of one recording whose command comes again and again |
//! | `pure_error` | the split of a model's residual, and its test |
//! | `parting` | how far repeats part, without any model |

mod aligned;
mod parting;
mod periods;
mod pure_error;
pub mod settings;
#[cfg(test)]
mod tests;

pub use aligned::Repeats;
pub use parting::Parting;
pub use pure_error::LackOfFit;
