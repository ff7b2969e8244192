//! Dry friction of the load, taken implicitly.
//!
//! Over a substep the friction is a held torque. It is as large as stops the load at the end of the substep, but no larger than its budget
//! (the time stepping of J. J. Moreau, *Unilateral contact and dry friction in finite freedom dynamics*, 1988): so the load slides,
//! stops, is held and breaks loose by one formula. Its response to the torque is linear, and scales with the speed that the torque takes of the load.

use crate::effects::Budget;
use crate::model::dyadic::LEVELS;
use crate::model::mechanics::Increment;
use crate::scalar::{Mask, Scalar, lanes};

/// Response of a substep to dry friction on the load.
#[derive(Clone, Copy, Debug)]
pub struct Brake<S: Scalar> {
    /// Speed that a torque takes of the load.
    pub per_torque: S::Coefficient,
    /// Increments of current, speed, twist, slip and angle, per speed that is taken of the load.
    pub response: [S::Coefficient; 5],
}

lanes!(Brake {
    per_torque,
    response
});

impl<S: Scalar> Brake<S> {
    /// What friction of at most `budget` adds to a substep after which the load would have `speed`, and whether it stops the load.
    #[inline(always)]
    pub fn brake(&self, speed: S, budget: S) -> (Increment<S>, S::Mask) {
        let most = budget.times(self.per_torque);
        let taken = speed.min(most).max(-most);
        let [current, speed_response, twist, slip, angle] = self.response;
        let by = Increment {
            current: taken.times(current),
            speed: taken.times(speed_response),
            angle: taken.times(angle),
            twist: taken.times(twist),
            slip: taken.times(slip),
        };
        (by, speed.abs().less(most))
    }
}

/// The responses of a substep.
#[derive(Clone, Copy, Debug)]
pub struct Brakes<S: Scalar> {
    /// While the flanks touch and the bridge is closed.
    pub driven: Brake<S>,
    /// While they touch and the bridge is open.
    pub coasting: Brake<S>,
    /// While friction holds the motor.
    pub held: Brake<S>,
    /// While the load is free.
    pub free: Brake<S>,
}

lanes!(Brakes {
    driven,
    coasting,
    held,
    free
});

/// Dry friction on the load of a coupling.
#[derive(Clone, Copy, Debug)]
pub struct LoadFriction<S: Scalar> {
    /// Share of the dry friction that acts on the load.
    pub share: S::Coefficient,
    /// Longest substep in which the load does not swing back, as a level.
    pub longest: usize,
    /// The responses of each level.
    pub brakes: [Brakes<S>; LEVELS],
}

lanes!(LoadFriction {
    share,
    longest,
    brakes
});

impl<S: Scalar> LoadFriction<S> {
    /// The friction that is left to the motor, and the budget of the load's.
    #[inline(always)]
    pub fn shared(&self, budget: &Budget<S>) -> (Budget<S>, S) {
        let behind = budget.moving.times(self.share);
        let own = Budget {
            moving: budget.moving - behind,
            holding: budget.holding - budget.holding.times(self.share),
            bias: budget.bias,
        };
        (own, behind)
    }

    /// Speed that friction of `budget` takes of the free load within the shortest substep: below it the load is at rest.
    #[inline(always)]
    pub fn least_speed(&self, budget: S) -> S {
        budget.times(self.brakes[LEVELS - 1].free.per_torque)
    }
}

/// Whether a load that turned at `before` stops or reverses in a substep after which it would have `speed` without friction; `stopped` as
/// [`Brake::brake`] says. Below the speed `least` it was at rest.
#[inline(always)]
pub fn turns_back<S: Scalar>(before: S, speed: S, stopped: S::Mask, least: S) -> S::Mask {
    let reverses = (before * speed).less(S::zero());
    least.less(before.abs()).and(stopped.or(reverses))
}
