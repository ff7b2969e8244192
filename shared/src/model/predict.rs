//! Predicts the mean forces of a substep (predictor and corrector).
//!
//! The maps are exact for held voltage and torque. What the effects add depends on speed, angle and
//! current, so the model evaluates it twice: near the start, to predict the mean shaft of the substep;
//! then at that mean. Forces held at their mean leave an error of third order in the length of the
//! substep. Where the two evaluations differ much, the substep needs halving.

use super::Model;
use super::friction::{Forces, direction};
use super::mechanics::{Increment, Mechanics};
use super::state::State;
use super::substep_map::SubstepTiming;
use super::winding::{bends, extra_volts};
use crate::effects::{Budget, Lowered, Shaft};
use crate::scalar::{Angle, Mask, Scalar};

/// A substep is halved if the change of its forces between the two evaluations might leave the angle wrong by more
/// than this, counts.
///
/// A torque `τ` that acts for a time `h` gives the speed `τ·h/m`, which back-EMF and friction take
/// away again with the time constant `m/(kb + b)`; meanwhile the shaft turns by `τ·h/(kb + b)`. Per
/// unit, `kb` is about one.
const TOLERATED_COUNTS: f64 = 0.1;

/// Predicted mean forces of a substep.
pub(super) struct Prediction<S: Scalar> {
    /// Held over the substep.
    pub(super) forces: Forces<S>,
    /// Whether the substep is too long for that.
    pub(super) needs_halving: S::Mask,
}

impl<S: Scalar> Model<S> {
    /// Largest change of the torque between the evaluations, times the length, that needs no halving; per unit.
    #[inline(always)]
    pub(super) fn tolerated(counts_per_unit: f64) -> S {
        S::from_f64(TOLERATED_COUNTS / counts_per_unit)
    }

    /// The forces, where nothing of them depends on the state.
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

    /// The shaft at the start of a substep, with the drive at `volts`.
    #[inline(always)]
    pub(super) fn start(
        &self,
        state: &State<S>,
        volts: S,
        timing: &SubstepTiming<S>,
        open: bool,
    ) -> Shaft<S> {
        let motion = &state.motion;
        let turns = if self.effects.needs.angle {
            motion.angle.turns(self.counts_per_rev)
        } else {
            S::zero()
        };
        let current = if open { S::zero() } else { motion.current };
        let ahead = motion.speed.times(timing.length);
        Shaft {
            travel: ahead.times(self.turns_per_unit),
            volts,
            temperature: state.temperature,
            compliance: timing.compliance.times(self.turns_per_unit),
            inertia: timing.inertia,
            length: timing.length,
            per_length: timing.per_length,
            ..Shaft::at(turns, motion.speed, current)
        }
    }

