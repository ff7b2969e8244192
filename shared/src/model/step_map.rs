//! The exact map of one step, or of one substep, of a motor that is one rigid body.
//!
//! Voltage and torque are held over the substep, so the map is linear. There are three of them: the bridge is closed
//! and the shaft turns; the bridge is open and the shaft coasts; friction holds the shaft and only the current moves.

use super::mechanics::Increment;
use super::state::Motion;
use crate::discretise::{Discretisation, LinearMap, LinearSystem, lower};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};

/// The maps of one substep, in the number format `S`. Each row is an increment.
#[derive(Clone, Copy, Debug)]
pub struct StepMap<S: Scalar> {
    /// Rows of current, speed and angle; columns `[c, ω, v, τ]`. The bridge is closed.
    current: [S::Coefficient; 4],
    speed: [S::Coefficient; 4],
    angle: [S::Coefficient; 4],
    /// Rows of speed and angle; columns `[ω, τ]`. The bridge is open, which cuts the current off at once.
    coast_speed: [S::Coefficient; 2],
    coast_angle: [S::Coefficient; 2],
    /// Row of the current; columns `[c, v]`. Friction holds the shaft.
    held: [S::Coefficient; 2],
}

lanes!(StepMap {
    current,
    speed,
    angle,
    coast_speed,
    coast_angle,
    held
});

/// The same three maps in a real format, before they are lowered.
#[derive(Clone, Copy)]
pub struct RealMaps<R> {
    driven: LinearMap<R, 2, 2>,
    coast: LinearMap<R, 1, 1>,
    held: LinearMap<R, 1, 1>,
}

/// A system of one state and one input.
fn alone<R: Real>(state: R, input: R) -> LinearSystem<R, 1, 1> {
    LinearSystem {
        states: [[state]],
        inputs: [[input]],
        speed: 0,
    }
}

/// The motor with the bridge closed: states current and speed, inputs voltage and torque against positive rotation,
/// rates over `length` intervals.
#[inline(always)]
pub fn driven<R: Real>(machine: &Machine<R>, length: R) -> LinearSystem<R, 2, 2> {
    let zero = R::zero();
    let rate = length / machine.electrical;
    let push = length / machine.inertia;
    LinearSystem {
        states: [
            [-rate, -(machine.kb * rate)],
            [push, -(machine.damping * push)],
        ],
        inputs: [[rate, zero], [zero, -push]],
        speed: 1,
    }
}

impl<R: Real> RealMaps<R> {
    /// Discretises the machine over a substep of `length` intervals.
    ///
    /// # Errors
    /// Rates that the format cannot follow.
    pub fn new(machine: &Machine<R>, length: R, how: Discretisation) -> Result<Self, ModelError> {
        let rate = length / machine.electrical;
        let push = length / machine.inertia;
        let drag = machine.damping * push;
        let driven = driven(machine, length);
        Ok(RealMaps {
            driven: driven.step(length, how)?,
            coast: alone(-drag, -push).step(length, how)?,
            held: alone(-rate, rate).step(length, how)?,
        })
    }

    /// The maps of a substep twice as long.
    #[must_use]
    pub fn twice(&self) -> Self {
        RealMaps {
            driven: self.driven.twice(),
            coast: self.coast.twice(),
            held: self.held.twice(),
        }
    }

    /// Current by a held volt, and angle by a held volt and a held torque, with the bridge closed.
    pub fn by_inputs(&self) -> (R, [R; 2]) {
        (self.driven.inputs[0][0], self.driven.angle_by_inputs)
    }

    /// Writes the multipliers into `step_map`. In place: a device has neither the stack nor the time to move many maps.
    ///
    /// # Errors
    /// A multiplier beyond the range of `S`.
    pub fn lower<S: Scalar>(&self, step_map: &mut StepMap<S>) -> Result<(), ModelError> {
        let driven = &self.driven;
        let row = |k: usize| {
            let (x, u) = (driven.states[k], driven.inputs[k]);
            [x[0], x[1], u[0], u[1]]
        };
        let (x, u) = (driven.angle_by_states, driven.angle_by_inputs);
        let (coast, held) = (&self.coast, &self.held);
        lower::<S, R>("current increment", &mut step_map.current, &row(0))?;
        lower::<S, R>("speed increment", &mut step_map.speed, &row(1))?;
        lower::<S, R>(
            "angle increment",
            &mut step_map.angle,
            &[x[0], x[1], u[0], u[1]],
        )?;
        let speed = [coast.states[0][0], coast.inputs[0][0]];
        lower::<S, R>(
            "coasting speed increment",
            &mut step_map.coast_speed,
            &speed,
        )?;
        let angle = [coast.angle_by_states[0], coast.angle_by_inputs[0]];
        lower::<S, R>(
            "coasting angle increment",
            &mut step_map.coast_angle,
            &angle,
        )?;
        let held = [held.states[0][0], held.inputs[0][0]];
        lower::<S, R>("held current increment", &mut step_map.held, &held)
    }
}

