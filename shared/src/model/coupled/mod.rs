//! A motor that drives a second inertia through a spring, perhaps behind a gap.
//!
//! ```text
//! m·dω/dt  = c − b·ω − τ − q        q = kx·(ε ∓ α) + d·ε'   while the flanks touch, never pulling
//! ml·dωl/dt = q                     q = 0                   within the gap
//! ```
//!
//! (Nordin, Gutman, *Controlling mechanical systems with backlash – a survey*, Automatica 38(10),
//! 2002.) While the flanks touch, and while they do not, the motion is linear, so both have exact
//! maps; contacts are located like stops of friction. The maps are made for `x = Ω·ε`, with `Ω` the
//! frequency of the two inertias against each other, and the slip `s = ω − ωl`: `x' = Ω·s` and
//! `s' = … − Ω·x − 2ζΩ·s`, numbers of one size. The state keeps a twist `σ·ε` with `σ ≤ Ω` such that
//! a wide gap does not leave the range of a fixed-point number. Dry friction on the load is in `load_friction`.

mod load_friction;
mod maps;

use super::dyadic::{DyadicMaps, LEVELS, shortest};
use super::friction::is_zero;
use super::mechanics::{Increment, Mechanics};
use super::state::Motion;
use super::step_map::weighted_sum;
use super::substep_map::SubstepTiming;
use crate::discretise::Discretisation;
use crate::effects::{Budget, Coupling};
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Mask, Real, Scalar, lanes};
use load_friction::{LoadFriction, turns_back};
use maps::{Split, Touching};

/// Angle of the load's swing against the motor that a substep with friction on the load may span, rad: an eighth of a turn. The torque of
/// friction is held over a substep.
const LONGEST_SWING: f64 = core::f64::consts::FRAC_PI_4;

/// The coupling's constants, per unit.
#[derive(Clone, Copy, Debug)]
struct Joint<S: Scalar> {
    /// `2ζ·σ/Ω`: twist that gives the same torque as a unit of slip.
    damping: S::Coefficient,
    /// Torque per twist.
    stiffness: S::Coefficient,
    /// Largest twist whose torque the number format holds: dry friction sees no more.
    most: S,
    /// Twist by angle.
    twist_per_angle: S::Coefficient,
    /// Half of the gap, as a twist.
    half_gap: S,
    /// Whether there is a gap.
    loose: bool,
}

lanes!(Joint {
    damping,
    stiffness,
    most,
    twist_per_angle,
    half_gap,
    loose
});

/// A motor with its load: maps for each level.
#[derive(Clone, Copy, Debug)]
pub struct Coupled<S: Scalar> {
    joint: Joint<S>,
    touching: [Touching<S>; LEVELS],
    /// Where the load has any.
    friction: Option<LoadFriction<S>>,
}

lanes!(Coupled {
    joint,
    touching,
    friction
});

