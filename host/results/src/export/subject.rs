//! What is exported: the model with its numbers, on one side of a gear.

use super::error::{ExportError, FIT_AGAIN, NAME_RESISTANCE};
use super::side::Side;
use crate::schema::device::Grade;
use crate::schema::{Graded, Identified, ModelFault};
use servoid_io::recording::Drive;
use shared::effects::Kind;
use shared::motor::{Machine, Response};

/// One number with all that is known of it, on the subject's side.
#[derive(Clone, Debug, PartialEq)]
pub struct Value {
    /// Name; an effect's parameters carry its name before a point.
    pub name: String,
    /// The number.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// Standard deviation, in the same unit.
    pub std: Option<f64>,
    /// Whether the data (with the known facts) determine it.
    pub determined: bool,
}

/// One effect of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// The effect.
    pub kind: Kind,
    /// Its parameters in the catalogue's order; torques in V.
    pub values: Vec<f64>,
    /// Whether each is determined.
    pub determined: Vec<bool>,
}

/// What is exported.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The file it was read from.
    pub source: String,
    /// What that calls itself.
    pub schema: String,
    /// The recording behind it.
    pub recording: Option<String>,
    /// What the command drives.
    pub drive: Drive,
    /// Supply, V.
    pub supply_v: Option<f64>,
    /// Encoder counts a turn of the shaft on this side.
    pub counts_per_rev: Option<f64>,
    /// Sample interval of the recording, s.
    pub sample_s: Option<f64>,
    /// Whether the search came to its end.
    pub converged: bool,
    /// What a device said its numbers are good for.
    pub grade: Option<Graded>,
    /// The shaft that all numbers speak of.
    pub side: Side,
    /// Every number.
    pub values: Vec<Value>,
    /// The linear machine, referred to its winding.
    pub machine: Machine<f64>,
    /// The effects.
    pub terms: Vec<Term>,
}

/// No resistance, motor constant or inertia is smaller.
const LEAST: f64 = 1e-30;
/// Names that describe a recording and not the motor.
const NUISANCES: [&str; 2] = ["start_speed", "start_offset"];

impl Subject {
    /// What stands over the numbers of a device.
    pub(super) fn grade_text(&self) -> Option<String> {
        let Graded { grade, reason } = self.grade.as_ref()?;
        let why = reason.iter().map(|why| format!(": {why}"));
        let why: String = why.collect();
        Some(match grade {
            Grade::No => format!("NOT VERIFIED{why}"),
            Grade::Control => format!("verified for control{why}"),
            Grade::Floor => format!("verified{why}"),
        })
    }

    /// Refuses to compute gains from what a device calls good for nothing.
    ///
    /// # Errors
    /// Its grade is `no`.
    pub fn needs_grade(&self, format: &'static str) -> Result<(), ExportError> {
        match &self.grade {
            Some(Graded {
                grade: Grade::No,
                reason,
            }) => Err(ExportError::Unverified {
                format,
                reason: reason.clone().unwrap_or_default(),
            }),
            _ => Ok(()),
        }
    }

    /// What `result` says, on `side`. `source` is the file it was read from.
    ///
    /// # Errors
    /// A model that is none, or a unit that cannot be referred to the output.
    pub fn new(result: &Identified, source: &str, side: Side) -> Result<Self, SubjectError> {
        let refer = |name: &str, value: f64, unit: &str| {
            let factor = side.factor(unit).ok_or_else(|| ExportError::Unit {
                name: name.to_owned(),
                unit: unit.escape_debug().to_string(),
            });
            factor.map(|factor| value * factor)
        };
        let mut values = Vec::new();
        for found in &result.parameters {
            if NUISANCES.contains(&found.name.as_str()) {
                continue;
            }
            let unit = result.drive.volts_unit(&found.unit);
            let std = found.std.map(|std| refer(&found.name, std, unit));
            let std = std.transpose()?;
            values.push(Value {
                name: found.name.clone(),
                value: refer(&found.name, found.value, unit)?,
                unit: unit.to_owned(),
                std,
                // A result that says otherwise was not written by a fit.
                determined: found.identifiable && std.is_some(),
            });
        }
        let machine = result.model.machine.machine(result.place)?;
        let machine = Machine {
            kb: refer("kb", machine.kb, "V*s/rad")?,
            damping: refer("damping", machine.damping, "V*s/rad")?,
            inertia: refer("inertia", machine.inertia, "V*s^2/rad")?,
            electrical: machine.electrical,
        };
        let terms = result.model.terms(result.place)?;
        let terms = terms.into_iter().enumerate().map(|(index, (kind, own))| {
            // An effect that stands there twice has each of its names twice, in the same order.
            let earlier = result.model.effects[..index]
                .iter()
                .filter(|name| name.as_str() == kind.name())
                .count();
            let mut term = Term {
                kind,
                values: Vec::new(),
                determined: Vec::new(),
            };
            for (parameter, value) in kind.parameters().iter().zip(own) {
                let name = format!("{}.{}", kind.name(), parameter.name);
                term.values
                    .push(refer(&name, value, parameter.quantity.unit())?);
                let stated = values.iter().filter(|v| v.name == name).nth(earlier);
                // A form that nobody searched for is the textbook's.
                let determined = stated.map_or(parameter.form.is_some(), |v| v.determined);
                term.determined.push(determined);
            }
            Ok(term)
        });
        let terms = terms.collect::<Result<_, ExportError>>()?;
        let turns = result
            .counts_per_rev
            .map(|n| refer("counts_per_rev", n, "count/rev"));
        let mut subject = Subject {
            source: source.to_owned(),
            schema: result.schema.clone(),
            recording: result.recording.clone(),
            drive: result.drive,
            supply_v: result.supply_v,
            counts_per_rev: turns.transpose()?,
            sample_s: result.sample_s,
            converged: result.converged,
            grade: result.grade.clone(),
            side,
            values,
            machine,
            terms,
        };
        subject.complete();
        Ok(subject)
    }

