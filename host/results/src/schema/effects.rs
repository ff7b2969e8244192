//! `servoid.effects/1`: what can be told of the catalogue's effects.

use super::VERSION;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use shared::effects::{Kind, Other, Place};

/// What a list of effects calls itself.
pub const SCHEMA: &str = "servoid.effects/1";

/// `servoid.effects/1`.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct Effects {
    /// `servoid.effects/1`.
    pub schema: String,
    /// One of them, or all.
    pub effects: Vec<EffectFacts>,
    /// Version of the program.
    pub version: String,
}

/// One effect.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct EffectFacts {
    /// Its name on the command line.
    pub name: String,
    /// One line for a person.
    pub title: String,
    /// Where it acts: `drive`, `winding`, `torque`, `friction`, `load` or `sensed`.
    pub acts_on: String,
    /// The equation.
    pub equation: String,
    /// Its parameters.
    pub parameters: Vec<ParameterFacts>,
    /// Its sign in the residual.
    pub symptom: String,
    /// The excitation that exposes it.
    pub experiment: String,
    /// What can be done about it in a drive.
    pub remedy: String,
    /// Names of effects that it is confused with.
    pub look_alikes: Vec<String>,
    /// What tells it from them, where there is more to say than the experiment.
    pub told_from: Vec<ToldFromFacts>,
    /// Where the equation comes from.
    pub source: String,
}

/// A parameter of an effect.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ParameterFacts {
    /// Its name.
    pub name: String,
    /// Its unit, referred to the winding.
    pub unit: String,
}

/// What tells an effect from others.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
pub struct ToldFromFacts {
    /// The other effect, or `drive`, `torque`, … for all that act there.
    pub other: String,
    /// What to record.
    pub record: String,
    /// What to measure, where no recording of voltage and angle tells them apart.
    pub measure: Option<String>,
}

impl Effects {
    /// One effect, or all.
    pub fn new(only: Option<Kind>) -> Self {
        let kinds = Kind::ALL.iter().copied();
        Effects {
            schema: SCHEMA.to_owned(),
            effects: kinds
                .filter(|kind| only.is_none_or(|only| only == *kind))
                .map(EffectFacts::new)
                .collect(),
            version: VERSION.to_owned(),
        }
    }
}

impl Effects {
    /// Laws that the user stated.
    pub fn stated(kinds: &[Kind]) -> Self {
        Effects {
            schema: SCHEMA.to_owned(),
            effects: kinds.iter().copied().map(EffectFacts::new).collect(),
            version: VERSION.to_owned(),
        }
    }
}

impl EffectFacts {
    fn new(kind: Kind) -> Self {
        let description = kind.description();
        let told = description.facts.told_from.iter();
        EffectFacts {
            name: description.name.to_owned(),
            title: description.title.to_owned(),
            acts_on: place(description.place).to_owned(),
            equation: description.equation.to_owned(),
            parameters: (description.parameters.iter())
                .map(|parameter| ParameterFacts {
                    name: parameter.name.to_owned(),
                    unit: parameter.quantity.unit().to_owned(),
                })
                .collect(),
            symptom: description.signature.to_owned(),
            experiment: description.exposed_by.to_owned(),
            remedy: remedy(description.place, description.name).to_owned(),
            look_alikes: description
                .look_alikes
                .iter()
                .map(|&name| name.to_owned())
                .collect(),
            told_from: told
                .map(|told| ToldFromFacts {
                    other: match told.other {
                        Other::Effect(name) => name.to_owned(),
                        Other::At(at) => place(at).to_owned(),
                    },
                    record: told.record.to_owned(),
                    measure: told.measure.map(str::to_owned),
                })
                .collect(),
            source: description.source.to_owned(),
        }
    }
}

fn place(place: Place) -> &'static str {
    match place {
        Place::Drive => "drive",
        Place::Winding => "winding",
        Place::Torque => "torque",
        Place::Friction => "friction",
        Place::Load => "load",
        Place::Sensed => "sensed",
    }
}

/// What can be done about an effect: its own, else that of all that act in its place.
fn remedy(place: Place, name: &str) -> &'static str {
    match name {
        "coulomb" | "asym_coulomb" | "stribeck" => {
            "feed its voltage forward with the sign of the wanted speed; near standstill less than all of it, or it hunts"
        }
        "cogging" | "unbalance" => {
            "feed its voltage forward over the measured angle, homed to an index"
        }
        "load_torque" | "offset_voltage" => {
            "an integrator removes it; or add its voltage to every command"
        }
        "dead_zone" | "brush_drop" => {
            "add its voltage with the sign of the command, or of the current"
        }
        "dead_time" => {
            "let the timer lengthen each pulse by it, by the sign of the current; or add its voltage with that sign"
        }
        "delay" => {
            "predict the angle over the delay, or lower the bandwidth: the delay takes phase margin"
        }
        "supply_sag" | "voltage_sat" => {
            "divide the command by the measured supply; plan for less than all of it"
        }
        "heating" => {
            "measure the winding's temperature or let the model follow it; limit the mean square of the current"
        }
        "torque_sat" | "l_sat" => {
            "limit the current to where the model is straight, or schedule the gains over the current"
        }
        "backlash" => {
            "preload the gears, cross the gap with a bounded torque, and close the loop at the motor"
        }
        "compliance" => {
            "a notch at the resonance or a bandwidth well below it; an encoder at the load"
        }
        "windage" | "asym_viscous" => "feed its voltage forward with the wanted speed",
        "lugre" => "feed its friction forward for slow reversals, with an observer of its state",
        "load_friction" => "feed friction forward in proportion to the torque that is transmitted",
        "enc_ecc" => {
            "subtract its sine from the reading once the encoder is homed, or centre the disc"
        }
        "missed_counts" => {
            "lower the speed, filter the encoder's lines, or count in hardware; home at the index"
        }
        _ => match place {
            Place::Drive => "correct the command by it",
            Place::Winding => "schedule the gains over it",
            Place::Torque | Place::Friction => "feed its voltage forward",
            Place::Load => "lower the bandwidth, or measure at the load",
            Place::Sensed => "correct the reading by it",
        },
    }
}
