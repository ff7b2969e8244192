//! What the bench hides, in the model's terms, and how far off a found value is.
//!
//! The bench and the model share no code; this is the one thing between them. Torques of the model are the
//! volts that the winding spends on them (`R/Kt` times the torque), currents the volts across the resistance.

use serde::{Deserialize, Serialize};
use servoid_plant::{Hidden, Machine};
use shared::effects::Kind;
use shared::motor::Physical;
use std::f64::consts::TAU;

/// The bench's machine in the model's terms.
pub fn physical(machine: &Machine) -> Physical<f64> {
    Physical {
        resistance: machine.resistance_ohm,
        inductance: machine.inductance_h,
        kt: machine.kt_n_m_a,
        kb: machine.kb_v_s_rad,
        inertia: machine.inertia_kg_m2,
        viscous: machine.viscous_n_m_s,
    }
}

/// True values of the model's parameters for `hidden` in `machine`, in the order of the effect's
/// description; `None` for an effect that has no counterpart.
pub fn parameters(hidden: &Hidden, machine: &Machine, counts_per_rev: u32) -> Option<Vec<f64>> {
    let p = |key: &str| {
        let mut all = hidden.parameters();
        all.find(|(name, ..)| *name == key)
            .map(|(_, value, _)| value)
    };
    let r = machine.resistance_ohm;
    let supply = machine.supply_v;
    let inertia = machine.inertia_kg_m2;
    let volts = |torque: f64| torque * r / machine.kt_n_m_a;
    // A·sin(angle + φ) as its parts of cosine and sine.
    let parts = |amplitude: f64, phase: f64| vec![amplitude * phase.sin(), amplitude * phase.cos()];
    Some(match hidden.name() {
        "coulomb" | "load_torque" => vec![volts(p("torque")?)],
        "asym_coulomb" | "asym_viscous" => vec![volts(p("forward")?), volts(p("backward")?)],
        "stribeck" => vec![
            volts(p("coulomb")?),
            volts(p("extra")?),
            p("speed")?,
            p("exponent")?,
        ],
        "windage" => vec![volts(p("drag")?)],
        "cogging" => {
            let mut values = parts(volts(p("torque")?), p("phase")?);
            values.push(p("order")?);
            values
        }
        "unbalance" => parts(volts(p("torque")?), p("phase")?),
        "backlash" => vec![
            p("gap")?,
            p("load_share")?,
            1.0 / p("contact_hz")?,
            p("damping")?,
        ],
        "compliance" => {
            let share = p("load_share")?;
            let reduced = share * (1.0 - share) * inertia;
            let period = TAU * (p("compliance")? * reduced).sqrt();
            vec![period, share, p("damping")?]
        }
        "brush_drop" => vec![p("drop")?, p("knee")? * r],
        "dead_zone" => vec![p("width")?],
        "supply_sag" => vec![p("resistance")? / r / (supply * supply)],
        "voltage_sat" => vec![supply - p("lost")?],
        "torque_sat" => vec![p("cubic")? / (r * r)],
        "l_sat" => vec![p("falloff")? / (r * r)],
        // dΔT/dt = (Rth·R(1 + αΔT)·i² − ΔT)/τ with y = α·ΔT and c = R·i.
        "heating" => vec![
            p("copper")? * p("thermal_resistance")? / (r * p("time_constant")?),
            p("time_constant")?,
            p("magnet")? / p("copper")?,
        ],
        "delay" => vec![p("time")?],
        "enc_ecc" => parts(p("amplitude")?, p("phase")?),
        "missed_counts" => {
            // Mean size of a burst, and bursts per radian.
            let size = (1.0 + p("largest")?) / 2.0;
            let per_rad = p("rate")? / machine.top_speed_rad_s();
            vec![size * per_rad * TAU / f64::from(counts_per_rev), 0.0]
        }
        "offset_voltage" => vec![p("offset")?],
        "lugre" => {
            let torque = p("coulomb")?;
            let stiffness = torque * (1.0 + p("extra")?) / p("presliding")?;
            let damping = 2.0 * p("damping")? * (stiffness * inertia).sqrt();
            vec![
                volts(torque),
                p("extra")?,
                p("speed")?,
                p("presliding")?,
                damping / stiffness,
            ]
        }
        "load_friction" => vec![p("share")?],
        _ => return None,
    })
}

/// How far a found value is from the true one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterError {
    /// The effect.
    pub effect: String,
    /// What was compared: a parameter of the model, or what it determines of several.
    pub parameter: String,
    /// Whether it is the effect's size; else it is its shape, which a recording may hardly determine.
    pub size: bool,
    /// Distance from the truth, per cent of the truth.
    pub percent: f64,
}

/// Errors of the `found` values of an effect's parameters. Amplitudes of cosine and sine are compared as one
/// vector; of viscous friction in two directions only the difference, since the machine's own can take any
/// common part; nothing is compared with a truth of zero.
pub fn errors(kind: Kind, found: &[f64], truth: &[f64]) -> Vec<ParameterError> {
    let error = |parameter: &str, size: bool, distance: f64, of: f64| ParameterError {
        effect: kind.name().to_owned(),
        parameter: parameter.to_owned(),
        size,
        percent: 100.0 * distance / of.abs(),
    };
    let parameters = kind.description().parameters;
    let (mut errors, rest) = match (kind, found, truth) {
        (Kind::Cogging | Kind::Unbalance | Kind::EncEcc, [a, b, ..], [x, y, ..]) => {
            let distance = (a - x).hypot(b - y);
            (vec![error("amplitude", true, distance, x.hypot(*y))], 2)
        }
        (Kind::AsymViscous, [a, b, ..], [x, y, ..]) => {
            let distance = ((a - b) - (x - y)).abs();
            (vec![error("difference", true, distance, x - y)], 2)
        }
        _ => (Vec::new(), 0),
    };
    let each = parameters.iter().zip(found.iter().zip(truth)).skip(rest);
    errors.extend(each.map(|(parameter, (found, truth))| {
        error(
            parameter.name,
            parameter.amplitude,
            (found - truth).abs(),
            *truth,
        )
    }));
    errors.retain(|error| error.percent.is_finite());
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_plant::PRESETS;

    #[test]
    fn every_effect_has_a_counterpart_that_is_right_where_it_is_found() {
        for name in PRESETS {
            let machine = Machine::preset(name).unwrap();
            for &kind in Kind::ALL {
                let hidden = Hidden::typical(kind.name(), &machine).unwrap();
                let truth = parameters(&hidden, &machine, 2000).unwrap();
                assert_eq!(truth.len(), kind.description().parameters.len(), "{kind:?}");
                let errors = errors(kind, &truth, &truth);
                assert!(
                    errors
                        .iter()
                        .any(|error| error.size || kind == Kind::VoltageSat)
                );
                assert!(
                    errors.iter().all(|error| error.percent == 0.0),
                    "{errors:?}"
                );
            }
        }
    }

    #[test]
    fn a_value_twice_as_large_is_off_by_a_hundred_per_cent() {
        let machine = Machine::gearmotor();
        for &kind in Kind::ALL {
            let hidden = Hidden::typical(kind.name(), &machine).unwrap();
            let truth = parameters(&hidden, &machine, 2000).unwrap();
            let doubled: Vec<f64> = truth.iter().map(|value| 2.0 * value).collect();
            for error in errors(kind, &doubled, &truth) {
                assert!((error.percent - 100.0).abs() < 1e-9, "{error:?}");
            }
        }
    }
}