    /// Adds a2, which follows from what was searched for, beside the two that were.
    fn complete(&mut self) {
        let place = (self.values.iter()).position(|v| v.name == "electrical_time_constant");
        let Response { a2, .. } = self.machine.response();
        if let Some(place) = place.filter(|_| a2.is_finite()) {
            // a2 = τe·m/D: its relative error is that of the electrical time constant, the other two are far better known.
            let electrical = &self.values[place];
            let relative = electrical.std.map(|std| std / electrical.value.abs());
            let std = relative.map(|r| r * a2).filter(|std| std.is_finite());
            let determined = electrical.determined && self.is_determined("a1") && std.is_some();
            self.values.insert(
                place,
                Value {
                    name: "a2".to_owned(),
                    value: a2,
                    unit: "s^2".to_owned(),
                    std,
                    determined,
                },
            );
        }
    }

    /// The number of this name, if it is determined.
    pub fn determined(&self, name: &str) -> Option<f64> {
        let found = self.values.iter().find(|v| v.name == name && v.determined);
        found.map(|v| v.value)
    }

    fn is_determined(&self, name: &str) -> bool {
        self.determined(name).is_some()
    }

    /// A determined number in this unit: behind a current loop some names are in units of the command.
    pub fn physical(&self, name: &str, unit: &str) -> Option<f64> {
        let found = self
            .values
            .iter()
            .find(|v| v.name == name && v.unit == unit);
        let value = found.filter(|v| v.determined).map(|v| v.value);
        // Others are divided by it.
        value.filter(|x| x.abs() > LEAST)
    }

    /// The first term of a kind, if all of its parameters are determined.
    pub fn first(&self, kind: Kind) -> Option<&Term> {
        let term = self.terms.iter().find(|term| term.kind == kind);
        term.filter(|term| !term.determined.contains(&false))
    }

    /// Volts at the winding per newton metre on the shaft, `R/Kt`, V/(N·m).
    pub fn volts_per_torque(&self) -> Option<f64> {
        match self.drive {
            Drive::Voltage => {}
            Drive::Current => return None,
            // The command is the torque itself.
            Drive::Torque => return Some(1.0),
        }
        let inertia = self.physical("inertia", "kg*m^2");
        let constants = (self.physical("resistance", "ohm")).zip(self.physical("kt", "N*m/A"));
        let ratio = constants.map(|(r, kt)| r / kt);
        ratio
            .or(inertia.map(|j| self.machine.inertia / j))
            .filter(|x| *x > LEAST && *x < 1.0 / LEAST)
    }

    /// Whether viscous friction is known apart from back-EMF.
    pub fn viscous_is_apart(&self) -> bool {
        !self.drive.is_voltage() && self.is_determined("damping")
            || self.is_determined("viscous_part")
            || self.is_determined("viscous") && self.is_determined("kb")
    }

    /// Refuses a result that does not say how the motor answers its command.
    ///
    /// # Errors
    /// Gain or time constant (behind a current loop the inertia) is not determined.
    pub fn needs_response(&self, format: &'static str) -> Result<(), ExportError> {
        let needed: &[&str] = match self.drive {
            Drive::Voltage => &["gain", "a1"],
            Drive::Current | Drive::Torque => &["inertia"],
        };
        match needed.iter().find(|name| !self.is_determined(name)) {
            None => Ok(()),
            Some(name) => Err(ExportError::Undetermined {
                format,
                needs: format!("the motor's {name}"),
                remedy: FIT_AGAIN,
            }),
        }
    }

    /// Refuses a motor that was not driven by a voltage.
    ///
    /// # Errors
    /// It was not.
    pub fn needs_volts(&self, format: &'static str) -> Result<(), ExportError> {
        match self.drive {
            Drive::Voltage => Ok(()),
            Drive::Current | Drive::Torque => Err(ExportError::CurrentDriven { format }),
        }
    }

    /// Volts per newton metre, or a refusal.
    ///
    /// # Errors
    /// The data and the known facts do not settle it.
    pub fn needs_torques(&self, format: &'static str) -> Result<f64, ExportError> {
        self.volts_per_torque()
            .ok_or_else(|| ExportError::Undetermined {
                format,
                needs: "torques in N*m (R/Kt)".to_owned(),
                remedy: NAME_RESISTANCE,
            })
    }

    /// A unit as it is written: that of the command stands in the place of volts.
    pub fn unit_shown(&self, unit: &str) -> String {
        match self.drive {
            Drive::Voltage => unit.to_owned(),
            Drive::Current => unit.replace('V', "A"),
            Drive::Torque => unit.replace('V', "N*m"),
        }
    }
}

/// Why a result is no subject.
#[derive(Debug, thiserror::Error)]
pub enum SubjectError {
    /// Its model is none.
    #[error(transparent)]
    Model(#[from] ModelFault),
    /// It cannot be referred to the side that was asked for.
    #[error(transparent)]
    Export(#[from] ExportError),
}
