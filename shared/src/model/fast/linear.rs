//! The step of a motor without effects: a linear map in plain numbers, for those who take many steps at once.

use crate::discretise::{Discretisation, lower};
use crate::error::ModelError;
use crate::model::Plan;
use crate::model::dyadic::shortest;
use crate::model::step_map::driven;
use crate::motor::Machine;
use crate::units::PerUnit;

/// What a step with the bridge closed adds to the state, per unit; to the angle in counts.
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
    /// Increments of a plan without its effects, as a [`Model`](crate::model::Model) of it has them.
    ///
    /// # Errors
    /// Those of the model.
    pub fn new(plan: &Plan<f64>) -> Result<Self, ModelError> {
        Self::of(&plan.machine, &plan.units, plan.discretisation)
    }

    /// Increments of a machine.
    ///
    /// # Errors
    /// Those of a model of it.
    pub fn of(
        machine: &Machine<f64>,
        units: &PerUnit<f64>,
        how: Discretisation,
    ) -> Result<Self, ModelError> {
        machine.check()?;
        // Only the map that a closed bridge needs: searches come here with every candidate.
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