    /// The mean shaft of a substep that begins at `start` and adds `by` to the state, at `volts` on the winding.
    #[inline(always)]
    pub(super) fn mean(
        &self,
        start: &Shaft<S>,
        by: &Increment<S>,
        volts: S,
        timing: &SubstepTiming<S>,
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

    /// The forces at `shaft`, to be held over the substep, with the drive at `volts` and a torque
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

    /// Volts that the changed winding `at` a shaft adds to those of the drive, with which alone the
    /// shaft would be `free`; and what may be wrong with them.
    #[inline]
    pub(super) fn extra_volts(
        &self,
        state: &State<S>,
        volts: S,
        at: &Shaft<S>,
        free: &Shaft<S>,
        timing: &SubstepTiming<S>,
    ) -> (S, S) {
        S::routine(
            #[inline(always)]
            || {
                let changed = self.effects.winding(at, &state.memory);
                let extra = extra_volts(&changed, &self.effects.brush, volts, free, timing);
                (extra, changed.doubt)
            },
        )
    }

    /// Predicts the forces of a substep that begins at `start` with the drive at `volts`.
    #[inline(always)]
    pub(super) fn predict<M: Mechanics<S>>(
        &self,
        mechanics: &M,
        level: usize,
        state: &State<S>,
        start: &Shaft<S>,
        volts: S,
        open: bool,
    ) -> Prediction<S> {
        let zero = S::zero();
        let effects = &self.effects;
        let substep = Substep {
            model: self,
            mechanics,
            level,
            state,
            start,
            side: mechanics.side(&state.motion),
            volts,
            open,
        };
        let winding = effects.needs.winding && !open;

        // Predictor: forces at the start of the substep.
        let first = substep.forces(&substep.ahead(), zero);
        let torque = first.torque + substep.drag(&first);
        let mut shaft = substep.step_free(zero, torque);
        let mut extra = zero;
        if winding {
            (extra, _) = substep.extra_volts(start, &shaft);
            shaft = substep.step_free(extra, torque);
        }
        let mut stiff = zero;
        if effects.needs.stiff {
            stiff = effects.stiff(&shaft, &state.memory).from(zero);
            shaft = substep.step_free(extra, torque + stiff);
        }

        // Corrector: forces at the predicted mean shaft.
        let mut change = zero;
        let mut bent = zero.less(zero);
        if winding {
            let gain = mechanics.timing(level).gain;
            let current = shaft.current - gain * extra;
            let (again, doubt) = substep.extra_volts(&shaft, &Shaft { current, ..shaft });
            shaft.current = current + gain * again;
            bent = bends(&effects.brush, volts, start, &shaft);
            change = change + (again - extra).abs() + doubt;
            extra = again;
        }
        if effects.needs.stiff {
            let given = effects.stiff(&shaft, &state.memory);
            let again = given.from(stiff);
            change = change + (again - stiff).abs() + given.doubt;
            stiff = again;
        }
        let mut forces = substep.forces(&shaft, stiff);
        change = change + (forces.torque - stiff - first.torque).abs();
        change = change + (forces.budget.moving - first.budget.moving).abs();
        forces.volts = volts + extra;
        let impulse = change.times(mechanics.timing(level).length);
        Prediction {
            forces,
            needs_halving: bent.or(self.tolerated.less(impulse)),
        }
    }
}

/// A substep that begins at `start` with the drive at `volts`.
struct Substep<'a, S: Scalar, M> {
    model: &'a Model<S>,
    mechanics: &'a M,
    level: usize,
    state: &'a State<S>,
    start: &'a Shaft<S>,
    side: S,
    volts: S,
    open: bool,
}

impl<S: Scalar, M: Mechanics<S>> Substep<'_, S, M> {
    /// The shaft at the middle, as the speed at the start alone predicts it.
    #[inline(always)]
    fn ahead(&self) -> Shaft<S> {
        let half = S::from_f64(0.5);
        Shaft {
            turns: self.start.turns + self.start.travel * half,
            ..*self.start
        }
    }

    /// Torque of the friction in `forces` at the start.
    #[inline(always)]
    fn drag(&self, forces: &Forces<S>) -> S {
        if !self.model.effects.needs.friction {
            return S::zero();
        }
        let load = self.mechanics.load(&self.state.motion, self.side);
        let pull = self.start.current - forces.torque - load;
        let (budget, _) = self.mechanics.shared(&forces.budget);
        direction(self.start.speed, pull, &budget) * budget.moving
    }

    /// The forces at `shaft`, with a torque `further` that is known already.
    #[inline(always)]
    fn forces(&self, shaft: &Shaft<S>, further: S) -> Forces<S> {
        let Substep {
            state, volts, open, ..
        } = *self;
        self.model.forces(state, shaft, volts, further, open)
    }

    /// The mean shaft under a held torque, with `extra` volts on top of those of the drive.
    #[inline(always)]
    fn step_free(&self, extra: S, torque: S) -> Shaft<S> {
        let volts = self.volts + extra;
        let (motion, timing) = (&self.state.motion, self.mechanics.timing(self.level));
        let by = self
            .mechanics
            .step_free(self.level, motion, self.side, volts, torque, self.open);
        self.model.mean(self.start, &by, volts, timing, self.open)
    }

    /// [`Model::extra_volts`] of this substep.
    #[inline(always)]
    fn extra_volts(&self, at: &Shaft<S>, free: &Shaft<S>) -> (S, S) {
        let timing = self.mechanics.timing(self.level);
        self.model
            .extra_volts(self.state, self.volts, at, free, timing)
    }
}
