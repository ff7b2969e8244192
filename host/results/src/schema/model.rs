//! A model with all its numbers, as results carry it: machine and torques referred to the winding, so that nothing
//! but the recording determines them.

use super::model_fault::{ModelFault, number};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::Method;
use servoid_io::input::suggest::did_you_mean;
use servoid_io::recording::Drive;
use shared::discretise::Discretisation;
use shared::effects::{EffectSet, Kind, MAX_EFFECTS};
use shared::motor;

/// A model that can be run again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Model {
    /// Names of the effects; one may stand here several times.
    pub effects: Vec<String>,
    /// Laws among the effects that are none of the catalogue, as they were stated.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub formulas: Vec<String>,
    /// The linear machine.
    pub machine: Machine,
    /// The effects' parameters, torques in V.
    #[serde(default)]
    pub parameters: Vec<ModelParameter>,
    /// Speed at the first sample, rad/s.
    #[serde(default)]
    pub start_speed_rad_s: f64,
    /// Angle at the first sample from the middle of its count, counts.
    #[serde(default)]
    pub start_offset_counts: f64,
    /// Steps to a sample interval where there are effects.
    #[serde(default = "one")]
    pub steps_per_sample: u16,
    /// How it is made discrete.
    #[serde(default)]
    pub integrator: Integrator,
}

/// The linear machine referred to its winding.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Machine {
    /// Back-EMF constant, V·s/rad.
    pub kb_v_s_rad: f64,
    /// Viscous friction times R/Kt, V·s/rad.
    pub damping_v_s_rad: f64,
    /// Inertia times R/Kt, V·s²/rad.
    pub inertia_v_s2_rad: f64,
    /// Electrical time constant, s.
    pub electrical_s: f64,
}

/// One parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModelParameter {
    /// Its name behind its effect's, as in `coulomb.torque`.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

/// How a model is made discrete.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Integrator {
    /// Exactly.
    #[default]
    Exact,
    /// By the paper's explicit Euler step.
    Euler,
}

fn one() -> u16 {
    1
}

impl From<&motor::Machine<f64>> for Machine {
    fn from(machine: &motor::Machine<f64>) -> Self {
        Machine {
            kb_v_s_rad: machine.kb,
            damping_v_s_rad: machine.damping,
            inertia_v_s2_rad: machine.inertia,
            electrical_s: machine.electrical,
        }
    }
}

impl Machine {
    /// The machine, if a motor can be like that. `place` is where it stands in the file.
    ///
    /// # Errors
    /// A number that no motor has.
    pub fn machine(&self, place: &str) -> Result<motor::Machine<f64>, ModelFault> {
        let key = |name: &str| format!("{place}.machine.{name}");
        let positive =
            |name: &str, value: f64| number(&key(name), value, value > 0.0, "a positive number");
        let at_least_zero = |name: &str, value: f64| {
            number(&key(name), value, value >= 0.0, "zero or a positive number")
        };
        Ok(motor::Machine {
            // Behind an amplifier with a current loop there is none.
            kb: at_least_zero("kb_v_s_rad", self.kb_v_s_rad)?,
            damping: at_least_zero("damping_v_s_rad", self.damping_v_s_rad)?,
            inertia: positive("inertia_v_s2_rad", self.inertia_v_s2_rad)?,
            electrical: at_least_zero("electrical_s", self.electrical_s)?,
        })
    }
}

/// Writes units in terms of the command of a drive, in the place of volts.
pub(crate) fn in_terms_of(drive: Drive, parameters: &mut [ModelParameter]) {
    let units: Vec<&'static str> = Kind::ALL
        .iter()
        .flat_map(|kind| kind.parameters())
        .map(|parameter| parameter.quantity.unit())
        .collect();
    for parameter in parameters {
        if let Some(unit) = units.iter().find(|unit| **unit == parameter.unit) {
            drive.unit(unit).clone_into(&mut parameter.unit);
        }
    }
}

