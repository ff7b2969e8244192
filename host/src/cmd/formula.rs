//! Laws that the user states by --effect and --effects.

use crate::cli::FormulaArgs;
use crate::error::Error;
use serde::Deserialize;
use shared::effects::Kind;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The file of --effects: laws by their names.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    effects: BTreeMap<String, String>,
}

/// The laws that are stated, each as an effect.
pub(super) fn stated(args: &FormulaArgs) -> Result<Vec<Kind>, Error> {
    let mut kinds = Vec::new();
    for text in &args.effect {
        kinds.push(define("--effect", text)?);
    }
    for path in &args.effects {
        for text in texts(path)? {
            kinds.push(define(&format!("--effects {}", path.display()), &text)?);
        }
    }
    for (place, kind) in kinds.iter().enumerate() {
        if kinds[..place]
            .iter()
            .any(|other| other.name() == kind.name())
        {
            return Err(Error::Usage(format!(
                "two laws are called `{}`; give one of them another name",
                kind.name()
            )));
        }
    }
    Ok(kinds)
}

fn define(flag: &str, text: &str) -> Result<Kind, Error> {
    servoid_formula::define(text).map_err(|fault| Error::Usage(format!("{flag}: {fault}")))
}

fn texts(path: &Path) -> Result<Vec<String>, Error> {
    let wrong = |what: String| {
        Error::Usage(format!(
            "--effects {}: {what}; expected is a table of laws by their names, such as\n  [effects]\n  gear = \"torque = \
             -c*w*abs(w); c in [0, 1e-3] V*s^2/rad^2\"",
            path.display()
        ))
    };
    let text = fs::read_to_string(path).map_err(|error| wrong(error.to_string()))?;
    let file: File = toml::from_str(&text).map_err(|error| wrong(error.message().to_owned()))?;
    let laws = file.effects.into_iter();
    Ok(laws.map(|(name, law)| format!("{name}: {law}")).collect())
}
