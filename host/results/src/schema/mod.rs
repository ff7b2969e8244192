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
//! | `likelihood` | the fit with process noise, in a `servoid.fit/1` |
//! | `lack_of_fit` | what repeats of a command say of a model |
//! | `steady` | `servoid.diagnosis/1` of a curve of steady speeds |
//! | `contest` | `servoid.compare/1`, of `compare` and of `paper` |
//! | `plan` | `servoid.plan/1` |
//! | `device` | `servoid.device/1`, the report of a device's run |
//! | `verification` | `servoid.verify/1` |
//! | `proof` | `servoid.prove/1` |
//! | `coverage` | `servoid.coverage/1` |
//! | `model` | a model with all its numbers, which runs again |
//! | `position_loop` | the position loop that made the volts of a recording |
//! | `estimate` | parameters with their errors, response, margins |
//! | `identified` | what an export needs of any of these: the model, and how well each number is known |
//! | `hypotheses` | what a plan needs of a diagnosis: the models that explain the data alike |
//! | `opened` | `servoid.open/1`, what a log holds |
//! | `effects` | `servoid.effects/1`, what can be told of effects |
//! | `partial` | the keys that these two look for in files of any version |

pub mod certificate;
pub mod check;
pub mod contest;
pub mod coverage;
pub mod device;
pub mod diagnosis;
mod document;
pub mod effect_curve;
pub mod effects;
pub mod estimate;
pub mod fit;
pub mod hypotheses;
mod hypotheses_fault;
mod identified;
mod identified_fault;
pub mod lack_of_fit;
pub mod likelihood;
mod model;
mod model_fault;
pub mod opened;
mod partial;
pub mod plan;
pub mod position_loop;
pub mod profile;
pub mod proof;
pub mod read;
mod recording_error;
pub mod residual;
pub mod steady;
pub mod verification;

pub use contest::Contest;
pub use device::DeviceRun;
pub use diagnosis::{Diagnosis, ProposedLaw};
pub use document::{Document, DocumentError, DocumentFault};
pub use estimate::{Estimate, Margins};
pub use fit::{Demo, Fit};
pub use hypotheses_fault::{DiagnosisError, DiagnosisFault};
pub use identified::{Graded, Identified};
pub use identified_fault::{ResultError, ResultFault};
pub use likelihood::Likelihood;
pub use model::{Integrator, Machine, Model, ModelParameter};
pub use model_fault::ModelFault;
pub(crate) use model_fault::{json_place, number};
pub use plan::Plan;
pub use position_loop::PositionLoop;
pub use proof::Proof;
pub use recording_error::RecordingError;
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

/// Keys that stand in the object itself and only some verbs write: `None` where there are none. Serde alone would take a
/// wrong type among them for their absence.
fn flattened<'de, T, D>(from: D) -> Result<Option<T>, D::Error>
where
    T: Deserialize<'de> + Default + PartialEq,
    D: Deserializer<'de>,
{
    let keys = T::deserialize(from)?;
    Ok(Some(keys).filter(|keys| *keys != T::default()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde::Serialize;

    /// Results as the first version wrote them, with fewer elements in their lists. Never to be written anew: they stand
    /// for the files that users have.
    macro_rules! document {
        ($name:literal) => {
            include_str!(concat!("../../tests/documents/", $name, ".json"))
        };
    }

    fn again<T: Serialize + for<'de> Deserialize<'de>>(name: &str, text: &str) {
        let read: T = serde_json::from_str(text).expect(name);
        let mut written = serde_json::to_string_pretty(&read).expect(name);
        written.push('\n');
        for (line, (is, was)) in written.lines().zip(text.lines()).enumerate() {
            assert_eq!(is, was, "{name}.json:{}", line + 1);
        }
        assert_eq!(written.len(), text.len(), "{name}");
    }

    #[test]
    fn what_was_written_is_read_and_written_again_to_the_byte() {
        again::<Fit>("fit", document!("fit"));
        again::<Demo>("demo", document!("demo"));
        again::<Diagnosis>("diagnosis", document!("diagnosis"));
        again::<Steady>("steady", document!("steady"));
        again::<Plan>("plan", document!("plan"));
        again::<Proof>("prove", document!("prove"));
        again::<DeviceRun>("device", document!("device"));
        again::<Verification>("verify", document!("verify"));
        again::<Contest>("compare", document!("compare"));
        again::<Contest>("paper", document!("paper"));
    }

    #[test]
    fn every_document_is_known_by_its_schema() {
        let kinds = [
            (document!("fit"), "Fit"),
            (document!("demo"), "Demo"),
            (document!("diagnosis"), "Diagnosis"),
            (document!("steady"), "Steady"),
            (document!("compare"), "Contest"),
            (document!("paper"), "Contest"),
            (document!("verify"), "Verification"),
        ];
        for (text, kind) in kinds {
            let value = serde_json::from_str(text).expect("JSON");
            let document = format!("{:?}", Document::from_json(value).expect(kind));
            assert!(document.starts_with(kind), "{kind}: {document}");
        }
    }

    #[test]
    fn a_wrong_type_is_refused_with_the_path_to_its_key() {
        let mut value: serde_json::Value = serde_json::from_str(document!("paper")).expect("JSON");
        value["rows"][1]["median_cost"] = "much".into();
        let fault = Document::from_json(value)
            .expect_err("a wrong type")
            .to_string();
        assert!(fault.contains("rows[1]"), "{fault}");
        let mut value: serde_json::Value =
            serde_json::from_str(document!("diagnosis")).expect("JSON");
        value["steps"][0]["candidates"][0]["effect"] = 1.into();
        let fault = Document::from_json(value)
            .expect_err("a wrong type")
            .to_string();
        assert!(fault.contains("steps[0].candidates[0].effect"), "{fault}");
    }
}