impl ModelParameter {
    /// The parameters of `effects`, one effect after the other, with their values in the catalogue's order.
    pub fn all(effects: &[Kind], values: &[f64]) -> Vec<Self> {
        let named = effects.iter().flat_map(|kind| {
            let parameters = kind.parameters().iter();
            parameters.map(|p| (format!("{}.{}", kind.name(), p.name), p.quantity.unit()))
        });
        let values = named.zip(values);
        values
            .map(|((name, unit), &value)| ModelParameter {
                name,
                value,
                unit: unit.to_owned(),
            })
            .collect()
    }
}

impl Model {
    /// The same in terms of the command of a drive.
    pub fn driven_by(mut self, drive: Drive) -> Self {
        in_terms_of(drive, &mut self.parameters);
        self
    }

    /// A model as it is written.
    pub fn of(candidate: &Candidate, method: Method) -> Self {
        let mut parameters = Vec::new();
        for (kind, values) in candidate.effects.iter() {
            parameters.extend(ModelParameter::all(&[kind], values));
        }
        let effects = candidate.effects.iter();
        let stated = candidate.effects.iter();
        let stated = stated.filter_map(|(kind, _)| servoid_formula::text_of(kind));
        Model {
            formulas: stated.map(str::to_owned).collect(),
            effects: effects.map(|(kind, _)| kind.name().to_owned()).collect(),
            machine: Machine::from(&candidate.machine),
            parameters,
            start_speed_rad_s: candidate.start_speed,
            start_offset_counts: candidate.start_offset,
            steps_per_sample: method.substeps,
            integrator: match method.discretisation {
                Discretisation::Exact => Integrator::Exact,
                Discretisation::Euler => Integrator::Euler,
            },
        }
    }

    /// How it is run.
    pub fn method(&self) -> Method {
        Method {
            discretisation: match self.integrator {
                Integrator::Exact => Discretisation::Exact,
                Integrator::Euler => Discretisation::Euler,
            },
            substeps: self.steps_per_sample.max(1),
        }
    }

    /// The model itself. `place` is where it stands in the file.
    ///
    /// # Errors
    /// Whatever in it is not of a model.
    pub fn candidate(&self, place: &str) -> Result<Candidate, ModelFault> {
        let mut effects = EffectSet::default();
        for (kind, values) in self.terms(place)? {
            effects
                .push(kind, &values)
                .map_err(|_| ModelFault::Number {
                    key: format!("{place}.parameters of {}", kind.name()),
                    value: values.iter().sum(),
                    need: "finite numbers",
                })?;
        }
        let finite = |name: &str, value: f64| {
            number(&format!("{place}.{name}"), value, true, "a finite number")
        };
        Ok(Candidate {
            machine: self.machine.machine(place)?,
            effects,
            start_speed: finite("start_speed_rad_s", self.start_speed_rad_s)?,
            start_offset: finite("start_offset_counts", self.start_offset_counts)?,
        })
    }

    /// Each effect with its parameters in the catalogue's order.
    ///
    /// # Errors
    /// An effect or unit that is unknown, a parameter that is not there, too many effects.
    pub fn terms(&self, place: &str) -> Result<Vec<(Kind, Vec<f64>)>, ModelFault> {
        define(&self.formulas, place)?;
        terms(&self.effects, &self.parameters, place, &Drive::ALL)
    }
}

