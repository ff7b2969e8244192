//! Proposes a law where the catalogue leaves something: simple functions of what was measured, by regression of the volts that
//! the model's equation misses along the measured motion.
//!
//! Nothing is simulated, so that thousands of laws cost a second. What the model's own parameters could take is taken out of
//! the volts and of every term alike (Frisch and Waugh, *Econometrica* 1, 387, 1933): a motor that was fitted without the law has
//! hidden part of it in its gain, its friction and its inertia.
//!
//! | file | holds |
//! |---|---|
//! | `motion` | speed, angle, current and command in each interval |
//! | `term`, `state` | one product of simple functions; the state of a hysteresis |
//! | `library` | the terms that are tried |
//! | `equation` | the rows of the regression, the missing volts and what the model's own parameters could give |
//! | `refined` | the linear motor beside what it lacks |
//! | `blocks` | regressions on all blocks but one, from sums of products |
//! | `search` | every term and every pair |
//! | `polish` | exponents, scales and distances |
//! | `judge` | what a law predicts of what it was not fitted on, and whether chance would do as much |
//! | `propose` | the stages in their order |
//! | `law`, `formula` | a law, and its text |
//! | `discover` | the proposed laws beside the catalogue |
//! | `curve` | an effect beside a curve of no stated form |
//! | `likeness` | the effect of the catalogue that a law is most like |
//! | `given` | what a model's effects give along the measured motion |
//! | `departure` | how far that is from a known truth, for proofs |

mod blocks;
mod curve;
mod departure;
mod discover;
mod equation;
mod formula;
mod given;
mod judge;
mod law;
mod library;
mod likeness;
mod motion;
mod polish;
mod propose;
mod refined;
mod search;
mod state;
mod term;

pub use curve::{Carrier, Curve, CurvePoint};
pub use departure::departure;
pub use discover::{Proposed, search_with_laws};
pub use given::Given;
pub use law::Law;
pub use propose::propose;
pub use term::{Load, Memory, Place, Shape, Speed, Term};

#[cfg(test)]
mod tests;
