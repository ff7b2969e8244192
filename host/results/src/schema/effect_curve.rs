//! An effect beside a curve that was found without its form.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::discovery::{Curve, CurvePoint as Point};

/// Drive that an effect asks for along the variable that carries it, beside what the fitted recording asks for without its form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct EffectCurve {
    /// The variable: `speed`, `angle` or `current` (as the voltage across the resistance).
    pub variable: String,
    /// Its unit.
    pub unit: String,
    /// Part of the effect's variance that this variable carries, per cent.
    pub carried_percent: f64,
    /// By rising values of the variable.
    pub points: Vec<CurvePoint>,
    /// Range of the variable in which the recording's curve leaves its band around the law; absent where it does not.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub leaves: Option<[f64; 2]>,
}

/// One point of the curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct CurvePoint {
    /// Value of the variable.
    pub at: f64,
    /// Drive that the law asks for, V: a torque against positive rotation counts positive.
    pub law_v: f64,
    /// Drive that the recording asks for, V.
    pub found_v: f64,
    /// Half of the band of 95 % around it, V.
    pub band_v: f64,
}

impl From<&Curve> for EffectCurve {
    fn from(curve: &Curve) -> Self {
        let point = |point: &Point| CurvePoint {
            at: point.at,
            law_v: point.law,
            found_v: point.found,
            band_v: point.band,
        };
        EffectCurve {
            variable: curve.carrier.name().to_owned(),
            unit: curve.carrier.unit().to_owned(),
            carried_percent: 100.0 * curve.carried,
            points: curve.points.iter().map(point).collect(),
            leaves: curve.leaves(),
        }
    }
}
