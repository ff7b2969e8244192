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
use crate::effects::{Budget, Lowered, Shaft};
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
    #[inline(always)]
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
        let needs = effects.needs;
        let mut torque = further;
        if needs.torque {
            torque = torque + effects.torque(shaft, &state.memory);
        }
        let mut budget = Budget::default();
        let lost = if needs.lost_torque && !open {
            effects.lost_torque(shaft, &state.memory)
        } else {
            S::zero()
        };
        if needs.friction {
            let transmitted = shaft.current + torque - lost;
            budget = effects.friction(&Shaft {
                transmitted,
                ..*shaft
            });
        }
        Forces {
            volts,
            torque: torque + lost + budget.bias,
            budget,
        }
    }

    /// What acts in a part that begins at `start` with the drive at `volts`.
    #[inline(always)]
    pub(super) fn foresee<B: Body<S>>(
        &self,
        body: &B,
        level: usize,
        state: &State<S>,
        start: &Shaft<S>,
        volts: S,
        open: bool,
    ) -> Foreseen<S> {
        let part = Part {
            model: self,
            body,
            level,
            state,
            start,
            side: body.side(&state.motion),
            volts,
            open,
        };
        let first = part.first_thought();
        part.second_thought(first)
    }
}

/// A part that begins at `start` with the drive at `volts`.
struct Part<'a, S: Scalar, B> {
    model: &'a Model<S>,
    body: &'a B,
    level: usize,
    state: &'a State<S>,
    start: &'a Shaft<S>,
    side: S,
    volts: S,
    open: bool,
}

/// What seems to act in a part.
struct Thought<S: Scalar> {
    /// On the shaft, but for the stiff torque.
    forces: Forces<S>,
    /// Torque that rises steeply with the travel.
    stiff: S,
    /// Volts that the changes of the winding add.
    extra: S,
    /// The mean shaft under all that.
    shaft: Shaft<S>,
}

impl<S: Scalar, B: Body<S>> Part<'_, S, B> {
    /// From the shaft at the start; the speed alone foresees the angle.
    #[inline(always)]
    fn first_thought(&self) -> Thought<S> {
        let zero = S::zero();
        let start = self.start;
        let effects = &self.model.effects;
        let ahead = Shaft {
            turns: start.turns + start.travel * S::from_f64(0.5),
            ..*start
        };
        let forces = self.forces(&ahead, zero);
        let mut torque = forces.torque;
        if effects.needs.friction {
            let load = self.body.load(&self.state.motion, self.side);
            let pull = start.current - torque - load;
            let sense = direction(start.speed, pull, &forces.budget);
            torque = torque + sense * forces.budget.moving;
        }
        let mut shaft = self.slide(zero, torque);
        let mut extra = zero;
        if self.winding_changes() {
            extra = self.extra_volts(start, &shaft);
            shaft = self.slide(extra, torque);
        }
        let mut stiff = zero;
        if effects.needs.stiff {
            stiff = effects.stiff(&shaft, &self.state.memory).from(zero);
            shaft = self.slide(extra, torque + stiff);
        }
        Thought {
            forces,
            stiff,
            extra,
            shaft,
        }
    }

    /// From the mean shaft of the first.
    #[inline(always)]
    fn second_thought(&self, first: Thought<S>) -> Foreseen<S> {
        let effects = &self.model.effects;
        let Thought {
            stiff,
            extra,
            mut shaft,
            ..
        } = first;
        let mut doubt = S::zero();
        let mut bent = S::zero().less(S::zero());
        let mut volts = self.volts;
        if self.winding_changes() {
            let gain = self.body.timing(self.level).gain;
            let current = shaft.current - gain * extra;
            let again = self.extra_volts(&shaft, &Shaft { current, ..shaft });
            shaft.current = current + gain * again;
            doubt = doubt + (again - extra).abs();
            bent = bends(&effects.brush, self.start, &shaft);
            volts = volts + again;
        }
        let mut again = S::zero();
        if effects.needs.stiff {
            let given = effects.stiff(&shaft, &self.state.memory);
            again = given.from(stiff);
            doubt = doubt + (again - stiff).abs() + given.doubt;
        }
        let forces = self.forces(&shaft, again);
        doubt = doubt + (forces.torque - again - first.forces.torque).abs();
        doubt = doubt + (forces.budget.moving - first.forces.budget.moving).abs();
        Foreseen {
            forces: Forces { volts, ..forces },
            doubtful: bent.or(S::from_f64(DOUBT).less(doubt)),
        }
    }

    #[inline(always)]
    fn winding_changes(&self) -> bool {
        self.model.effects.needs.winding && !self.open
    }

    #[inline(always)]
    fn forces(&self, shaft: &Shaft<S>, further: S) -> Forces<S> {
        let Part {
            state, volts, open, ..
        } = *self;
        self.model.forces(state, shaft, volts, further, open)
    }

    /// The mean shaft under a held torque, with `extra` volts on top of those of the drive.
    #[inline(always)]
    fn slide(&self, extra: S, torque: S) -> Shaft<S> {
        let volts = self.volts + extra;
        let (motion, timing) = (&self.state.motion, self.body.timing(self.level));
        let by = self
            .body
            .slide(self.level, motion, self.side, volts, torque, self.open);
        self.model.mean(self.start, &by, volts, timing, self.open)
    }

    /// Volts that the changes of the winding `at` a shaft add to those of the drive, with which alone
    /// the shaft would be `free`.
    #[inline(always)]
    fn extra_volts(&self, at: &Shaft<S>, free: &Shaft<S>) -> S {
        let effects = &self.model.effects;
        let changed = effects.winding(self.volts, at, &self.state.memory);
        let timing = self.body.timing(self.level);
        extra_volts(&changed, &effects.brush, self.volts, free, timing)
    }
}
