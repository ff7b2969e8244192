//! From the motor's side of a gear to the output's.
//!
//! With a ratio `N` (turns of the motor a turn of the output) and no loss: angles and speeds are divided by `N`, torques
//! and both motor constants multiplied, inertias, viscous frictions and spring rates multiplied by `N²` (any text on
//! gears; Ellis, *Control System Design Guide*, 2012, ch. 14). Torques stated as volts, `T·R/Kt`, stay what they are.
//! So the power of `N` follows from a unit: one for each radian below the line, less one for each above, where N·m
//! counts as one per radian (it is work per angle) and kg·m² as two.

use schemars::JsonSchema;
use serde::Serialize;
use servoid_formula::Dimension;

/// Which shaft the numbers speak of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(tag = "name", rename_all = "lowercase")]
pub enum Side {
    /// The shaft whose encoder was recorded.
    Motor,
    /// The shaft behind a gear.
    Output {
        /// Turns of the motor a turn of the output.
        ratio: f64,
    },
}

impl Side {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Side::Motor => "motor",
            Side::Output { .. } => "output",
        }
    }

    /// In words, with the ratio.
    pub fn words(self) -> String {
        match self {
            Side::Motor => "motor side".to_owned(),
            Side::Output { ratio } => {
                format!("output side, {ratio} turns of the motor a turn, gear without loss")
            }
        }
    }

    /// What a number in `unit` of the motor's side is multiplied by. `None` for an unknown unit.
    pub fn factor(self, unit: &str) -> Option<f64> {
        let power = match Dimension::parse(unit) {
            Ok(unit) => -unit.of_angle(),
            Err(_) => power(unit)?,
        };
        Some(match self {
            Side::Motor => 1.0,
            Side::Output { ratio } => ratio.powf(power),
        })
    }
}

/// Power of the ratio that a number takes on in a unit that is no product of V, rad, s and °C.
fn power(unit: &str) -> Option<f64> {
    Some(match unit {
        "A" | "ohm" | "H" | "1/(V^2*s)" | "count" => 0.0,
        "rad/(s*V)" => -1.0,
        "N*m" | "N*m/A" | "1/rev" | "count/rev" => 1.0,
        "kg*m^2" | "N*m*s/rad" => 2.0,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_identify::fit::physical::NAMES;
    use shared::effects::Kind;

    /// A machine behind a gear, reflected as a whole and number by number.
    #[test]
    fn every_unit_of_the_catalogue_and_of_the_six_is_known_and_the_machine_stays_consistent() {
        let side = Side::Output { ratio: 30.0 };
        let of_effects = Kind::ALL.iter().flat_map(|k| k.parameters());
        for unit in of_effects
            .map(|p| p.quantity.unit())
            .chain(NAMES.map(|n| n.1))
        {
            assert!(side.factor(unit).is_some(), "{unit}");
            assert_eq!(Side::Motor.factor(unit), Some(1.0));
        }
        let factor = |unit| side.factor(unit).expect("a unit");
        // J·R/Kt, f·R/Kt and the gain follow their parts; m/D is a time.
        assert_eq!(factor("kg*m^2") / factor("N*m/A"), factor("V*s^2/rad"));
        assert_eq!(factor("N*m*s/rad") / factor("N*m/A"), factor("V*s/rad"));
        assert!((factor("rad/(s*V)") * factor("V*s/rad") - 1.0).abs() < 1e-12);
        assert_eq!(factor("N*m") / factor("N*m/A"), factor("V"));
        assert_eq!(side.factor("furlong"), None);
        for (unit, power) in [
            ("1/rad", 1),
            ("V*s^2/rad^2", 2),
            ("1/s^2", 0),
            ("rad^2/degC", -2),
        ] {
            assert!(
                (factor(unit) / 30.0f64.powi(power) - 1.0).abs() < 1e-12,
                "{unit}"
            );
        }
    }
}
