//! The parameters of a fit with their standard errors, in the units that a user can use.

use super::physical::{Estimate, NAMES, Reconciled};
use super::systematic::Systematic;
use super::uncertainty::Uncertainty;
use super::wave::Wave;
use servoid_engine::problem::{Data, FitProblem, Unknown};
use servoid_io::recording::Drive;
use shared::effects::{self, Kind, Pair};
use shared::units::Quantity;
use std::f64::consts::TAU;

/// One parameter of a fitted model.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name; an effect's parameters carry its name before a point.
    pub name: String,
    /// Value.
    pub value: f64,
    /// Unit symbol.
    pub unit: &'static str,
    /// Standard error; `None` where the data do not determine it.
    pub std: Option<f64>,
    /// Whether the data (with the known facts) determine it.
    pub identifiable: bool,
    /// Standard deviation of the values that several recordings give, each fitted alone.
    pub spread: Option<f64>,
    /// Whether a bound of its search range holds it: then it has no standard error.
    pub at_bound: bool,
    /// The value in the unit in which such a quantity is usually stated, where that is another one.
    pub usual: Option<Usual>,
    /// What it would change by if the recording is not what it says; only of the front door.
    pub systematic: Vec<Systematic>,
}

/// A value in the unit in which such a quantity is usually stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Usual {
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
}

impl Parameter {
    /// One whose error is not known.
    pub(crate) fn without_error(name: String, value: f64, unit: &'static str) -> Self {
        Self::new(name, value, unit, None)
    }

    /// Sets the standard error; `None` where the data do not determine it.
    pub(crate) fn set_std(&mut self, std: Option<f64>) {
        self.std = std;
        self.identifiable = std.is_some_and(|std| std < 0.5 * self.value.abs());
    }

    /// Largest change by an error of the recording, without its sign; zero where none is known.
    pub fn largest_systematic(&self) -> f64 {
        let changes = self.systematic.iter().map(|one| one.change.abs());
        changes.fold(0.0, f64::max)
    }

    fn new(name: String, value: f64, unit: &'static str, std: Option<f64>) -> Self {
        let mut parameter = Parameter {
            identifiable: false,
            name,
            value,
            unit,
            std: None,
            spread: None,
            at_bound: false,
            usual: None,
            systematic: Vec::new(),
        };
        parameter.set_std(std);
        parameter
    }
}

/// The unknowns and the physical parameters. What a user should know of their units goes to `notes`.
pub(super) fn parameters(
    problem: &FitProblem<'_>,
    values: &[f64],
    spread: Option<&Uncertainty>,
    reconciled: Option<&Reconciled>,
    notes: &mut Vec<String>,
) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    let torque_scale = reconciled.and_then(|r| r.volts_per_torque);
    let mut in_volts = false;
    let mut push = |mut parameter: Parameter, quantity: Option<Quantity>| {
        parameter.usual = quantity.and_then(|q| usual(problem.data, q, parameter.value));
        parameter.unit = problem.data.drive.unit(parameter.unit);
        if quantity == Some(Quantity::Torque) {
            match torque_scale {
                Some(scale) => to_newton_metres(&mut parameter, scale),
                None => in_volts = true,
            }
        }
        parameters.push(parameter);
    };
    // A form that is held at the textbook's is nothing that was found; its relative, one of two, was chosen.
    let unknowns = problem.structure.unknowns.iter().enumerate();
    for (k, unknown) in unknowns.filter(|(k, u)| u.held_from.is_none() || values[*k] != 0.0) {
        let found = found(unknown, values[k], k, spread);
        let chosen = unknown.held_from.is_some();
        let converged = spread.is_some_and(|s| s.converged);
        if found.std.is_none() && !chosen && !found.at_bound && converged {
            notes.push(format!(
                "{}: this recording does not determine it",
                found.name
            ));
        }
        let (kind, parameter) = of_effect(problem, &unknown.name).unzip();
        push(found, parameter.map(|p: &effects::Parameter| p.quantity));
        // After the second of a pair.
        if let Some(kind) = kind.filter(|kind: &Kind| {
            kind.facts().pair == Some(Pair::CosineAndSine)
                && parameter.map(|p| p.name) == kind.parameters().get(1).map(|p| p.name)
        }) {
            for (wave, quantity) in wave(kind, k, values, spread) {
                push(wave, quantity);
            }
        }
    }
    if !problem.data.drive.is_voltage() {
        notes.push(
            match problem.data.drive {
                Drive::Torque => "inertia, friction and torques are those that the commanded torque tells",
                _ => {
                    "behind a current loop inertia, friction and torques are in amperes of the command: multiply by \
                     its torque (or force) per ampere"
                }
            }
            .to_owned(),
        );
    } else if in_volts {
        notes.push(
            "torques are given as the voltage T*R/Kt that they use up: state the resistance and \
             kt_equals_kb (or kt) under [known] to get N*m"
                .to_owned(),
        );
    }
    for ((name, unit), estimate) in NAMES.iter().zip(reconciled.iter().flat_map(|r| r.physical)) {
        if let Some(Estimate { value, std }) = estimate {
            let physical = Parameter::new((*name).to_owned(), value, unit, Some(std));
            parameters.push(Parameter {
                identifiable: std == 0.0 || physical.identifiable,
                ..physical
            });
        }
    }
    parameters
}

