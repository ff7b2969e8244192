//! What the cases of a file are: its first line.

use super::SetUp;
use serde::{Deserialize, Serialize};

/// Schema of the file.
const SCHEMA: &str = "servoid.prove-cases/1";
/// How the line that says what the cases are begins.
pub(super) const HEADER: &str = "{\"schema\"";

/// What the cases of a file are.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    schema: String,
    /// Version of the program that proved them.
    pub version: String,
    /// What they follow from.
    pub set_up: SetUp,
}

impl Header {
    /// For cases of this program.
    pub fn new(set_up: &SetUp) -> Header {
        Header {
            schema: SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            set_up: set_up.clone(),
        }
    }

    /// How `other` differs, in the words of the flags; `None` if it does not.
    pub(super) fn difference(&self, other: &Header) -> Option<String> {
        let (a, b) = (&self.set_up, &other.set_up);
        let of = |a: &[String]| {
            if a.is_empty() {
                "all".to_owned()
            } else {
                a.join(",")
            }
        };
        let pairs = [
            ("schema", self.schema.clone(), other.schema.clone()),
            ("version", self.version.clone(), other.version.clone()),
            ("--seed", a.seed.to_string(), b.seed.to_string()),
            ("--hidden", a.hidden.name(), b.hidden.name()),
            ("--excite", a.excite.name(), b.excite.name()),
            ("--effect", of(&a.effects), of(&b.effects)),
            ("--law", a.laws.name(), b.laws.name()),
            ("--discover", a.discover.to_string(), b.discover.to_string()),
        ];
        let differences: Vec<String> = pairs
            .into_iter()
            .filter(|(_, wanted, there)| wanted != there)
            .map(|(what, wanted, there)| format!("{what} {there}, not {wanted}"))
            .collect();
        (!differences.is_empty()).then(|| differences.join("; "))
    }
}
