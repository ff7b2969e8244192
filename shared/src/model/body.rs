//! What a part of a step asks of the moving masses, be they one rigid body or a motor and its load.

use super::rung::Timing;
use super::state::Motion;
use crate::scalar::Scalar;

/// What a part of a step adds to the state.
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

/// The moving masses, with a map for each length of part. `level` halvings make a part.
pub trait Body<S: Scalar> {
    /// Whether there is a load behind a spring or a gap.
    const COUPLED: bool;

    /// Length of a part, and its mean current.
    fn timing(&self, level: usize) -> &Timing<S>;

    /// A part in which the shaft turns freely under a held voltage and a held torque (against
    /// positive rotation), the load against the flank on `side`.
    fn slide(
        &self,
        level: usize,
        from: &Motion<S>,
        side: S,
        volts: S,
        torque: S,
        open: bool,
    ) -> Increment<S>;

    /// A part in which friction holds the shaft: the current settles, the load swings.
    fn settle(&self, level: usize, from: &Motion<S>, side: S, volts: S, open: bool)
    -> Increment<S>;

    /// Speed that a torque against positive rotation adds within a part.
    fn yields(&self, level: usize, torque: S) -> S;

    /// Torque of the load on the motor shaft, against positive rotation.
    #[inline(always)]
    fn load(&self, _from: &Motion<S>, _side: S) -> S {
        S::zero()
    }

    /// Twist beyond the flank on `side`, in its direction.
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