impl<S: Scalar> Coupled<S> {
    /// The maps of a step of `step` intervals and of all its halvings, and the machine of the motor
    /// alone.
    ///
    /// # Errors
    /// A load share that is not between 0 and 1, or a multiplier beyond the range of `S`.
    pub fn new<R: Real>(
        machine: &Machine<R>,
        coupling: &Coupling<R>,
        step: R,
        how: Discretisation,
    ) -> Result<(Self, Machine<R>), ModelError> {
        let split = Split::new(machine, coupling)?;
        let depth = LEVELS - 1;
        let (motor, lengths) = shortest(&split.motor, step, depth, how);
        let mut maps = split.maps(&motor, lengths[depth], how)?;
        let mut touching = [maps.lower::<S>(&split, &motor, lengths[depth])?; LEVELS];
        let mut brakes = match coupling.friction_share > R::zero() {
            true => Some([maps.brakes::<S>(&split, &motor, lengths[depth])?; LEVELS]),
            false => None,
        };
        for level in (0..depth).rev() {
            maps = match how {
                Discretisation::Exact => maps.twice(),
                Discretisation::Euler => split.maps(&motor, lengths[level], how)?,
            };
            touching[level] = maps.lower::<S>(&split, &motor, lengths[level])?;
            if let Some(brakes) = &mut brakes {
                brakes[level] = maps.brakes::<S>(&split, &motor, lengths[level])?;
            }
        }
        let short = |&level: &usize| {
            let turn = split.frequency * lengths[level];
            turn < R::from_f64(LONGEST_SWING)
        };
        let friction = brakes.map(|brakes| LoadFriction {
            share: S::coefficient(coupling.friction_share.to_f64()),
            longest: (0..depth).find(short).unwrap_or(depth),
            brakes,
        });
        let stiffness = split.share * split.motor.inertia * split.frequency / split.scale;
        let damping = split.twice_damping * split.scale;
        let twist_per_angle = split.frequency * split.scale;
        let half_gap = coupling.half_gap * twist_per_angle;
        let joint = Joint {
            damping: S::coefficient(damping.to_f64()),
            stiffness: S::coefficient(stiffness.to_f64()),
            most: S::from_f64(S::LIMIT / 4.0 / stiffness.to_f64()),
            twist_per_angle: S::coefficient(twist_per_angle.to_f64()),
            half_gap: S::from_f64(half_gap.to_f64()),
            loose: coupling.half_gap > R::zero(),
        };
        let coupled = Coupled {
            joint,
            touching,
            friction,
        };
        Ok((coupled, split.motor))
    }
}

impl<S: Scalar> Joint<S> {
    /// Twist beyond the flank on `side`.
    #[inline(always)]
    fn bend(&self, twist: S, side: S) -> S {
        twist - side * self.half_gap
    }

    /// Torque that the motor passes on, as the twist of an undamped spring.
    fn push(&self, bend: S, slip: S) -> S {
        bend + slip.times(self.damping)
    }
}

/// A [`Coupled`] motor and, for the time of free flight, the maps of the motor alone.
pub struct MotorAndLoad<'a, S: Scalar> {
    /// The motor alone.
    pub motor: &'a DyadicMaps<S>,
    /// Both.
    pub coupled: &'a Coupled<S>,
}

impl<S: Scalar> MotorAndLoad<'_, S> {
    #[inline(always)]
    fn touching(
        &self,
        level: usize,
        from: &Motion<S>,
        bend: S,
        volts: S,
        torque: S,
        open: bool,
    ) -> Increment<S> {
        let maps = &self.coupled.touching[level];
        let (speed, slip) = (from.speed, from.slip);
        if open {
            let by = [speed, bend, slip, torque];
            let [speed, twist, slip, angle] = &maps.coast;
            return Increment {
                current: -from.current,
                speed: weighted_sum(&by, speed),
                angle: weighted_sum(&by, angle),
                twist: weighted_sum(&by, twist),
                slip: weighted_sum(&by, slip),
            };
        }
        let by = [from.current, speed, bend, slip, volts, torque];
        let [current, speed, twist, slip, angle] = &maps.driven;
        Increment {
            current: weighted_sum(&by, current),
            speed: weighted_sum(&by, speed),
            angle: weighted_sum(&by, angle),
            twist: weighted_sum(&by, twist),
            slip: weighted_sum(&by, slip),
        }
    }
}

#[inline(always)]
fn select<S: Scalar>(mask: S::Mask, a: Increment<S>, b: Increment<S>) -> Increment<S> {
    Increment {
        current: S::select(mask, a.current, b.current),
        speed: S::select(mask, a.speed, b.speed),
        angle: S::select(mask, a.angle, b.angle),
        twist: S::select(mask, a.twist, b.twist),
        slip: S::select(mask, a.slip, b.slip),
    }
}

