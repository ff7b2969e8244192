//! The motor of a case.

use super::draws::{Draws, rounded};
use serde::{Deserialize, Serialize};
use servoid_plant::{BenchError, Machine, PRESETS};

/// Share of the cases whose motor is one of the presets.
const PRESET_SHARE: f64 = 0.2;
/// Supply, V.
const SUPPLY_V: (f64, f64) = (6.0, 80.0);
/// Armature resistance, Ω.
const RESISTANCE_OHM: (f64, f64) = (0.3, 10.0);
/// Electrical time constant L/R, s.
const ELECTRICAL_S: (f64, f64) = (0.05e-3, 20e-3);
/// Mechanical time constant RJ/K², s.
const MECHANICAL_S: (f64, f64) = (5e-3, 0.3);
/// No-load speed on the full supply, rad/s.
const TOP_RAD_S: (f64, f64) = (50.0, 1200.0);
/// Viscous friction as a part of the damping by the back-EMF, K²/R.
const VISCOUS_PART: (f64, f64) = (0.005, 0.05);

/// A motor with its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motor {
    /// Name of a preset, or `drawn`.
    pub name: String,
    /// The bench's machine.
    #[serde(flatten)]
    pub machine: Machine,
}

impl Motor {
    /// Draws a motor: a preset now and then, else every size log-uniform around those of the presets.
    ///
    /// # Errors
    /// None, as long as every listed preset exists.
    pub fn draw(draws: &mut Draws) -> Result<Motor, BenchError> {
        if draws.chance(PRESET_SHARE) {
            let name = draws.pick(PRESETS).unwrap_or_default();
            return Ok(Motor {
                name: name.to_owned(),
                machine: Machine::preset(name)?,
            });
        }
        let mut within = |(low, high)| draws.log_uniform(low, high);
        let supply_v = within(SUPPLY_V);
        let resistance_ohm = within(RESISTANCE_OHM);
        let electrical_s = within(ELECTRICAL_S);
        let mechanical_s = within(MECHANICAL_S);
        let top_rad_s = within(TOP_RAD_S);
        let viscous_part = within(VISCOUS_PART);
        // The no-load speed is V/(K·(1 + part)) where Kt = Kb = K.
        let k = rounded(supply_v / (top_rad_s * (1.0 + viscous_part)));
        Ok(Motor {
            name: "drawn".to_owned(),
            machine: Machine {
                supply_v,
                resistance_ohm,
                inductance_h: rounded(electrical_s * resistance_ohm),
                kt_n_m_a: k,
                kb_v_s_rad: k,
                inertia_kg_m2: rounded(mechanical_s * k * k / resistance_ohm),
                viscous_n_m_s: rounded(viscous_part * k * k / resistance_ohm),
            },
        })
    }
}
