//! How far off a found value is from what the bench hides.
//!
//! The bench and the model share no code; this is the one thing between them. What is hidden states itself in the
//! model's terms ([`Hidden::truth`](servoid_plant::Hidden::truth)): a torque is the volts that the winding spends
//! on it (`R/Kt` times the torque), a current the volts across the resistance.

use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Candidate;
use servoid_plant::{Hidden, Machine};
use shared::effects::{EffectSet, Form, Kind, Pair};
use shared::error::ModelError;
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

/// The bench's machine with effects hidden in it, as the model that is true of it.
///
/// # Errors
/// Values that are none of an effect's; [`ModelError::TooManyEffects`].
pub fn model(
    machine: &Machine,
    hidden: &[Hidden],
    counts_per_rev: u32,
) -> Result<Candidate, ModelError> {
    let mut effects = EffectSet::default();
    for hidden in hidden {
        if let Some(kind) = Kind::by_name(hidden.name()) {
            effects.push(kind, &hidden.truth(machine, counts_per_rev))?;
        }
    }
    Ok(Candidate {
        machine: physical(machine).machine(),
        effects,
        start_speed: 0.0,
        start_offset: 0.0,
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
            let distance = libm::hypot(a - x, b - y);
            (
                vec![error("amplitude", true, distance, libm::hypot(*x, *y))],
                2,
            )
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

/// Most steps towards an effect's parameters.
const STEPS: usize = 60;
/// Parts of a parameter by which it is moved to see what it does.
const MOVED: f64 = 1e-5;
/// Largest part by which what is found may be off.
const OFF: f64 = 1e-4;
/// Friction of the bench's load: see [`share_friction`].
const FRICTION: &str = "friction";
/// A parameter that is a whole number.
const ORDER: &str = "order";

/// The effect of the bench whose truth is `values`, but for their form: the inverse of
/// [`Hidden::truth`](servoid_plant::Hidden::truth), by Gauss and Newton's method. `None` where no parameters of the bench make them.
pub fn hidden(
    kind: Kind,
    values: &[f64],
    machine: &Machine,
    counts_per_rev: u32,
) -> Option<Hidden> {
    let mut hidden = Hidden::typical(kind.name(), machine).ok()?;
    if let Some(order) = kind.facts().periodic.and_then(|order| order.of(values)) {
        // Of what repeats once a revolution there is nothing to set.
        let _ = hidden.set(ORDER, order as f64);
    }
    let parameters = kind.parameters();
    let typical = hidden.truth(machine, counts_per_rev);
    let size = |k: usize| values[k].abs().max(1e-3 * typical[k].abs()).max(1e-12);
    let off = |hidden: &Hidden| {
        let truth = hidden.truth(machine, counts_per_rev);
        DVector::from_iterator(
            parameters.len(),
            (0..parameters.len()).map(|k| match parameters[k].form {
                // Of forms the bench has few.
                Some(_) => 0.0,
                None => (truth[k] - values[k]) / size(k),
            }),
        )
    };
    let keys: Vec<(&str, f64)> = (hidden.parameters())
        .filter(|(name, ..)| *name != ORDER && *name != FRICTION)
        .map(|(name, value, _)| (name, value.abs()))
        .collect();
    let mut here = off(&hidden);
    for _ in 0..STEPS {
        if here.amax() < 0.01 * OFF {
            break;
        }
        let now: Vec<f64> = current(&hidden, &keys);
        let mut slopes = DMatrix::zeros(here.len(), keys.len());
        for (k, (name, typical)) in keys.iter().enumerate() {
            let step = MOVED * typical.max(now[k].abs()).max(1e-9);
            let mut moved = hidden.clone();
            let signed = if moved.set(name, now[k] + step).is_ok() {
                step
            } else if moved.set(name, now[k] - step).is_ok() {
                -step
            } else {
                continue;
            };
            slopes.set_column(k, &((off(&moved) - &here) / signed));
        }
        let towards = slopes.svd(true, true).solve(&here, 1e-12).ok()?;
        let mut part = 1.0;
        let next = loop {
            let mut tried = hidden.clone();
            let set = keys.iter().enumerate().all(|(k, (name, _))| {
                let value = now[k] - part * towards[k];
                value == now[k] || tried.set(name, value).is_ok()
            });
            let there = off(&tried);
            if set && there.norm() < here.norm() {
                break Some((tried, there));
            }
            part *= 0.5;
            if part < 1e-6 {
                break None;
            }
        };
        let Some((better, there)) = next else { break };
        (hidden, here) = (better, there);
    }
    (here.amax() < OFF).then_some(hidden)
}

/// Moves the load's share of the dry friction of `model` from the motor to the load among its `hidden` effects, which stand in the same order. False
/// where the bench cannot: it has no other than Coulomb friction on a load.
pub fn share_friction(hidden: &mut [Hidden], model: &Candidate) -> bool {
    let share_of = |kind: Kind, values: &[f64]| {
        let share = values.last().copied();
        share.filter(|share| kind.form() == Some(Form::FrictionShare) && *share > 0.0)
    };
    let mut each = model.effects.iter().enumerate();
    let Some((coupling, share)) =
        each.find_map(|(k, (kind, values))| Some((k, share_of(kind, values)?)))
    else {
        return true;
    };
    let rubs = |(_, (kind, _)): &(usize, (Kind, &[f64]))| kind.needs().friction;
    let frictions: Vec<(usize, Kind)> = (model.effects.iter().enumerate())
        .filter(rubs)
        .map(|(k, (kind, _))| (k, kind))
        .collect();
    match frictions[..] {
        [] => true,
        [(own, Kind::Coulomb)] => {
            let torque = current(&hidden[own], &[("torque", 0.0)])[0];
            let moved = hidden[own].set("torque", (1.0 - share) * torque);
            moved.is_ok() && hidden[coupling].set(FRICTION, share * torque).is_ok()
        }
        _ => false,
    }
}

fn current(hidden: &Hidden, keys: &[(&str, f64)]) -> Vec<f64> {
    let value = |name: &str| hidden.parameters().find(|p| p.0 == name).map(|p| p.1);
    keys.iter()
        .map(|(name, _)| value(name).unwrap_or(0.0))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_plant::PRESETS;
    use servoid_plant::effects::CATALOGUE;
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
    fn every_effect_s_values_are_put_back_on_the_bench() {
        for name in PRESETS {
            let machine = Machine::preset(name).unwrap();
            for &kind in Kind::ALL {
                for strength in [0.4, 1.0, 1.7] {
                    let typical = Hidden::typical(kind.name(), &machine).unwrap();
                    let Ok(wanted) = typical.scaled(strength) else {
                        continue;
                    };
                    let values = wanted.truth(&machine, 2000);
                    let found = hidden(kind, &values, &machine, 2000)
                        .unwrap_or_else(|| panic!("{name}, {kind:?}, {strength}"));
                    let again = found.truth(&machine, 2000);
                    for (k, (a, b)) in again.iter().zip(&values).enumerate() {
                        let scale = b.abs().max(1e-9);
                        assert!(
                            (a - b).abs() < 1e-3 * scale,
                            "{name}, {kind:?}, {k}: {a} {b}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn friction_on_the_load_is_put_back_on_the_bench() {
        let machine = Machine::gearmotor();
        let truth = |name: &str| {
            let typical = Hidden::typical(name, &machine).unwrap();
            typical.truth(&machine, 2000)
        };
        let mut gap = truth("backlash");
        *gap.last_mut().unwrap() = 0.4;
        let model = |friction: Kind| {
            let mut effects = EffectSet::default();
            effects.push(friction, &truth(friction.name())).unwrap();
            effects.push(Kind::Backlash, &gap).unwrap();
            let mut bench: Vec<Hidden> = effects
                .iter()
                .map(|(kind, values)| hidden(kind, values, &machine, 2000).unwrap())
                .collect();
            let candidate = Candidate {
                machine: physical(&machine).machine(),
                effects,
                start_speed: 0.0,
                start_offset: 0.0,
            };
            (share_friction(&mut bench, &candidate), bench)
        };
        let (shared, bench) = model(Kind::Coulomb);
        let value = |k: usize, name: &str| current(&bench[k], &[(name, 0.0)])[0];
        let (own, of_load) = (value(0, "torque"), value(1, FRICTION));
        assert!(shared && (of_load / (own + of_load) - 0.4).abs() < 1e-9);
        assert!(!model(Kind::Stribeck).0);
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
