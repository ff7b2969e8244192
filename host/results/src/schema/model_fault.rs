//! What can be wrong with a model in a result's JSON.

/// Why a model in a result cannot be used. The place is where it stands in the file, as in `models[0]`.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ModelFault {
    /// A number that no motor and no drive has.
    #[error("`{key}` is {value}, needed is {need}")]
    Number {
        /// Where it stands.
        key: String,
        /// What was seen.
        value: f64,
        /// What would do.
        need: &'static str,
    },
    /// An effect that is not in the catalogue.
    #[error("{place} has the effect `{name}`, which is unknown; {remedy}")]
    Effect {
        /// The model.
        place: String,
        /// The effect.
        name: String,
        /// The nearest name, or all of them.
        remedy: String,
    },
    /// A law that cannot be read.
    #[error("{place} states a law that cannot be read: {fault}")]
    Formula {
        /// The model.
        place: String,
        /// What is wrong, and where.
        fault: String,
    },
    /// A parameter that is not there.
    #[error("{place} lacks the parameter `{name}`")]
    Parameter {
        /// The model.
        place: String,
        /// The parameter, as in `coulomb.torque`.
        name: String,
    },
    /// A parameter in another unit than the model computes with.
    #[error(
        "{place} gives {name} in `{unit}`, needed is `{needed}` (torques in volts referred to the winding)"
    )]
    Unit {
        /// The model.
        place: String,
        /// The parameter.
        name: String,
        /// Its unit in the file.
        unit: String,
        /// The unit that the model computes with.
        needed: &'static str,
    },
}

/// A number that is finite and good.
///
/// # Errors
/// [`ModelFault::Number`] with `key` and what is needed.
pub(crate) fn number(
    key: &str,
    value: f64,
    good: bool,
    need: &'static str,
) -> Result<f64, ModelFault> {
    if good && value.is_finite() {
        return Ok(value);
    }
    Err(ModelFault::Number {
        key: key.to_owned(),
        value,
        need,
    })
}

/// Line, column and reason of JSON that cannot be read, for a message that begins with the place.
pub(crate) fn json_place(error: &serde_json::Error) -> (usize, usize, String) {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    let what = text.strip_suffix(&place).unwrap_or(&text).to_owned();
    (error.line(), error.column(), what)
}
