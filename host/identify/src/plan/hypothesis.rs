//! A model that may be the truth, and the setup that it runs on.

use servoid_engine::problem::Candidate;
use servoid_plant as bench;
use shared::effects::{EffectSet, Kind};
use shared::error::ModelError;
use shared::motor::{Machine, Physical};
use shared::units::PerUnit;

/// The base speed lies above the no-load speed by this factor: a load may drive the shaft faster.
const HEADROOM: f64 = 1.3;

/// The drive, the encoder and the motor's size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setup {
    /// Supply voltage, V: the largest command.
    pub supply_v: f64,
    /// No-load speed on it, rad/s.
    pub no_load_rad_s: f64,
    /// Encoder counts per revolution.
    pub counts_per_rev: f64,
    /// Sample interval, s.
    pub sample_s: f64,
}

impl Setup {
    /// Bases of the per-unit system.
    ///
    /// # Errors
    /// A number that is not positive and finite.
    pub fn units(&self) -> Result<PerUnit<f64>, ModelError> {
        PerUnit::new(
            self.supply_v,
            HEADROOM * self.no_load_rad_s,
            self.sample_s,
            self.counts_per_rev,
        )
    }
}

/// A model that may be the truth: a machine and its effects with all their parameters, SI, torques in
/// volts referred to the winding.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// The effects; empty for the linear motor.
    pub effects: Vec<Kind>,
    /// The linear machine.
    pub machine: Machine<f64>,
    /// Values of the effects' parameters, one effect after the other.
    pub values: Vec<f64>,
}

impl Hypothesis {
    /// The effect with its typical values on a motor of the bench.
    pub fn typical(kind: Kind, motor: &bench::Machine) -> Self {
        let (supply, no_load) = (motor.supply_v, motor.top_speed_rad_s());
        let parameters = kind.parameters().iter();
        Hypothesis {
            effects: vec![kind],
            machine: machine(motor),
            values: parameters
                .map(|parameter| parameter.scaled(parameter.typical, supply, no_load))
                .collect(),
        }
    }

    /// A model as a hypothesis.
    pub fn of(candidate: &Candidate) -> Self {
        let effects = &candidate.effects;
        Hypothesis {
            effects: effects.iter().map(|(kind, _)| kind).collect(),
            machine: candidate.machine,
            values: effects
                .iter()
                .flat_map(|(_, values)| values.to_vec())
                .collect(),
        }
    }

    /// Its effects, as in `coulomb + cogging`.
    pub fn name(&self) -> String {
        if self.effects.is_empty() {
            return "the linear motor".to_owned();
        }
        let names: Vec<&str> = self.effects.iter().map(|kind| kind.name()).collect();
        names.join(" + ")
    }

    /// The model itself, from rest.
    ///
    /// # Errors
    /// A value that is not finite; too many effects.
    pub fn candidate(&self) -> Result<Candidate, ModelError> {
        let mut effects = EffectSet::default();
        let mut rest = &self.values[..];
        for &kind in &self.effects {
            let own = kind.parameters().len().min(rest.len());
            let (values, further) = rest.split_at(own);
            effects.push(kind, values)?;
            rest = further;
        }
        Ok(Candidate {
            machine: self.machine,
            effects,
            start_speed: 0.0,
            start_offset: 0.0,
        })
    }

    /// True if it equals `other` for some values of its parameters. Then it explains whatever `other` does,
    /// and no recording speaks against it.
    pub fn contains(&self, other: &Hypothesis) -> bool {
        let covers = |general: Kind, special: Kind| general == special || general.refines(special);
        let mut free = self.effects.clone();
        other.effects.iter().all(|&special| {
            let exact = free.iter().position(|&kind| kind == special);
            let found = exact.or_else(|| free.iter().position(|&kind| covers(kind, special)));
            found.map(|k| free.swap_remove(k)).is_some()
        })
    }
}

/// A motor of the bench in the model's terms.
fn machine(motor: &bench::Machine) -> Machine<f64> {
    Physical {
        resistance: motor.resistance_ohm,
        inductance: motor.inductance_h,
        kt: motor.kt_n_m_a,
        kb: motor.kb_v_s_rad,
        inertia: motor.inertia_kg_m2,
        viscous: motor.viscous_n_m_s,
    }
    .machine()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(kinds: &[Kind]) -> Hypothesis {
        let mut all = Hypothesis::typical(Kind::Coulomb, &bench::Machine::gearmotor());
        all.effects = kinds.to_vec();
        all
    }

    #[test]
    fn every_effect_contains_itself_and_the_linear_motor_and_a_further_effect_never_less() {
        let linear = with(&[]);
        for &kind in Kind::ALL {
            let one = with(&[kind]);
            assert!(one.contains(&one) && one.contains(&linear) && !linear.contains(&one));
            for &further in Kind::ALL.iter().filter(|&&further| further != kind) {
                let both = with(&[kind, further]);
                assert!(both.contains(&one) && !one.contains(&both), "{both:?}");
            }
        }
    }

    #[test]
    fn friction_with_more_parameters_contains_coulomb_friction_but_not_the_reverse() {
        for name in ["stribeck", "asym_coulomb", "lugre"] {
            let (special, general) = (Kind::Coulomb, Kind::by_name(name).expect("an effect"));
            assert!(with(&[general]).contains(&with(&[special])));
            assert!(!with(&[special]).contains(&with(&[general])));
        }
    }

    #[test]
    fn every_typical_effect_on_every_motor_of_the_bench_is_a_model() {
        for name in bench::PRESETS {
            let motor = bench::Machine::preset(name).expect("a preset");
            for &kind in Kind::ALL {
                let hypothesis = Hypothesis::typical(kind, &motor);
                let candidate = hypothesis.candidate().expect("a model");
                let values: Vec<f64> = (candidate.effects.iter())
                    .flat_map(|(_, values)| values.to_vec())
                    .collect();
                assert_eq!(values, hypothesis.values, "{name}, {}", kind.name());
            }
        }
    }
}
