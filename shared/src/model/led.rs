//! The model led along a motion that was measured: its effects act where the shaft was seen, not where
//! the model has it.
//!
//! A model that lacks an effect drifts away from the measurement, and what depends on angle and speed then
//! acts at the wrong place: the open-loop error as a function of the parameters is rough, chaotic where a
//! rotor slips detents. Led, it is smooth, linear in the effects' amplitudes, and costs little more than
//! the linear machine. It is a start for a search, not a verdict: a true effect must hold its own in
//! [`Model::step`]. (In the theory of identification: a series-parallel model.)

use super::state::State;
use super::{Model, friction};
use crate::effects::Shaft;
use crate::scalar::{Angle, Scalar};

/// What was seen of the shaft over one interval.
#[derive(Clone, Copy, Debug)]
pub struct Seen<S> {
    /// Position within a revolution at the middle, as a fraction of a turn.
    pub turns: S,
    /// Mean speed, per unit; exactly zero for a shaft at rest.
    pub speed: S,
    /// By how much the speed changed.
    pub speed_change: S,
}

impl<S: Scalar> Model<S> {
    /// Advances by one interval with `command` held, the effects evaluated at `seen`. Delays and loads
    /// behind a spring or a gap are not followed.
    #[inline(always)]
    pub fn lead(&self, state: &mut State<S>, command: S, open: bool, seen: &Seen<S>) {
        let rung = &self.rest.motor[0];
        let timing = rung.timing();
        let effects = &self.effects;
        let zero = S::zero();
        let volts = effects.drive(command);
        let motion = &state.motion;
        let free = rung.slide(motion, volts, zero, open);
        let mut shaft = Shaft {
            travel: seen.speed.times(timing.length).times(self.turns_per_unit),
            speed_change: seen.speed_change,
            length: timing.length,
            per_length: timing.per_length,
            ..Shaft::at(seen.turns, seen.speed, zero)
        };
        if !open {
            shaft.current = volts - seen.speed.times(timing.kb) - free.current.times(timing.lag);
            shaft.current_change = free.current;
        }
        let mut extra = zero;
        if effects.needs.winding && !open {
            extra = self.extra_volts(state, volts, &shaft, &shaft, timing);
            shaft.current = shaft.current + timing.gain * extra;
        }
        let forces = self.forces(state, &shaft, volts, zero, open);
        let mut torque = forces.torque;
        if effects.needs.friction {
            let budget = &forces.budget;
            let pull = shaft.current - torque;
            let held = pull.min(budget.holding).max(-budget.holding);
            let drag = budget.moving * seen.speed.signum();
            torque = torque + S::select(friction::is_zero(seen.speed), held, drag);
        }
        let by = rung.slide(motion, volts + extra, torque, open);
        if effects.needs.memory {
            effects.remember(&mut state.memory, &shaft);
        }
        let motion = &mut state.motion;
        motion.current = motion.current + by.current;
        motion.speed = motion.speed + by.speed;
        motion.angle = motion.angle.advance(by.angle, self.counts_per_unit);
    }

    /// What the encoder sees, in counts before it rounds down, if its disc stands at `turns`.
    #[inline(always)]
    pub fn reading_at(&self, state: &State<S>, turns: S) -> S::Angle {
        if !self.effects.needs.sensed {
            return state.motion.angle;
        }
        let error = self.effects.sensed(turns, &state.memory);
        state.motion.angle.advance(error, self.counts_per_turn)
    }
}