impl<S: Scalar> StepMap<S> {
    /// The map of zeros: nothing moves.
    pub const fn of(none: S::Coefficient) -> Self {
        StepMap {
            current: [none; 4],
            speed: [none; 4],
            angle: [none; 4],
            coast_speed: [none; 2],
            coast_angle: [none; 2],
            held: [none; 2],
        }
    }

    /// Multipliers of current, speed, voltage and torque for the increments of current, speed and angle, with the bridge
    /// closed.
    pub fn increments(&self) -> [&[S::Coefficient; 4]; 3] {
        [&self.current, &self.speed, &self.angle]
    }

    /// Increments by a held torque alone: of current, speed and angle, with the bridge closed.
    #[inline(always)]
    pub fn by_torque(&self, torque: S) -> [S; 3] {
        [
            torque.times(self.current[3]),
            torque.times(self.speed[3]),
            torque.times(self.angle[3]),
        ]
    }

    /// Increments by a held voltage alone: of current, speed and angle, with the bridge closed.
    #[inline(always)]
    pub fn by_volts(&self, volts: S) -> [S; 3] {
        [
            volts.times(self.current[2]),
            volts.times(self.speed[2]),
            volts.times(self.angle[2]),
        ]
    }

    /// Increments by current and speed alone: of current, speed and angle, with the bridge closed.
    #[inline(always)]
    pub fn by_state(&self, from: &Motion<S>) -> [S; 3] {
        let (current, speed) = (from.current, from.speed);
        [
            current.times(self.current[0]) + speed.times(self.current[1]),
            current.times(self.speed[0]) + speed.times(self.speed[1]),
            current.times(self.angle[0]) + speed.times(self.angle[1]),
        ]
    }

    /// Increment of the current by a held voltage, while friction holds the shaft and the bridge is closed.
    #[inline(always)]
    pub fn held_by_volts(&self, volts: S) -> S {
        volts.times(self.held[1])
    }

    /// Increment of the current by itself, likewise.
    #[inline(always)]
    pub fn held_by_current(&self, current: S) -> S {
        current.times(self.held[0])
    }

    /// Increments of a substep in which the shaft turns freely, under a held voltage and a held torque against positive
    /// rotation.
    #[inline(always)]
    pub fn step_free(&self, from: &Motion<S>, volts: S, torque: S, open: bool) -> Increment<S> {
        let speed = self.free_speed(from, volts, torque, open);
        let (current, angle) = self.free_current_and_angle(from, volts, torque, open);
        Increment {
            current,
            speed,
            angle,
            ..Increment::default()
        }
    }

    /// The increment of the speed alone.
    #[inline(always)]
    pub fn free_speed(&self, from: &Motion<S>, volts: S, torque: S, open: bool) -> S {
        if open {
            weighted_sum(&[from.speed, torque], &self.coast_speed)
        } else {
            weighted_sum(&[from.current, from.speed, volts, torque], &self.speed)
        }
    }

    /// The increments of current and angle.
    #[inline(always)]
    pub fn free_current_and_angle(
        &self,
        from: &Motion<S>,
        volts: S,
        torque: S,
        open: bool,
    ) -> (S, S) {
        if open {
            let angle = weighted_sum(&[from.speed, torque], &self.coast_angle);
            return (-from.current, angle);
        }
        let by = [from.current, from.speed, volts, torque];
        (
            weighted_sum(&by, &self.current),
            weighted_sum(&by, &self.angle),
        )
    }

    /// Speed by a held torque against positive rotation, with the bridge closed.
    #[inline(always)]
    pub fn speed_per_torque(&self) -> S::Coefficient {
        self.speed[3]
    }

    /// Current by a held volt, with the shaft turning and held, and the bridge closed.
    pub fn current_by_volts(&self) -> [S::Coefficient; 2] {
        [self.current[2], self.held[1]]
    }

    /// Increment of the current while friction holds the shaft.
    #[inline(always)]
    pub fn step_stuck(&self, current: S, volts: S, open: bool) -> S {
        if open {
            -current
        } else {
            current.times(self.held[0]) + volts.times(self.held[1])
        }
    }
}

/// `Σ numbers[k] · by[k]`, from the left.
#[inline(always)]
pub fn weighted_sum<S: Scalar, const K: usize>(numbers: &[S; K], by: &[S::Coefficient; K]) -> S {
    let mut sum = numbers[0].times(by[0]);
    for k in 1..K {
        sum = sum + numbers[k].times(by[k]);
    }
    sum
}
