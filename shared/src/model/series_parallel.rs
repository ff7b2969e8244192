//! The series-parallel form of the model: it steps along a measured motion, and evaluates the effects at the measured
//! shaft, not at its own (Narendra, Parthasarathy, *Identification and control of dynamical systems using neural
//! networks*, IEEE Transactions on Neural Networks 1(1), 1990).
//!
//! A model that lacks an effect drifts away from the measurement, and whatever depends on angle and speed then acts at
//! the wrong place: the open-loop (parallel) error is a rough function of the parameters, chaotic where a rotor slips
//! detents. The series-parallel error is smooth, linear in the effects' amplitudes, and costs little more than the
//! linear machine. It serves to start a search, not to decide: a true effect must prove itself in [`Model::step`].

use super::state::State;
use super::{Model, friction};
use crate::effects::Shaft;
use crate::scalar::{Angle, Scalar};

/// The measured motion of the shaft over one interval.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredInterval<S> {
    /// Position within a revolution at the middle, as a fraction of a turn.
    pub turns: S,
    /// Mean speed, per unit; exactly zero for a shaft at rest.
    pub speed: S,
    /// Change of the speed, per unit.
    pub speed_change: S,
}

impl<S: Scalar> Model<S> {
    /// Advances by one interval with `command` held; evaluates the effects at the `measured` motion. Ignores delays and
    /// loads behind a spring or a gap.
    #[inline(always)]
    pub fn step_along(
        &self,
        state: &mut State<S>,
        command: S,
        open: bool,
        measured: &MeasuredInterval<S>,
    ) {
        let map = self.rest.motor.whole();
        let timing = map.timing();
        let effects = &self.effects;
        let zero = S::zero();
        let volts = effects.drive(command);
        let motion = &state.motion;
        let free = map.step_free(motion, volts, zero, open);
        let mut shaft = Shaft {
            travel: measured
                .speed
                .times(timing.length)
                .times(self.turns_per_unit),
            speed_change: measured.speed_change,
            volts,
            temperature: state.temperature,
            inertia: timing.inertia,
            length: timing.length,
            per_length: timing.per_length,
            ..Shaft::at(measured.turns, measured.speed, zero)
        };
        if !open {
            shaft.current =
                volts - measured.speed.times(timing.kb) - free.current.times(timing.lag);
            shaft.current_change = free.current;
        }
        let mut extra = zero;
        if effects.needs.winding && !open {
            (extra, _) = self.extra_volts(state, volts, &shaft, &shaft, timing);
            shaft.current = shaft.current + timing.gain * extra;
        }
        // Nothing is left to solve for where the motion is known.
        let stiff = if effects.needs.stiff {
            effects.stiff(&shaft, &state.memory).torque
        } else {
            zero
        };
        let forces = self.forces(state, &shaft, volts, stiff, open);
        let mut torque = forces.torque;
        if effects.needs.friction {
            let budget = &forces.budget;
            let pull = shaft.current - torque;
            let stuck = pull.min(budget.holding).max(-budget.holding);
            let drag = budget.moving * measured.speed.signum();
            torque = torque + S::select(friction::is_zero(measured.speed), stuck, drag);
        }
        let by = map.step_free(motion, volts + extra, torque, open);
        if effects.needs.memory {
            effects.remember(&mut state.memory, &shaft);
        }
        let motion = &mut state.motion;
        motion.current = motion.current + by.current;
        motion.speed = motion.speed + by.speed;
        motion.angle = motion.angle.advance(by.angle, self.counts_per_unit);
    }

    /// The angle that the encoder senses, in counts before it rounds down, if its disc stands at `turns`.
    #[inline(always)]
    pub fn reading_at(&self, state: &State<S>, turns: S) -> S::Angle {
        if !self.effects.needs.sensed {
            return state.motion.angle;
        }
        let error = self.effects.sensed(turns, &state.memory);
        state.motion.angle.advance(error, self.counts_per_turn)
    }
}
