//! What acts in a part of a step, foreseen.
//!
//! The maps are exact for held voltage and torque. What the effects add depends on speed, angle and
//! current, so it is asked for twice: near the start, to foresee the part; then at the mean of what
//! was foreseen, to take it. What is held at its mean leaves an error of third order in the length
//! of the part. Where the two answers differ much, the part is doubtful, and is better halved.

use super::Model;
use super::body::{Body, Increment};
use super::friction::{Forces, direction};
use super::rung::Timing;
use super::state::{Motion, State};
use super::winding::{bends, extra_volts};
use crate::effects::{Lowered, Shaft};
use crate::scalar::{Angle, Mask, Scalar};

/// A part is halved if what acts in it, per unit, changes on second thought by more than this.
const DOUBT: f64 = 0.004;

/// What acts in a part.
pub(super) struct Foreseen<S: Scalar> {
    /// What is held for the part.
    pub(super) forces: Forces<S>,
    /// Whether the part is too long for that.
    pub(super) doubtful: S::Mask,
}

impl<S: Scalar> Model<S> {
    /// What acts where nothing depends on the state.
    pub(super) fn constant(effects: &Lowered<S>) -> Forces<S> {
        let rest = Shaft::at(S::zero(), S::zero(), S::zero());
        let budget = effects.friction(&rest);
        let torque = effects.torque(&rest, &Default::default());
        Forces {
            volts: S::zero(),
            torque: torque + budget.bias,
            budget,
        }
    }

    /// The shaft at the start of a part.
    #[inline(always)]
    pub(super) fn start(&self, motion: &Motion<S>, timing: &Timing<S>, open: bool) -> Shaft<S> {
        let turns = if self.effects.needs.angle {
            motion.angle.turns(self.counts_per_rev)
        } else {
            S::zero()
        };
        let current = if open { S::zero() } else { motion.current };
        let ahead = motion.speed.times(timing.length);
        Shaft {
            travel: ahead.times(self.turns_per_unit),
            give: timing.give.times(self.turns_per_unit),
            length: timing.length,
            per_length: timing.per_length,
            ..Shaft::at(turns, motion.speed, current)
        }
    }

    /// The mean shaft of a part that began at `start` and brings `by` at `volts` on the winding.
    pub(super) fn mean(
        &self,
        start: &Shaft<S>,
        by: &Increment<S>,
        volts: S,
        timing: &Timing<S>,
        open: bool,
    ) -> Shaft<S> {
        let half = S::from_f64(0.5);
        let twelfth = S::coefficient(1.0 / 12.0);
        let travel = by.angle.times(self.turns_per_unit);
        // While the speed changes evenly, the mean of the angle is this far from its middle.
        let gathered = by.speed.times(timing.length).times(self.turns_per_unit);
        let late = gathered.times(twelfth);
        let speed = by.angle.times(timing.per_length);
        let (current, current_change) = if open {
            (S::zero(), S::zero())
        } else {
            let mean = volts - speed.times(timing.kb) - by.current.times(timing.lag);
            (mean, by.current)
        };
        Shaft {
            turns: start.turns + travel * half - late,
            travel,
            late,
            speed,
            speed_change: by.speed,
            current,
            current_change,
            ..*start
        }
    }

    /// What acts at `shaft` and is held for the part, with the drive at `volts` and a torque
    /// `further` that is known already.
    #[inline(always)]
    pub(super) fn forces(
        &self,
        state: &State<S>,
        shaft: &Shaft<S>,
        volts: S,
        further: S,
        open: bool,
    ) -> Forces<S> {
        let effects = &self.effects;
        let mut torque = further + effects.torque(shaft, &state.memory);
        let mut shaft = *shaft;
        shaft.transmitted = shaft.current + torque;
        if effects.needs.winding && !open {
            let lost = effects.winding(volts, &shaft, &state.memory).lost_torque;
            shaft.transmitted = shaft.transmitted - lost;
            torque = torque + lost;
        }
        let budget = effects.friction(&shaft);
        Forces {
            volts,
            torque: torque + budget.bias,
            budget,
        }
    }

    /// What acts in a part that begins at `start` with the drive at `volts`.
    pub(super) fn foresee<B: Body<S>>(
        &self,
        body: &B,
        level: usize,
        state: &State<S>,
        start: &Shaft<S>,
        volts: S,
        open: bool,
    ) -> Foreseen<S> {
        let zero = S::zero();
        let Lowered { needs, brush, .. } = &self.effects;
        let timing = body.timing(level);
        let side = body.side(&state.motion);
        let slide = |volts: S, torque: S| {
            let by = body.slide(level, &state.motion, side, volts, torque, open);
            self.mean(start, &by, volts, timing, open)
        };
        let winding = |at: &Shaft<S>, free: &Shaft<S>| {
            let changed = self.effects.winding(volts, at, &state.memory);
            extra_volts(&changed, brush, volts, free, timing)
        };

        // Near the start: the speed alone foresees the angle.
        let ahead = Shaft {
            turns: start.turns + start.travel * S::from_f64(0.5),
            ..*start
        };
        let near = self.forces(state, &ahead, volts, zero, open);
        let pull = start.current - near.torque - body.load(&state.motion, side);
        let sense = direction(start.speed, pull, &near.budget);
        let torque = near.torque + sense * near.budget.moving;
        let mut shaft = slide(volts, torque);
        let changes = needs.winding && !open;
        let mut extra = zero;
        if changes {
            extra = winding(start, &shaft);
            shaft = slide(volts + extra, torque);
        }
        let mut stiff = zero;
        if needs.stiff {
            stiff = self.effects.stiff(&shaft, &state.memory).from(zero);
            shaft = slide(volts + extra, torque + stiff);
        }

        // At the mean of that.
        let mut doubt = zero;
        let mut doubtful = zero.less(zero);
        if changes {
            let free = Shaft {
                current: shaft.current - timing.gain * extra,
                ..shaft
            };
            let again = winding(&shaft, &free);
            shaft.current = free.current + timing.gain * again;
            doubt = doubt + (again - extra).abs();
            doubtful = bends(brush, start, &shaft);
            extra = again;
        }
        if needs.stiff {
            let given = self.effects.stiff(&shaft, &state.memory);
            let again = given.from(stiff);
            doubt = doubt + (again - stiff).abs() + given.doubt;
            stiff = again;
        }
        let mut forces = self.forces(state, &shaft, volts, stiff, open);
        doubt = doubt + (forces.torque - stiff - near.torque).abs();
        doubt = doubt + (forces.budget.moving - near.budget.moving).abs();
        forces.volts = volts + extra;
        let tolerated = S::from_f64(DOUBT);
        Foreseen {
            forces,
            doubtful: doubtful.or(tolerated.less(doubt)),
        }
    }
}
