//! The results of all verbs as JSON: each type once, written and read.
//!
//! Keys are only ever added. A key that files of older versions lack has a default or is an `Option`, so that they stay
//! readable; a number that need not be finite is an `Option`, `null` where there is none.
//!
//! | file | holds |
//! |---|---|
//! | `document` | one result of any verb, read from its file |
//! | `fit` | `servoid.fit/1`, of `fit` and of `demo` |
//! | `diagnosis`, `residual` | `servoid.diagnosis/1` of two recordings, and where its models fail |
//! | `steady` | `servoid.diagnosis/1` of a curve of steady speeds |
//! | `contest` | `servoid.compare/1`, of `compare` and of `paper` |
//! | `plan` | `servoid.plan/1` |
//! | `device` | `servoid.device/1`, the report of a device's run |
//! | `verification` | `servoid.verify/1` |
//! | `proof` | `servoid.prove/1` |
//! | `model` | a model with all its numbers, which runs again |
//! | `estimate` | parameters with their errors, response, margins |
//! | `identified` | what an export needs of any of these: the model, and how well each number is known |
//! | `hypotheses` | what a plan needs of a diagnosis: the models that explain the data alike |
//! | `partial` | the keys that these two look for in files of any version |
//! | `reference` | all of these as JSON Schema |

pub mod contest;
pub mod device;
pub mod diagnosis;
mod document;
pub mod estimate;
pub mod fit;
pub mod hypotheses;
mod hypotheses_fault;
mod identified;
mod identified_fault;
mod model;
mod model_fault;
mod partial;
pub mod plan;
pub mod proof;
pub mod reference;
pub mod residual;
pub mod steady;
pub mod verification;

pub use contest::Contest;
pub use device::DeviceRun;
pub use diagnosis::Diagnosis;
pub use document::{Document, DocumentError, DocumentFault};
pub use estimate::{Estimate, Margins};
pub use fit::{Demo, Fit};
pub use hypotheses_fault::{DiagnosisError, DiagnosisFault};
pub use identified::Identified;
pub use identified_fault::{ResultError, ResultFault};
pub use model::{Integrator, Machine, Model, ModelParameter};
pub use model_fault::ModelFault;
pub(crate) use model_fault::{json_place, number};
pub use plan::Plan;
pub use proof::Proof;
pub use residual::Residual;
pub use steady::Steady;
pub use verification::Verification;

use serde::{Deserialize, Deserializer};

/// Version of the program that writes a result.
pub(crate) const VERSION: &str = env!("CARGO_PKG_VERSION");

/// A number, or `null` where there is none.
pub(crate) fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

/// Keys that stand in the object itself and only some verbs write. Serde alone would take a wrong type among them for
/// their absence.
fn flattened<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    from: D,
) -> Result<Option<T>, D::Error> {
    T::deserialize(from).map(Some)
}
