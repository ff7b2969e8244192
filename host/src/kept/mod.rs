//! Results that were written as JSON, read again: the only place that knows the keys of other verbs' files.
//!
//! | file | holds |
//! |---|---|
//! | `model` | a model with all its numbers, as `fit` and `diagnose` write it |
//! | `fault` | what can be wrong with one, with the remedy |

mod fault;
mod model;

pub use fault::ModelFault;
pub(crate) use fault::number;
pub use model::{Integrator, KeptMachine, KeptModel, KeptParameter};