/// Each of `effects` with its parameters in the catalogue's order. `place` is where the model stands in the file,
/// and its units are of one of `drives`.
///
/// # Errors
/// An effect or unit that is unknown, a parameter that is not there, too many effects.
pub(super) fn terms(
    effects: &[String],
    parameters: &[ModelParameter],
    place: &str,
    drives: &[Drive],
) -> Result<Vec<(Kind, Vec<f64>)>, ModelFault> {
    let many = effects.len();
    number(
        &format!("{place}.effects"),
        many as f64,
        many <= MAX_EFFECTS,
        "at most 8 effects",
    )?;
    // An effect that stands there twice has each of its parameters twice.
    let mut left: Vec<&ModelParameter> = parameters.iter().collect();
    let mut terms = Vec::with_capacity(many);
    for effect in effects {
        let kind = kind(place, effect)?;
        let mut values = Vec::new();
        for parameter in kind.parameters() {
            let name = format!("{effect}.{}", parameter.name);
            let at = left.iter().position(|known| known.name == name);
            // Results from before the effect had a form have the textbook's.
            if at.is_none() && parameter.form.is_some() {
                values.push(0.0);
                continue;
            }
            let Some(known) = at.map(|at| left.remove(at)) else {
                return Err(ModelFault::Parameter {
                    place: place.to_owned(),
                    name,
                });
            };
            let needed = parameter.quantity.unit();
            // Behind a current loop it is in terms of the command.
            if drives.iter().all(|drive| drive.unit(needed) != known.unit) {
                return Err(ModelFault::Unit {
                    place: place.to_owned(),
                    name,
                    unit: known.unit.clone(),
                    needed,
                });
            }
            values.push(known.value);
        }
        terms.push((kind, values));
    }
    Ok(terms)
}

/// States the laws of a model, so that their names are known.
///
/// # Errors
/// A text that is no law.
pub(super) fn define(formulas: &[String], place: &str) -> Result<(), ModelFault> {
    for text in formulas {
        servoid_formula::define(text).map_err(|fault| ModelFault::Formula {
            place: place.to_owned(),
            fault: fault.to_string(),
        })?;
    }
    Ok(())
}

fn kind(place: &str, name: &str) -> Result<Kind, ModelFault> {
    servoid_formula::by_name(name).ok_or_else(|| {
        let known: Vec<&str> = Kind::ALL.iter().map(|kind| kind.name()).collect();
        ModelFault::Effect {
            place: place.to_owned(),
            name: name.to_owned(),
            remedy: did_you_mean(name, &known),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_identify::plan::Hypothesis;
    use servoid_plant as bench;

    #[test]
    fn a_form_that_is_not_stated_is_the_textbooks_and_any_other_parameter_is_missed() {
        let motor = bench::Machine::gearmotor();
        for &kind in Kind::ALL {
            let candidate = Hypothesis::typical(kind, &motor).candidate();
            let candidate = candidate.expect("a model");
            let whole = Model::of(&candidate, Method::default());
            for (index, parameter) in kind.parameters().iter().enumerate() {
                let mut lacking = whole.clone();
                lacking.parameters.remove(index);
                let read = lacking.candidate("model");
                match read {
                    Ok(read) => assert_eq!(format!("{read:?}"), format!("{candidate:?}")),
                    Err(_) => assert!(parameter.form.is_none(), "{kind:?}.{}", parameter.name),
                }
                assert_eq!(lacking.candidate("model").is_ok(), parameter.form.is_some());
            }
        }
    }

    #[test]
    fn every_model_of_one_and_two_effects_is_read_as_it_was_written() {
        let motor = bench::Machine::gearmotor();
        for &first in Kind::ALL {
            for &second in Kind::ALL {
                let mut model = Hypothesis::typical(first, &motor);
                let further = Hypothesis::typical(second, &motor);
                model.effects.extend(further.effects);
                model.values.extend(further.values);
                let mut candidate = model.candidate().expect("a model");
                candidate.start_speed = -3.25;
                candidate.start_offset = 0.125;
                let method = Method {
                    substeps: 3,
                    ..Method::default()
                };
                let text = serde_json::to_string(&Model::of(&candidate, method)).expect("text");
                let read: Model = serde_json::from_str(&text).expect("a model");
                assert_eq!(read.method().substeps, 3);
                let read = read.candidate("model").expect("a model");
                assert_eq!(format!("{read:?}"), format!("{candidate:?}"), "{text}");
            }
        }
    }
}
