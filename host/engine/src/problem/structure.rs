//! The unknowns of a model, their coordinates, and the model that their values make.
//!
//! The default coordinates are the identifiable ones. Searching in the six physical parameters
//! instead, as the paper does, is searching along valleys whose floor is flat.

use super::unknown::{Scale, Unknown};
use crate::data::Data;
use crate::simulation::Candidate;
use shared::effects::{EffectSet, Form, Kind};
use shared::model::MAX_DELAY;
use shared::motor::{Machine, Physical, Response};
use shared::units::Quantity;

/// The coordinates of the linear machine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Base {
    /// Gain, a1 and electrical time constant: all that voltage and angle determine; with viscous
    /// friction as a part of the damping where something makes it separable from back-EMF.
    Response {
        /// Whether the part of viscous friction is searched for.
        damping: bool,
    },
    /// The six physical parameters in the paper's box.
    Physical {
        /// Range of each of them, SI.
        range: (f64, f64),
    },
    /// Behind a current loop: inertia and viscous friction per unit of the command.
    CurrentDriven,
}

/// The unknowns of a model: base coordinates, then each effect's parameters, then nuisances.
#[derive(Clone, Debug)]
pub struct Structure {
    /// Coordinates of the linear machine.
    pub base: Base,
    /// Effects, in order.
    pub effects: Vec<Kind>,
    /// Whether the speed at the first sample is unknown (else the motor starts at rest).
    pub start_speed: bool,
    /// Whether the start angle within its encoder cell is.
    pub start_offset: bool,
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
}

/// Name of the unknown speed at the first sample.
pub const START_SPEED: &str = "start_speed";
/// Name of the unknown electrical time constant.
pub const ELECTRICAL_TIME_CONSTANT: &str = "electrical_time_constant";
/// Name of the unknown part of the damping that is viscous friction.
pub const VISCOUS_PART: &str = "viscous_part";
/// Name of the unknown start angle within the first cell.
pub const START_OFFSET: &str = "start_offset";
/// No delay is looked for beyond this, s.
const LONGEST_DELAY_S: f64 = 0.15;
/// Search range of the start angle about the middle of its cell, counts: a little beyond the edges.
const FARTHEST_START: f64 = 0.7;

impl Structure {
    /// The unknowns with search ranges around `centre`, a first guess at the machine.
    pub fn around(
        data: &Data,
        base: Base,
        effects: &[Kind],
        centre: &Machine<f64>,
        start_speed: bool,
    ) -> Self {
        let no_load = data.units.speed;
        let mut unknowns = base_unknowns(base, data, centre);
        for &kind in effects {
            for parameter in kind.parameters() {
                let scaled = |x| parameter.scaled(x, data.supply, no_load);
                let name = format!("{}.{}", kind.name(), parameter.name);
                let unit = parameter.quantity.unit();
                if parameter.form.is_some() {
                    let (low, high) = parameter.range;
                    let range = (scaled(low), scaled(high));
                    unknowns.push(Unknown::held(&name, unit, 0.0, range));
                    continue;
                }
                let most = match kind {
                    Kind::Delay => longest_delay(data, parameter.range.1),
                    _ => scaled(parameter.range.1),
                };
                let unknown = Unknown::new(
                    &name,
                    unit,
                    (scaled(parameter.range.0), most),
                    if parameter.amplitude || parameter.range.0 <= 0.0 {
                        Scale::Linear
                    } else {
                        Scale::Log
                    },
                );
                let unknown = match parameter.quantity {
                    Quantity::PerRev => unknown.whole(),
                    _ => unknown,
                };
                unknowns.push(if parameter.widest > parameter.range.1 {
                    unknown.widening_to(scaled(parameter.widest))
                } else {
                    unknown
                });
            }
        }
        let start_offset = data.quantised && effects.iter().any(|kind| kind.needs().angle);
        if start_speed {
            unknowns.push(Unknown::new(
                START_SPEED,
                "rad/s",
                (-1.5 * no_load, 1.5 * no_load),
                Scale::Linear,
            ));
        }
        if start_offset {
            unknowns.push(Unknown::new(
                START_OFFSET,
                "count",
                (-FARTHEST_START, FARTHEST_START),
                Scale::Linear,
            ));
        }
        Structure {
            base,
            effects: effects.to_vec(),
            start_speed,
            start_offset,
            unknowns,
        }
    }

    /// The same with an unknown that stays at `value`.
    #[must_use]
    pub fn with_fixed(mut self, name: &str, value: f64) -> Self {
        for unknown in self
            .unknowns
            .iter_mut()
            .filter(|unknown| unknown.name == name)
        {
            unknown.confine((value, value));
        }
        self
    }

