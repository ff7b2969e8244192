//! Plans the next recording: the excitation that separates effects which explain a recording alike.
//!
//! Read in this order:
//!
//! | file | holds |
//! |---|---|
//! | `hypothesis` | a model that may be the truth, and the setup that it runs on |
//! | `excitation` | experiments in turn, with a name |
//! | `candidates` | the excitations to choose from |
//! | `playback` | an excitation simulated under a hypothesis |
//! | `limits` | limits of an excitation; candidates scaled down to them |
//! | `separation` | residual of one hypothesis fitted to another's recording |
//! | `ranking` | the candidates with the largest separation |
//! | `reasons` | why the best one separates, and the remedy if none does |
//!
//! Separation is measured by refitting, not by the angle between two residuals: a load and an unequal
//! friction leave residuals that look different, yet each imitates the other perfectly once it may
//! choose its parameters.

mod candidates;
mod excitation;
mod hypothesis;
mod limits;
mod playback;
mod ranking;
mod reasons;
mod separation;

pub use excitation::Excitation;
pub use hypothesis::{Hypothesis, Setup};
pub use limits::{Limits, Usage};
pub use playback::{Moment, play};
pub use ranking::{PlanTask, Ranked, candidate_count, rank};
pub use reasons::{remedy, why};
pub use separation::{RefitBudget, SEPARABLE_COUNTS, Separation, Trial};
