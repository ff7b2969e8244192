//! Results that were written as JSON, read again: the only place that knows the keys of other verbs' files.
//!
//! | file | holds |
//! |---|---|
//! | `file` | one result of any verb |
//! | `told` | what a page tells of each |
//! | `model` | a model with all its numbers, as `fit` and `diagnose` write it |
//! | `fault` | what can be wrong with one, with the remedy |
//! | `result` | what was found and how well it is known, from a fit, a diagnosis, a verification or a device's report |
//! | `result_fault` | what can be wrong with that |

mod fault;
mod file;
pub mod hypotheses;
mod hypotheses_error;
mod model;
mod result;
mod result_fault;
mod told;

pub use fault::ModelFault;
pub(crate) use fault::{json_place, number};
pub use file::{Kept, KeptError, KeptFault};
pub use hypotheses_error::{DiagnosisError, DiagnosisFault};
pub use model::{Integrator, KeptMachine, KeptModel, KeptParameter};
pub use result::{KeptEstimate, KeptResult};
pub use result_fault::{ResultError, ResultFault};
pub use told::{
    KeptBase, KeptCandidate, KeptContest, KeptCurve, KeptDiagnosis, KeptFinal, KeptFit,
    KeptHeldOut, KeptLine, KeptLoop, KeptMargins, KeptMiss, KeptPrinted, KeptRow, KeptRung,
    KeptSteady, KeptStep, KeptVariant, KeptVerification,
};