    /// The same with each range widened at whose upper end the point `x` of the unit cube is; `None` where there is no such or
    /// none may be wider.
    pub fn widened_at(&self, x: &[f64]) -> Option<Structure> {
        let mut wider = self.clone();
        let mut any = false;
        for (unknown, &x) in wider.unknowns.iter_mut().zip(x) {
            any |= unknown.widen_at(x);
        }
        any.then_some(wider)
    }

    /// The same with every form searched for that is held at the textbook's; `None` where none is. Where there is no friction, none is shared.
    pub fn with_forms_free(&self) -> Option<Structure> {
        let mut freed = self.clone();
        let rubs = self.effects.iter().any(|kind| kind.needs().friction);
        let searched = self.effects.iter();
        let searched = searched.filter(|kind| rubs || kind.form() != Some(Form::FrictionShare));
        for name in searched.filter_map(|kind| form_name(*kind)) {
            let of_kind = freed.unknowns.iter_mut().filter(|u| u.name == name);
            of_kind.for_each(Unknown::free);
        }
        (freed.held() < self.held()).then_some(freed)
    }

    /// The same with the form of `kind` held at `form`; a share of friction is searched for where it is not zero.
    #[must_use]
    pub fn with_form_at(mut self, kind: Kind, form: f64) -> Self {
        let Some(name) = form_name(kind) else {
            return self;
        };
        let of_kind = |unknown: &&mut Unknown| unknown.name == name;
        for unknown in self.unknowns.iter_mut().filter(of_kind) {
            match kind.form() {
                Some(Form::FrictionShare) if form != 0.0 => unknown.free(),
                _ => unknown.hold_at(form),
            }
        }
        self
    }

    /// Searches for the forms that `other` searches for, and holds the others where it holds them.
    pub fn take_forms_of(&mut self, other: &Structure) {
        let held = self.unknowns.iter_mut().filter(|u| u.held_from.is_some());
        for unknown in held {
            let same = other.unknowns.iter().find(|u| u.name == unknown.name);
            match same {
                Some(known) if known.held_from.is_some() => unknown.hold_at(known.range.0),
                Some(_) => unknown.free(),
                None => {}
            }
        }
    }

    /// Searches for the forms that are not the textbook's in `values`, which has a value of each unknown.
    pub fn free_forms_in(&mut self, values: &[f64]) {
        for (unknown, &value) in self.unknowns.iter_mut().zip(values) {
            if value != 0.0 {
                unknown.free();
            }
        }
    }

    /// How many of the unknowns are held.
    pub fn held(&self) -> usize {
        let held = |unknown: &&Unknown| unknown.held_from.is_some();
        self.unknowns.iter().filter(held).count()
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.unknowns.len()
    }

    /// Values at a point of the unit cube.
    pub fn values(&self, x: &[f64]) -> Vec<f64> {
        self.unknowns
            .iter()
            .zip(x)
            .map(|(unknown, &x)| unknown.value(x))
            .collect()
    }

    /// Point of the unit cube with these values.
    pub fn coordinates(&self, values: &[f64]) -> Vec<f64> {
        self.unknowns
            .iter()
            .zip(values)
            .map(|(unknown, &v)| unknown.coordinate(v))
            .collect()
    }

    /// The values that belong to effects, in the order of the effects.
    pub fn effect_values<'v>(&self, values: &'v [f64]) -> &'v [f64] {
        let nuisances = usize::from(self.start_speed) + usize::from(self.start_offset);
        &values[base_len(self.base)..values.len() - nuisances]
    }

    /// The model at a point of the unit cube.
    pub fn candidate_at(&self, x: &[f64]) -> Candidate {
        self.candidate(&self.values(x))
    }

    /// The model with these values of the unknowns.
    pub fn candidate(&self, values: &[f64]) -> Candidate {
        let (base, mut rest) = values.split_at(base_len(self.base));
        let machine = match self.base {
            Base::Response { damping } => {
                let (gain, a1, electrical) = (base[0], base[1], base[2]);
                let part = if damping { base[3] } else { 0.0 };
                machine(gain, a1, electrical, part)
            }
            Base::Physical { .. } => Physical {
                inductance: base[0],
                resistance: base[1],
                kt: base[2],
                inertia: base[3],
                viscous: base[4],
                kb: base[5],
            }
            .machine(),
            Base::CurrentDriven => Machine {
                kb: 0.0,
                damping: base[1],
                inertia: base[0],
                electrical: 0.0,
            },
        };
        let mut effects = EffectSet::default();
        for &kind in &self.effects {
            let (own, further) = rest.split_at(kind.parameters().len());
            // Values come from finite ranges and the caller checked the number of effects.
            let _ = effects.push(kind, own);
            rest = further;
        }
        let mut nuisances = rest.iter().copied();
        let mut nuisance = |present: bool| {
            let value = if present { nuisances.next() } else { None };
            value.unwrap_or(0.0)
        };
        let start_speed = nuisance(self.start_speed);
        let start_offset = nuisance(self.start_offset);
        Candidate {
            machine,
            effects,
            start_speed,
            start_offset,
        }
    }

    /// Point of the unit cube that describes a candidate with the same effects; outside of it where that leaves the
    /// ranges.
    pub fn point(&self, candidate: &Candidate) -> Vec<f64> {
        self.coordinates(&self.values_in(candidate))
    }

    /// Values of the unknowns in a model.
    pub fn values_in(&self, candidate: &Candidate) -> Vec<f64> {
        let effects: Vec<f64> = (candidate.effects.iter())
            .flat_map(|(_, values)| values.to_vec())
            .collect();
        let mut values = self.values_of(&candidate.machine, &effects, candidate.start_speed);
        if self.start_offset
            && let Some(offset) = values.last_mut()
        {
            *offset = candidate.start_offset;
        }
        values
    }

    /// Values of the unknowns that describe `machine`; effects and nuisances as given.
    pub fn values_of(&self, machine: &Machine<f64>, effects: &[f64], start_speed: f64) -> Vec<f64> {
        let response = machine.response();
        let mut values = match self.base {
            Base::Response { damping } => {
                let mut base = vec![response.gain, response.a1, machine.electrical];
                if damping {
                    base.push(machine.damping * response.gain);
                }
                base
            }
            // One of many with this response: a resistance of one ohm and equal constants.
            Base::Physical { .. } => {
                let k = machine.kb;
                vec![
                    machine.electrical,
                    1.0,
                    k,
                    machine.inertia * k,
                    machine.damping * k,
                    k,
                ]
            }
            Base::CurrentDriven => vec![machine.inertia, machine.damping],
        };
        values.extend_from_slice(effects);
        if self.start_speed {
            values.push(start_speed);
        }
        if self.start_offset {
            values.push(0.0);
        }
        values
    }
}

