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

/// A part is halved if what is doubtful in it might leave the angle wrong by more than this, counts.
///
/// A torque `τ` that acts for a time `h` gives the speed `τ·h/m`, which back-EMF and friction take
/// away again with the time constant `m/(kb + b)`; meanwhile the shaft turns by `τ·h/(kb + b)`. Per
/// unit, `kb` is about one.
const TOLERATED_COUNTS: f64 = 0.1;

/// What acts in a part.
pub(super) struct Foreseen<S: Scalar> {
    /// What is held for the part.
    pub(super) forces: Forces<S>,
    /// Whether the part is too long for that.
    pub(super) doubtful: S::Mask,
}

impl<S: Scalar> Model<S> {
    /// Doubtful torque times its length, per unit, that needs no shorter parts.
    #[inline(always)]
    pub(super) fn tolerated(counts_per_unit: f64) -> S {
        S::from_f64(TOLERATED_COUNTS / counts_per_unit)
    }

    /// What acts where nothing depends on the state.
    #[inline(always)]
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
    #[inline]
    pub(super) fn forces(
        &self,
        state: &State<S>,
        shaft: &Shaft<S>,
        volts: S,
        further: S,
        open: bool,
    ) -> Forces<S> {
        S::routine(
            #[inline(always)]
            || {
                let effects = &self.effects;
                let needs = effects.needs;
                let mut torque = further;
                if needs.torque {
                    torque = torque + effects.torque(shaft, &state.memory);
                }
                let lost = if needs.lost_torque && !open {
                    effects.lost_torque(shaft, &state.memory)
                } else {
                    S::zero()
                };
                let budget = if needs.friction {
                    effects.friction(&Shaft {
                        transmitted: shaft.current + torque - lost,
                        ..*shaft
                    })
                } else {
                    Budget::default()
                };
                Forces {
                    volts,
                    torque: torque + lost + budget.bias,
                    budget,
                }
            },
        )
    }

    /// Volts that the changes of the winding `at` a shaft add to those of the drive, with which alone
    /// the shaft would be `free`.
    #[inline]
    pub(super) fn extra_volts(
        &self,
        state: &State<S>,
        volts: S,
        at: &Shaft<S>,
        free: &Shaft<S>,
        timing: &Timing<S>,
    ) -> S {
        S::routine(
            #[inline(always)]
            || {
                let changed = self.effects.winding(volts, at, &state.memory);
                extra_volts(&changed, &self.effects.brush, volts, free, timing)
            },
        )
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
        let zero = S::zero();
        let effects = &self.effects;
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
        let winding = effects.needs.winding && !open;

        // First thought, from the start of the part.
        let first = part.forces(&part.ahead(), zero);
        let torque = first.torque + part.drag(&first);
        let mut shaft = part.slide(zero, torque);
        let mut extra = zero;
        if winding {
            extra = part.extra_volts(start, &shaft);
            shaft = part.slide(extra, torque);
        }
        let mut stiff = zero;
        if effects.needs.stiff {
            stiff = effects.stiff(&shaft, &state.memory).from(zero);
            shaft = part.slide(extra, torque + stiff);
        }

        // Second thought, from the mean shaft of the first.
        let mut doubt = zero;
        let mut bent = zero.less(zero);
        if winding {
            let gain = body.timing(level).gain;
            let current = shaft.current - gain * extra;
            let again = part.extra_volts(&shaft, &Shaft { current, ..shaft });
            shaft.current = current + gain * again;
            bent = bends(&effects.brush, start, &shaft);
            doubt = doubt + (again - extra).abs();
            extra = again;
        }
        if effects.needs.stiff {
            let given = effects.stiff(&shaft, &state.memory);
            let again = given.from(stiff);
            doubt = doubt + (again - stiff).abs() + given.doubt;
            stiff = again;
        }
        let mut forces = part.forces(&shaft, stiff);
        doubt = doubt + (forces.torque - stiff - first.torque).abs();
        doubt = doubt + (forces.budget.moving - first.budget.moving).abs();
        forces.volts = volts + extra;
        let impulse = doubt.times(body.timing(level).length);
        Foreseen {
            forces,
            doubtful: bent.or(self.tolerated.less(impulse)),
        }
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

impl<S: Scalar, B: Body<S>> Part<'_, S, B> {
    /// The shaft as the speed at the start alone foresees it.
    #[inline(always)]
    fn ahead(&self) -> Shaft<S> {
        let half = S::from_f64(0.5);
        Shaft {
            turns: self.start.turns + self.start.travel * half,
            ..*self.start
        }
    }

    /// Torque of the friction in `forces` as the part begins.
    #[inline(always)]
    fn drag(&self, forces: &Forces<S>) -> S {
        if !self.model.effects.needs.friction {
            return S::zero();
        }
        let load = self.body.load(&self.state.motion, self.side);
        let pull = self.start.current - forces.torque - load;
        direction(self.start.speed, pull, &forces.budget) * forces.budget.moving
    }

    /// What acts at `shaft`, with a torque `further` that is known already.
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
        let timing = self.body.timing(self.level);
        self.model
            .extra_volts(self.state, self.volts, at, free, timing)
    }
}
