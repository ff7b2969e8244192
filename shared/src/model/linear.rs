//! The step of a motor without effects as what it is: a linear map. For those who take many steps at once.

use super::Plan;
use super::rung::{driven, shortest};
use crate::discretise::{Discretisation, lower};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::units::PerUnit;

/// What a step with the bridge closed adds to the state, per unit; to the angle, counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Increments {
    /// To current and speed, each by current and speed.
    pub state: [[f64; 2]; 2],
    /// To current and speed by the command.
    pub state_by_command: [f64; 2],
    /// To the angle by current and speed.
    pub angle: [f64; 2],
    /// To the angle by the command.
    pub angle_by_command: f64,
    /// To current, speed and angle by a held torque against positive rotation.
    pub by_torque: [f64; 3],
}

impl Increments {
    /// Of the step of a plan without its effects: the numbers that a [`Model`](super::Model) of it has.
    ///
    /// # Errors
    /// Those of the model.
    pub fn new(plan: &Plan<f64>) -> Result<Self, ModelError> {
        Self::of(&plan.machine, &plan.units, plan.discretisation)
    }

    /// The same of a machine.
    ///
    /// # Errors
    /// Those of a model of it.
    pub fn of(
        machine: &Machine<f64>,
        units: &PerUnit<f64>,
        how: Discretisation,
    ) -> Result<Self, ModelError> {
        machine.check()?;
        // Of a rung's maps, only the one that a closed bridge needs: searches come here with every candidate.
        let (machine, lengths) = shortest(&machine.lower(units), 1.0, 0, how);
        let map = driven(&machine, lengths[0]).step(lengths[0], how)?;
        let [current, speed] = map.states;
        let [current_by, speed_by] = map.inputs;
        let (angle, angle_by) = (map.angle_by_states, map.angle_by_inputs);
        let all = [current, speed, current_by, speed_by, angle, angle_by];
        for (name, [a, b]) in NAMES.into_iter().zip(all) {
            lower::<f64, f64>(name, &mut [0.0; 2], &[a, b])?;
        }
        let counts = units.counts_per_unit();
        Ok(Increments {
            state: [current, speed],
            state_by_command: [current_by[0], speed_by[0]],
            angle: angle.map(|by| by * counts),
            angle_by_command: angle_by[0] * counts,
            by_torque: [current_by[1], speed_by[1], angle_by[1] * counts],
        })
    }
}

const NAMES: [&str; 6] = [
    "current increment",
    "speed increment",
    "current increment",
    "speed increment",
    "angle increment",
    "angle increment",
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::discretise::Discretisation;
    use crate::model::{Model, State};
    use crate::motor::Machine;
    use crate::units::PerUnit;

    /// From anywhere, a model's step adds what the increments say.
    #[test]
    fn they_are_what_the_model_adds() {
        let units = PerUnit::new(12.0, 240.0, 1e-3, 2000.0).expect("bases");
        for electrical in [0.0, 1e-5, 1.6e-3, 0.2] {
            let machine = Machine {
                kb: 0.05,
                damping: 0.002,
                inertia: 0.0025,
                electrical,
            };
            for discretisation in [Discretisation::Exact, Discretisation::Euler] {
                let plan = Plan {
                    discretisation,
                    ..Plan::linear(machine, units)
                };
                let (Ok(model), Ok(by)) = (Model::<f64>::new(&plan), Increments::new(&plan)) else {
                    assert!(electrical == 0.0, "{plan:?}");
                    continue;
                };
                for (current, speed, command) in
                    [(0.3, -0.2, 0.7), (-0.9, 0.4, 0.0), (0.0, 0.0, -1.0)]
                {
                    let mut state = State::<f64>::at(0.0, speed);
                    state.motion.current = current;
                    model.step(&mut state, command, false);
                    let sum = |row: [f64; 2], by_command: f64| {
                        row[0] * current + row[1] * speed + by_command * command
                    };
                    let added = [
                        (
                            state.motion.current - current,
                            sum(by.state[0], by.state_by_command[0]),
                        ),
                        (
                            state.motion.speed - speed,
                            sum(by.state[1], by.state_by_command[1]),
                        ),
                        (state.motion.angle, sum(by.angle, by.angle_by_command)),
                    ];
                    for (model, own) in added {
                        let scale = model.abs().max(own.abs()).max(1.0);
                        assert!(
                            (model - own).abs() < 1e-14 * scale,
                            "{model} {own}: {plan:?}"
                        );
                    }
                }
            }
        }
    }
}
