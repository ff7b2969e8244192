//! How far off a found value is from what the bench hides.
//!
//! The bench and the model share no code; this is the one thing between them. What is hidden states itself in the
//! model's terms ([`Hidden::truth`](servoid_plant::Hidden::truth)): a torque is the volts that the winding spends
//! on it (`R/Kt` times the torque), a current the volts across the resistance.

use serde::{Deserialize, Serialize};
use servoid_plant::Machine;
use shared::effects::{Kind, Pair};
use shared::motor::Physical;

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
/// vector; of parameters whose common part the machine can take only the difference; nothing is compared with a truth of zero.
pub fn errors(kind: Kind, found: &[f64], truth: &[f64]) -> Vec<ParameterError> {
    let error = |parameter: &str, size: bool, distance: f64, of: f64| ParameterError {
        effect: kind.name().to_owned(),
        parameter: parameter.to_owned(),
        size,
        percent: 100.0 * distance / of.abs(),
    };
    let parameters = kind.parameters();
    let (mut errors, rest) = match (kind.facts().pair, found, truth) {
        (Some(Pair::CosineAndSine), [a, b, ..], [x, y, ..]) => {
            let distance = (a - x).hypot(b - y);
            (vec![error("amplitude", true, distance, x.hypot(*y))], 2)
        }
        (Some(Pair::Difference), [a, b, ..], [x, y, ..]) => {
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
    use servoid_plant::effects::CATALOGUE;
    use servoid_plant::{Hidden, PRESETS};
    use std::collections::BTreeSet;

    #[test]
    fn the_model_and_the_bench_list_the_same_effects() {
        let of_model: BTreeSet<&str> = Kind::ALL.iter().map(|kind| kind.name()).collect();
        let of_bench: BTreeSet<&str> = CATALOGUE.iter().map(|kind| kind.name).collect();
        assert_eq!(of_model, of_bench);
        assert_eq!(
            (Kind::ALL.len(), CATALOGUE.len()),
            (of_model.len(), of_bench.len())
        );
    }

    #[test]
    fn every_effect_has_a_counterpart_that_is_right_where_it_is_found() {
        for name in PRESETS {
            let machine = Machine::preset(name).unwrap();
            for &kind in Kind::ALL {
                let hidden = Hidden::typical(kind.name(), &machine).unwrap();
                let truth = hidden.truth(&machine, 2000);
                assert_eq!(truth.len(), kind.parameters().len(), "{kind:?}");
                let errors = errors(kind, &truth, &truth);
                // A limit has no size: it is reached or it is not.
                let sized = kind
                    .parameters()
                    .iter()
                    .any(|parameter| parameter.amplitude);
                assert!(errors.iter().any(|error| error.size || !sized));
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
            let truth = hidden.truth(&machine, 2000);
            let doubled: Vec<f64> = truth.iter().map(|value| 2.0 * value).collect();
            for error in errors(kind, &doubled, &truth) {
                assert!((error.percent - 100.0).abs() < 1e-9, "{error:?}");
            }
        }
    }
}
