//! The moving masses, as a substep uses them: one rigid body, or a motor and its load.

use super::state::Motion;
use super::substep_map::SubstepTiming;
use crate::effects::Budget;
use crate::scalar::Scalar;

/// What a substep adds to the state.
#[derive(Clone, Copy, Debug, Default)]
pub struct Increment<S> {
    /// To the current.
    pub current: S,
    /// To the speed.
    pub speed: S,
    /// To the angle, in base speed × interval.
    pub angle: S,
    /// To the twist.
    pub twist: S,
    /// To the slip.
    pub slip: S,
}

/// The moving masses, with maps for each length of substep. A substep of `level` is a step halved so many times.
pub trait Mechanics<S: Scalar> {
    /// Whether there is a load behind a spring or a gap.
    const COUPLED: bool;

    /// Length of a substep, and constants of its mean current.
    fn timing(&self, level: usize) -> &SubstepTiming<S>;

    /// Increments of a substep in which the shaft turns under a held voltage and a held torque
    /// (against positive rotation), with the load against the flank on `side`.
    fn step_free(
        &self,
        level: usize,
        from: &Motion<S>,
        side: S,
        volts: S,
        torque: S,
        open: bool,
    ) -> Increment<S>;

    /// Increments of a substep in which friction holds the shaft: the current settles, the load swings.
    fn step_stuck(
        &self,
        level: usize,
        from: &Motion<S>,
        side: S,
        volts: S,
        open: bool,
    ) -> Increment<S>;

    /// Speed that a held torque against positive rotation adds within a substep, per torque.
    fn speed_per_torque(&self, level: usize) -> S::Coefficient;

    /// Level of the longest substep that may be taken as one.
    #[inline(always)]
    fn longest(&self) -> usize {
        0
    }

    /// Dry friction of the motor, and the budget of that of its load.
    #[inline(always)]
    fn shared(&self, budget: &Budget<S>) -> (Budget<S>, S) {
        (*budget, S::zero())
    }

    /// What dry friction of at most `budget` on the load adds to a substep that ends at `end` without it, and whether the load stops or
    /// reverses; `held` where friction holds the motor. `None` where there is no such friction.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "a substep, and how it ended")]
    fn brake(
        &self,
        _level: usize,
        _from: &Motion<S>,
        _end: &Motion<S>,
        _side: S,
        _held: S::Mask,
        _budget: S,
        _open: bool,
    ) -> Option<(Increment<S>, S::Mask)> {
        None
    }

    /// Torque of the load on the motor shaft, against positive rotation.
    #[inline(always)]
    fn load(&self, _from: &Motion<S>, _side: S) -> S {
        S::zero()
    }

    /// Twist beyond the flank on `side`, positive in its direction.
    #[inline(always)]
    fn beyond(&self, _from: &Motion<S>, _side: S) -> S {
        S::zero()
    }

    /// Side of the gap that touches: −1, 1, or 0 while the load is free.
    #[inline(always)]
    fn side(&self, _from: &Motion<S>) -> S {
        S::zero()
    }
}
