//! What can be wrong with a model before it runs. Running it cannot fail.

use core::fmt;

/// Why a model cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ModelError {
    /// A parameter is NaN, infinite or of the wrong sign.
    Parameter {
        /// Its name.
        name: &'static str,
        /// What was given.
        value: f64,
    },
    /// A per-unit coefficient does not fit the number format; other bases or a float would do.
    Range {
        /// What it multiplies.
        name: &'static str,
        /// Its per-unit value.
        value: f64,
        /// The largest magnitude that fits.
        limit: f64,
    },
    /// The dynamics are too fast to discretise at this sample interval (time constants below
    /// a millionth of a millionth of it).
    TooFast,
    /// An effect depends on the temperature, and nothing tells it.
    NoTemperature {
        /// The effect.
        name: &'static str,
    },
    /// More effects than the set holds.
    TooManyEffects {
        /// How many fit.
        limit: usize,
    },
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            ModelError::Parameter { name, value } => {
                write!(f, "{name} = {value} is not a physical value")
            }
            ModelError::Range { name, value, limit } => write!(
                f,
                "{name} = {value} per unit is beyond {limit}, which this number format can hold; \
                 choose larger bases or a floating-point format"
            ),
            ModelError::TooFast => {
                write!(
                    f,
                    "the motor's time constants are too short for this sample interval"
                )
            }
            ModelError::NoTemperature { name } => write!(
                f,
                "{name} depends on the temperature, which nothing tells here; give recordings that each have a column of it"
            ),
            ModelError::TooManyEffects { limit } => {
                write!(f, "at most {limit} effects fit into one model")
            }
        }
    }
}

impl core::error::Error for ModelError {}
