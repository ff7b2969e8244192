//! Whether a fitted machine can be one: what a search ends with may fit and still contradict the recording, or every motor.

use servoid_engine::problem::{Candidate, Data};
use shared::effects::{Kind, Parameter, Place};
use shared::units::Quantity;

/// Sample intervals, of which a motor that takes fewer to reach its speed shows no inertia.
const LEAST_SAMPLES: f64 = 0.05;
/// Longest electrical time constant of a servo motor's winding, s: that of large ones is some 0.05 s.
const SLOWEST_WINDING_S: f64 = 0.1;
/// Part of the largest command that a friction, an offset or a dead zone may be: beyond it the motor would not have moved.
const MOST_OF_COMMAND: f64 = 1.0;
/// The same of a torque that depends on the angle: within a part of a revolution its offset may stand for it.
const MOST_TORQUE: f64 = 2.0;

/// Why a machine cannot be, and the parameters that say so.
#[derive(Clone, Debug, PartialEq)]
pub struct Contradiction {
    /// Names of the parameters that are no result.
    pub parameters: Vec<String>,
    /// What contradicts what, and what to do.
    pub text: String,
}

/// What in a fitted model contradicts its recording; nothing where the machine can be.
pub fn contradictions(data: &Data, candidate: &Candidate) -> Vec<Contradiction> {
    inertia(data, candidate)
        .into_iter()
        .chain(winding(candidate))
        .chain(volts(data, candidate))
        .collect()
}

fn inertia(data: &Data, candidate: &Candidate) -> Option<Contradiction> {
    let machine = &candidate.machine;
    let damping = machine.kb + machine.damping;
    let seconds = machine.inertia / damping;
    let interval = data.units.interval;
    // Without damping the speed never settles, and inertia is what the acceleration shows.
    (damping > 0.0 && seconds < LEAST_SAMPLES * interval).then(|| Contradiction {
        parameters: ["a1", "inertia"].map(str::to_owned).into(),
        text: format!(
            "the inertia is no result: this machine would be at its speed within {seconds:.1e} s, far less than a sample of \
             {interval:.1e} s; record faster, or hold --bounds a1 where it is known"
        ),
    })
}

fn winding(candidate: &Candidate) -> Option<Contradiction> {
    let seconds = candidate.machine.electrical;
    (seconds > SLOWEST_WINDING_S).then(|| Contradiction {
        parameters: ["electrical_time_constant", "inductance"]
            .map(str::to_owned)
            .into(),
        text: format!(
            "the electrical time constant is no result: {seconds:.2} s is longer than that of any servo motor's winding; a \
             delay, a filter before the bridge or a load behind a spring looks like this (try --with delay or --with compliance)"
        ),
    })
}

fn volts(data: &Data, candidate: &Candidate) -> Vec<Contradiction> {
    let largest = data
        .command
        .iter()
        .fold(0.0f64, |most, u| most.max(u.abs()))
        * data.units.volts;
    let mut found = Vec::new();
    for (kind, values) in candidate.effects.iter() {
        let most = largest * share(kind);
        for (parameter, &value) in kind.description().parameters.iter().zip(values) {
            if acts_against_command(parameter) && value.abs() > most {
                found.push(Contradiction {
                    parameters: vec![format!("{}.{}", kind.name(), parameter.name)],
                    text: format!(
                        "{}.{} is no result: it takes {:.3} of a command that is at most {largest:.3}, so that the motor \
                         would not have moved as it did; is the command's unit right, and is its time that of the angle?",
                        kind.name(),
                        parameter.name,
                        value.abs()
                    ),
                });
            }
        }
    }
    found
}

fn share(kind: Kind) -> f64 {
    match kind.description().place {
        Place::Torque if kind.needs().angle => MOST_TORQUE,
        _ => MOST_OF_COMMAND,
    }
}

/// Whether a parameter is a voltage, or a torque in volts, that the effect takes from the command.
fn acts_against_command(parameter: &Parameter) -> bool {
    parameter.amplitude && matches!(parameter.quantity, Quantity::Voltage | Quantity::Torque)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::Options;
    use crate::fit::regression::typical;
    use crate::{Silent, identify};
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use shared::effects::EffectSet;

    fn recorded() -> Data {
        let hidden = Hidden::typical("coulomb", &showcase::machine()).unwrap();
        Data::new(&showcase::record(std::slice::from_ref(&hidden), 1, "bench").unwrap()).unwrap()
    }

    #[test]
    fn a_motor_that_can_be_contradicts_nothing_and_each_impossible_number_is_named() {
        let data = recorded();
        let recording = showcase::record(
            &[Hidden::typical("coulomb", &showcase::machine()).unwrap()],
            1,
            "bench",
        );
        let fit = identify(&recording.unwrap(), &Options::default(), &Silent::default()).unwrap();
        let possible = fit.candidate;
        assert_eq!(contradictions(&data, &possible), []);
        let mut light = possible;
        light.machine.inertia =
            1e-3 * data.units.interval * (light.machine.kb + light.machine.damping);
        let mut slow = possible;
        slow.machine.electrical = 2.3;
        for (candidate, name) in [(light, "inertia"), (slow, "electrical_time_constant")] {
            let found = contradictions(&data, &candidate);
            assert!(
                found.iter().any(|c| c.parameters.iter().any(|p| p == name)),
                "{name}: {found:?}"
            );
        }
    }

    /// For every effect that takes volts from the command.
    #[test]
    fn more_volts_than_there_are_is_no_result_for_any_effect() {
        let data = recorded();
        let mut tried = 0;
        for &kind in Kind::ALL {
            let parameters = kind.description().parameters;
            for (at, parameter) in parameters.iter().enumerate() {
                if !acts_against_command(parameter) {
                    continue;
                }
                let mut values = typical(&data, kind);
                values[at] = 3.0 * data.supply;
                let mut effects = EffectSet::default();
                effects.push(kind, &values).unwrap();
                let candidate = Candidate {
                    effects,
                    ..possible(&data)
                };
                let name = format!("{}.{}", kind.name(), parameter.name);
                let found = contradictions(&data, &candidate);
                assert!(
                    found.iter().any(|c| c.parameters.contains(&name)),
                    "{name}: {found:?}"
                );
                tried += 1;
            }
        }
        assert!(tried > 8, "{tried}");
    }

    fn possible(data: &Data) -> Candidate {
        let damping = data.supply / data.units.speed;
        Candidate {
            machine: shared::motor::Machine {
                kb: damping,
                damping: 0.0,
                inertia: 0.02 * damping,
                electrical: 1e-3,
            },
            effects: EffectSet::default(),
            start_speed: 0.0,
            start_offset: 0.0,
        }
    }
}
