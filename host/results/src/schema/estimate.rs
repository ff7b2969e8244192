//! What a fit says of a motor: parameters with their errors, response, margins.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::fit::{self, Parameter, margins};
use shared::motor::Response;

/// One number of a result with its error.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Estimate {
    /// Its name; an effect's parameters carry its name before a point.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Standard deviation; null where the data do not determine one.
    pub std: Option<f64>,
    /// Whether the data (with the known facts) determine it.
    pub identifiable: bool,
    /// Standard deviation of the values that several recordings give, each fitted alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spread: Option<f64>,
    /// Whether a bound of its search range holds it: then it has no standard deviation. Absent where not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub at_bound: bool,
    /// The value in the unit in which such a quantity is usually stated, where that is another one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub usual: Option<Usual>,
    /// What the value would change by if the recording is not what it says; absent where not determined, and of results without it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub systematic: Vec<Systematic>,
}

/// What a value would change by if something is wrong with the recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Systematic {
    /// What is wrong: `latency`, `encoder_edges` or `command_scale`.
    pub cause: String,
    /// By how much: s, counts RMS, or a part of the command.
    pub size: f64,
    /// Unit of the size: `s`, `count` or `1`.
    pub size_unit: String,
    /// Change of the value, in its unit; without a sign where the cause has several parts that depend on their squares.
    pub change: f64,
}

/// A value in the unit in which such a quantity is usually stated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Usual {
    /// The value.
    pub value: f64,
    /// Its unit: `% of stall torque`, `count` or `rpm`.
    pub unit: String,
}

impl From<&Parameter> for Estimate {
    fn from(p: &Parameter) -> Self {
        Estimate {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit.to_owned(),
            std: p.std,
            identifiable: p.identifiable,
            spread: p.spread.and_then(finite),
            at_bound: p.at_bound,
            usual: p.usual.map(|usual| Usual {
                value: usual.value,
                unit: usual.unit.to_owned(),
            }),
            systematic: p.systematic.iter().map(Systematic::from).collect(),
        }
    }
}

impl From<&fit::Systematic> for Systematic {
    fn from(systematic: &fit::Systematic) -> Self {
        let fit::Systematic { cause, change } = *systematic;
        Systematic {
            cause: cause.name().to_owned(),
            size: cause.size(),
            size_unit: cause.unit().to_owned(),
            change,
        }
    }
}

/// What voltage and angle determine of the linear motor.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Identifiable {
    /// Speed per volt, rad/(s·V).
    pub gain_rad_s_v: Option<f64>,
    /// Coefficient of `s`, s.
    pub a1_s: Option<f64>,
    /// Coefficient of `s²`, s².
    pub a2_s2: Option<f64>,
}

impl From<Response<f64>> for Identifiable {
    fn from(response: Response<f64>) -> Self {
        Identifiable {
            gain_rad_s_v: finite(response.gain),
            a1_s: finite(response.a1),
            a2_s2: finite(response.a2),
        }
    }
}

/// Margins of the position loop in radians with unity feedback.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Margins {
    /// Gain margin, dB; null where infinite.
    pub gain_db: Option<f64>,
    /// Phase margin, degrees.
    pub phase_deg: f64,
}

impl From<margins::Margins> for Margins {
    fn from(margins: margins::Margins) -> Self {
        Margins {
            gain_db: finite(margins.gain_db),
            phase_deg: margins.phase_deg,
        }
    }
}

/// Coefficients of the position loop's denominator `s·(a3·s² + a2·s + a1)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PositionLoop {
    /// V·s³/rad.
    pub a3: f64,
    /// V·s²/rad.
    pub a2: f64,
    /// V·s/rad.
    pub a1: f64,
}

impl From<margins::Loop> for PositionLoop {
    fn from(margins::Loop { a3, a2, a1 }: margins::Loop) -> Self {
        PositionLoop { a3, a2, a1 }
    }
}

impl From<PositionLoop> for margins::Loop {
    fn from(PositionLoop { a3, a2, a1 }: PositionLoop) -> Self {
        margins::Loop { a3, a2, a1 }
    }
}
