//! What each effect of the catalogue leaves in a recording, for a bench on which nothing lies yet: drawn of the virtual bench's motor.

use super::proposals::drawn;
use crate::error::Error;
use rayon::prelude::*;
use serde_json::{Value, json};
use servoid_engine::problem::Data;
use servoid_engine::simulation::Method;
use servoid_identify::diagnose::residual_analysis::signature;
use servoid_identify::truth;
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;

/// Every effect with its signature, if a quantity tells it.
///
/// # Errors
/// A bench that does not run.
pub(super) fn effects() -> Result<Value, Error> {
    let entries: Result<Vec<Value>, Error> =
        Kind::ALL.par_iter().map(|&kind| entry(kind)).collect();
    Ok(Value::Array(entries?))
}

fn entry(kind: Kind) -> Result<Value, Error> {
    let machine = showcase::machine();
    let hidden = Hidden::typical(kind.name(), &machine)?;
    let recording = showcase::record(&hidden, 1, kind.name())?;
    let candidate = truth::model(
        &machine,
        std::slice::from_ref(&hidden),
        showcase::COUNTS_PER_REV,
    )?;
    let found = signature(&Data::new(&recording)?, &candidate, kind, Method::default());
    let description = kind.description();
    Ok(json!({
        "effect": kind.name(),
        "title": description.title,
        "said": description.signature,
        "signature": found.as_ref().map(drawn),
    }))
}
