//! One part of a step: what acts on winding and shaft, taken at the mean of the part.
//!
//! The maps are exact for held voltage and torque. What the effects add depends on speed, angle and
//! current, so it is evaluated twice: at the start, to foresee the part; then at the mean of what was
//! foreseen, to take it. What is held at its mean leaves an error of third order in the length of
//! the part.

use super::Model;
use super::body::{Body, Increment};
use super::friction::{Forces, direction, slide_and_stick};
use super::rung::Timing;
use super::state::{Motion, State};
use super::winding::extra_volts;
use crate::effects::{Lowered, Shaft};
use crate::scalar::{Angle, Scalar};

impl<S: Scalar> Model<S> {
    /// Takes one part of a step, `level` halvings of it, with the drive at `volts`.
    pub(super) fn part<B: Body<S>>(
        &self,
        body: &B,
        level: usize,
        state: &mut State<S>,
        volts: S,
        open: bool,
    ) {
        let needs = self.effects.needs;
        if !(needs.mean || needs.memory) {
            let forces = Forces {
                volts,
                ..self.constant
            };
            self.follow(body, level, &mut state.motion, &forces, open);
            return;
        }
        let timing = body.timing(level);
        let start = self.start(&state.motion, timing, open);
        let mut forces = self.forces(state, &start, volts, open);
        if needs.mean {
            let shaft = self.foresee(body, level, state, &start, &mut forces, open);
            forces = self.forces(state, &shaft, forces.volts, open);
        }
        let travel = self.follow(body, level, &mut state.motion, &forces, open);
        if needs.memory {
            let by = Increment {
                current: state.motion.current - start.current,
                speed: state.motion.speed - start.speed,
                angle: travel,
                ..Increment::default()
            };
            let shaft = self.mean(&start, &by, forces.volts, timing, open);
            self.effects.remember(&mut state.memory, &shaft);
        }
    }

    /// Moves under `forces`. Gives the angle travelled, in base speed × interval.
    #[inline(always)]
    fn follow<B: Body<S>>(
        &self,
        body: &B,
        level: usize,
        motion: &mut Motion<S>,
        forces: &Forces<S>,
        open: bool,
    ) -> S {
        if self.effects.needs.friction || B::COUPLED {
            return slide_and_stick(body, level, motion, forces, open, self.counts_per_unit);
        }
        let by = body.slide(level, motion, forces.volts, forces.torque, open);
        motion.current = motion.current + by.current;
        motion.speed = motion.speed + by.speed;
        motion.angle = motion.angle.advance(by.angle, self.counts_per_unit);
        by.angle
    }

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
    fn start(&self, motion: &Motion<S>, timing: &Timing<S>, open: bool) -> Shaft<S> {
        let turns = if self.effects.needs.angle {
            motion.angle.turns(self.counts_per_rev)
        } else {
            S::zero()
        };
        let current = if open { S::zero() } else { motion.current };
        let ahead = motion.speed.times(timing.length);
        Shaft {
            travel: ahead.times(self.turns_per_unit),
            length: timing.length,
            per_length: timing.per_length,
            ..Shaft::at(turns, motion.speed, current)
        }
    }

    /// The mean shaft of a part that began at `start` and brings `by` at `volts` on the winding.
    fn mean(
        &self,
        start: &Shaft<S>,
        by: &Increment<S>,
        volts: S,
        timing: &Timing<S>,
        open: bool,
    ) -> Shaft<S> {
        let half = S::from_f64(0.5);
        let travel = by.angle.times(self.turns_per_unit);
        let speed = by.angle.times(timing.per_length);
        let (current, current_change) = if open {
            (S::zero(), S::zero())
        } else {
            let mean = volts - speed.times(timing.kb) - by.current.times(timing.lag);
            (mean, by.current)
        };
        Shaft {
            turns: start.turns + travel * half,
            travel,
            speed,
            speed_change: by.speed,
            current,
            current_change,
            ..*start
        }
    }

    /// What acts on the shaft at `shaft` and is held for the part; `volts` reach the winding.
    #[inline(always)]
    fn forces(&self, state: &State<S>, shaft: &Shaft<S>, volts: S, open: bool) -> Forces<S> {
        let effects = &self.effects;
        let mut torque = effects.torque(shaft, &state.memory);
        let mut shaft = *shaft;
        if effects.needs.friction {
            shaft.transmitted = shaft.current + torque;
        }
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

    /// Foresees the part from what acts at its start, `forces`. Gives its mean shaft, and puts the
    /// volts that the winding's changes add into `forces`.
    fn foresee<B: Body<S>>(
        &self,
        body: &B,
        level: usize,
        state: &State<S>,
        start: &Shaft<S>,
        forces: &mut Forces<S>,
        open: bool,
    ) -> Shaft<S> {
        let timing = body.timing(level);
        let from = &state.motion;
        let budget = &forces.budget;
        let pull = start.current - forces.torque - body.load(from);
        let drag = direction(from.speed, pull, budget) * budget.moving;
        let torque = forces.torque + drag;
        let volts = forces.volts;
        let by = body.slide(level, from, volts, torque, open);
        let free = self.mean(start, &by, volts, timing, open);
        if open || !self.effects.needs.winding {
            return free;
        }
        let effects = &self.effects;
        let changed = effects.winding(volts, start, &state.memory);
        let extra = extra_volts(&changed, &effects.brush, volts, &free, timing);
        let by = body.slide(level, from, volts + extra, torque, open);
        let mut shaft = self.mean(start, &by, volts + extra, timing, open);

        let changed = effects.winding(volts, &shaft, &state.memory);
        let free = Shaft {
            current: shaft.current - timing.gain * extra,
            ..shaft
        };
        let extra = extra_volts(&changed, &effects.brush, volts, &free, timing);
        shaft.current = free.current + timing.gain * extra;
        forces.volts = volts + extra;
        shaft
    }
}
