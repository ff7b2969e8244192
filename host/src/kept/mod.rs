//! Results that were written as JSON, read again: the only place that knows the keys of other verbs' files.
//!
//! | file | holds |
//! |---|---|
//! | `file` | one result of any verb |
//! | `results` | what is read of each |
//! | `model` | a model with all its numbers, as `fit` and `diagnose` write it |
//! | `fault` | what can be wrong with one, with the remedy |

mod fault;
mod file;
mod model;
mod results;

pub use fault::ModelFault;
pub(crate) use fault::number;
pub use file::{Kept, KeptError, KeptFault};
pub use model::{Integrator, KeptMachine, KeptModel, KeptParameter};
pub use results::{
    KeptBase, KeptCandidate, KeptContest, KeptDiagnosis, KeptEstimate, KeptFinal, KeptFit,
    KeptHeldOut, KeptLoop, KeptMargins, KeptMiss, KeptPrinted, KeptRow, KeptRung, KeptStep,
    KeptVariant, KeptVerification,
};