impl<S: Scalar> Mechanics<S> for MotorAndLoad<'_, S> {
    const COUPLED: bool = true;

    #[inline(always)]
    fn timing(&self, level: usize) -> &SubstepTiming<S> {
        &self.coupled.touching[level].timing
    }

    #[inline(always)]
    fn step_free(
        &self,
        level: usize,
        from: &Motion<S>,
        side: S,
        volts: S,
        torque: S,
        open: bool,
    ) -> Increment<S> {
        let joint = &self.coupled.joint;
        let bend = joint.bend(from.twist, side);
        let touching = self.touching(level, from, bend, volts, torque, open);
        if !joint.loose {
            return touching;
        }
        let mut free = self.motor.level(level).step_free(from, volts, torque, open);
        free.slip = free.speed;
        // The load flies on at its own speed.
        let ahead = (from.slip - from.speed).times(self.coupled.touching[level].flight);
        free.twist = free.angle.times(joint.twist_per_angle) + ahead;
        select(is_zero(side), free, touching)
    }

    #[inline(always)]
    fn step_stuck(
        &self,
        level: usize,
        from: &Motion<S>,
        side: S,
        volts: S,
        open: bool,
    ) -> Increment<S> {
        let joint = &self.coupled.joint;
        let maps = &self.coupled.touching[level];
        let bend = joint.bend(from.twist, side);
        let by = [bend, from.slip];
        let still = self.motor.step_stuck(level, from, side, volts, open);
        let touching = Increment {
            twist: weighted_sum(&by, &maps.held[0]),
            slip: weighted_sum(&by, &maps.held[1]),
            ..still
        };
        if !joint.loose {
            return touching;
        }
        let free = Increment {
            twist: from.slip.times(maps.flight),
            ..still
        };
        select(is_zero(side), free, touching)
    }

    #[inline(always)]
    fn speed_per_torque(&self, level: usize) -> S::Coefficient {
        self.coupled.touching[level].driven[1][5]
    }

    #[inline(always)]
    fn longest(&self) -> usize {
        (self.coupled.friction.as_ref()).map_or(0, |friction| friction.longest)
    }

    #[inline(always)]
    fn shared(&self, budget: &Budget<S>) -> (Budget<S>, S) {
        match &self.coupled.friction {
            Some(friction) => friction.shared(budget),
            None => (*budget, S::zero()),
        }
    }

    #[inline(always)]
    fn brake(
        &self,
        level: usize,
        from: &Motion<S>,
        end: &Motion<S>,
        side: S,
        held: S::Mask,
        budget: S,
        open: bool,
    ) -> Option<(Increment<S>, S::Mask)> {
        let friction = self.coupled.friction.as_ref()?;
        let brakes = &friction.brakes[level];
        let (before, speed) = (from.speed - from.slip, end.speed - end.slip);
        let moving = if open {
            &brakes.coasting
        } else {
            &brakes.driven
        };
        let (by_moving, stops_moving) = moving.brake(speed, budget);
        let (by_held, stops_held) = brakes.held.brake(speed, budget);
        let mut by = select(held, by_held, by_moving);
        let mut stops = held.and(stops_held).or(held.not().and(stops_moving));
        if self.coupled.joint.loose {
            let flies = is_zero(side);
            let (by_free, stops_free) = brakes.free.brake(speed, budget);
            by = select(flies, by_free, by);
            stops = flies.and(stops_free).or(flies.not().and(stops));
        }
        let least = friction.least_speed(budget);
        Some((by, turns_back(before, speed, stops, least)))
    }

    #[inline(always)]
    fn load(&self, from: &Motion<S>, side: S) -> S {
        let joint = &self.coupled.joint;
        let push = joint.push(joint.bend(from.twist, side), from.slip);
        let torque = push.min(joint.most).max(-joint.most).times(joint.stiffness);
        if !joint.loose {
            return torque;
        }
        S::select(is_zero(side), S::zero(), torque)
    }

    #[inline(always)]
    fn beyond(&self, from: &Motion<S>, side: S) -> S {
        self.coupled.joint.bend(from.twist, side) * side
    }

    /// The flanks touch where the twist is beyond the gap and they push; without a gap, always.
    #[inline(always)]
    fn side(&self, from: &Motion<S>) -> S {
        let joint = &self.coupled.joint;
        if !joint.loose {
            return S::zero();
        }
        let side = from.twist.signum();
        let bend = joint.bend(from.twist, side);
        let beyond = S::zero().less(bend * side);
        let pushes = S::zero().less(joint.push(bend, from.slip) * side);
        S::select(beyond.and(pushes), side, S::zero())
    }
}