/// Unknown `k`. What a bound holds has no error: the data would have it elsewhere. A whole number has none either.
fn found(unknown: &Unknown, value: f64, k: usize, spread: Option<&Uncertainty>) -> Parameter {
    let name = unknown.name.clone();
    if unknown.whole {
        let std = spread.filter(|s| s.converged).map(|_| 0.0);
        return Parameter::new(name, value, unknown.unit, std);
    }
    let at_bound = unknown.ends_at(value);
    let std = spread
        .and_then(|s| s.std(k))
        .filter(|std| !at_bound && *std < value.abs().max(1e-300) * 1e3);
    Parameter {
        at_bound,
        ..Parameter::new(name, value, unknown.unit, std)
    }
}

/// The effect's parameter that an unknown is, if it is one.
fn of_effect(problem: &FitProblem<'_>, name: &str) -> Option<(Kind, &'static effects::Parameter)> {
    let (effect, parameter) = name.split_once('.')?;
    let kind = (problem.structure.effects.iter()).find(|kind| kind.name() == effect)?;
    let parameter = kind.parameters().iter().find(|p| p.name == parameter)?;
    Some((*kind, parameter))
}

/// Amplitude C and phase p of a wave `A·cos(kθ) + B·sin(kθ) = C·cos(kθ − p)`, whose second amplitude is unknown `second`.
fn wave(
    kind: Kind,
    second: usize,
    values: &[f64],
    spread: Option<&Uncertainty>,
) -> Vec<(Parameter, Option<Quantity>)> {
    let Some(first) = second.checked_sub(1) else {
        return Vec::new();
    };
    let Some(wave) = Wave::new([values[first], values[second]], [first, second], spread) else {
        return Vec::new();
    };
    let ((amplitude, amplitude_std), (phase, phase_std)) = (wave.amplitude(), wave.phase());
    let size = &kind.parameters()[0];
    let name = |what: &str| format!("{}.{what}", kind.name());
    let phase = Parameter {
        // A phase of nothing is none.
        identifiable: phase_std.is_some_and(|std| std < 0.5),
        ..Parameter::new(name("phase"), phase, "rad", phase_std)
    };
    vec![
        (
            Parameter::new(
                name("amplitude"),
                amplitude,
                size.quantity.unit(),
                amplitude_std,
            ),
            Some(size.quantity),
        ),
        (phase, None),
    ]
}

/// A torque in parts of the stall torque, an angle in counts, a speed in revolutions a minute.
fn usual(data: &Data, quantity: Quantity, value: f64) -> Option<Usual> {
    let (factor, unit) = match quantity {
        Quantity::Torque if data.drive == Drive::Voltage => {
            (100.0 / data.supply, "% of stall torque")
        }
        Quantity::Angle => (data.units.counts_per_rev / TAU, "count"),
        Quantity::Speed => (60.0 / TAU, "rpm"),
        _ => return None,
    };
    let value = value * factor;
    value.is_finite().then_some(Usual { value, unit })
}

fn to_newton_metres(parameter: &mut Parameter, volts_per_torque: Estimate) {
    let torque = parameter.value / volts_per_torque.value;
    let relative = volts_per_torque.std / volts_per_torque.value;
    parameter.std = parameter
        .std
        .map(|std| libm::hypot(std / volts_per_torque.value, torque * relative));
    parameter.value = torque;
    parameter.unit = "N*m";
}