/// The machine with a given gain, a1 and electrical time constant, of whose damping `part` is
/// viscous: `m + τe·b = a1·D` with `D = 1/gain`, `b = part·D`.
fn machine(gain: f64, a1: f64, electrical: f64, part: f64) -> Machine<f64> {
    let total = 1.0 / gain;
    let damping = part * total;
    Machine {
        kb: total - damping,
        damping,
        inertia: (a1 * total - electrical * damping).max(a1 * total * 1e-6),
        electrical,
    }
}

fn base_len(base: Base) -> usize {
    match base {
        Base::Response { damping: false } => 3,
        Base::Response { damping: true } => 4,
        Base::Physical { .. } => 6,
        Base::CurrentDriven => 2,
    }
}

/// Search ranges reach this factor to both sides of the first guess.
const REACH: f64 = 20.0;

/// Most of a delay that is searched for, s: `usual`, or as many samples as the model remembers where those last much longer. A log
/// of 200 Hz over a bus may be late by a tenth of a second.
fn longest_delay(data: &Data, usual: f64) -> f64 {
    let remembered = (MAX_DELAY - 1) as f64 * data.units.interval;
    if remembered > 2.0 * usual {
        remembered.min(LONGEST_DELAY_S)
    } else {
        usual
    }
}

fn base_unknowns(base: Base, data: &Data, centre: &Machine<f64>) -> Vec<Unknown> {
    let around = |value: f64| (value / REACH, value * REACH);
    match base {
        Base::Response { damping } => {
            let Response { gain, a1, .. } = centre.response();
            let slowest = (a1.max(centre.electrical) * 4.0).max(data.units.interval);
            let mut unknowns = vec![
                Unknown::new("gain", "rad/(s*V)", around(gain), Scale::Log),
                Unknown::new("a1", "s", around(a1), Scale::Log),
                Unknown::new(ELECTRICAL_TIME_CONSTANT, "s", (0.0, slowest), Scale::Linear),
            ];
            if damping {
                unknowns.push(Unknown::new(VISCOUS_PART, "1", (0.0, 0.98), Scale::Linear));
            }
            unknowns
        }
        Base::Physical { range } => [
            ("inductance", "H"),
            ("resistance", "ohm"),
            ("kt", "N*m/A"),
            ("inertia", "kg*m^2"),
            ("viscous", "N*m*s/rad"),
            ("kb", "V*s/rad"),
        ]
        .map(|(name, unit)| Unknown::new(name, unit, range, Scale::Linear))
        .to_vec(),
        Base::CurrentDriven => {
            let fastest = data.supply / data.units.speed;
            vec![
                Unknown::new("inertia", "V*s^2/rad", around(centre.inertia), Scale::Log),
                Unknown::new(
                    "damping",
                    "V*s/rad",
                    (0.0, (4.0 * centre.damping).max(fastest)),
                    Scale::Linear,
                ),
            ]
        }
    }
}

/// The unknown that is the form of an effect, if it has one: its last parameter.
fn form_name(kind: Kind) -> Option<String> {
    kind.form()?;
    let parameter = kind.parameters().last()?;
    Some(format!("{}.{}", kind.name(), parameter.name))
}
