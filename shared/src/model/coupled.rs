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
//! a wide gap does not leave the range of a fixed-point number.

use super::body::{Body, Increment};
use super::friction::is_zero;
use super::rung::{RUNGS, Timed, Timing, shortest, weighed};
use super::state::Motion;
use crate::discretise::{Discretisation, LinearMap, LinearSystem, scaled};
use crate::effects::Coupling;
use crate::error::ModelError;
use crate::motor::Machine;
use crate::scalar::{Mask, Real, Scalar, lanes};

/// Maps of one part of a step while the flanks touch.
#[derive(Clone, Copy, Debug)]
struct Touching<S: Scalar> {
    timing: Timing<S>,
    /// Current, speed, twist, slip and angle by `[c, ω, x, s, v, τ]` with the bridge closed.
    driven: [[S::Coefficient; 6]; 5],
    /// Speed, twist, slip and angle by `[ω, x, s, τ]` with the bridge open.
    coast: [[S::Coefficient; 4]; 4],
    /// Twist and slip by `[x, s]` while friction holds the motor.
    held: [[S::Coefficient; 2]; 2],
    /// Twist by slip while the load is free.
    flight: S::Coefficient,
}

lanes!(Touching {
    timing,
    driven,
    coast,
    held,
    flight
});

/// The coupling's constants, per unit.
#[derive(Clone, Copy, Debug)]
struct Joint<S: Scalar> {
    /// `2ζ·σ/Ω`: what the slip adds to the twist in the torque.
    damping: S::Coefficient,
    /// Torque by both.
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

/// Motor and load.
#[derive(Clone, Copy, Debug)]
pub struct Coupled<S: Scalar> {
    joint: Joint<S>,
    touching: [Touching<S>; RUNGS],
}

lanes!(Coupled { joint, touching });

/// A machine split in two, per unit.
struct Split<R> {
    /// The motor alone.
    motor: Machine<R>,
    /// Share of the inertia that is the load's.
    share: R,
    /// `Ω`, per interval.
    frequency: R,
    /// `2ζ`.
    twice_damping: R,
    /// `σ/Ω`.
    scale: R,
}

impl<R: Real> Split<R> {
    fn new(machine: &Machine<R>, coupling: &Coupling<R>) -> Result<Self, ModelError> {
        let one = R::from_f64(1.0);
        let share = coupling.load_share;
        if !(share > R::zero() && share < one) {
            return Err(ModelError::Parameter {
                name: "load share",
                value: share.to_f64(),
            });
        }
        let mut motor = *machine;
        motor.inertia = (one - share) * machine.inertia;
        let reduced = share * motor.inertia;
        let frequency = one / (reduced * coupling.compliance).sqrt();
        Ok(Split {
            motor,
            share,
            frequency,
            scale: one / (coupling.half_gap * frequency).max(one),
            twice_damping: coupling.damping_ratio + coupling.damping_ratio,
        })
    }

    fn maps(
        &self,
        machine: &Machine<R>,
        length: R,
        how: Discretisation,
    ) -> Result<Maps<R>, ModelError> {
        let zero = R::zero();
        let rate = length / machine.electrical;
        let push = length / machine.inertia;
        let drag = machine.damping * push;
        let turn = self.frequency * length;
        let (x, s) = (turn, self.twice_damping * turn);
        let (mx, ms) = (self.share * x, self.share * s);
        let load = R::from_f64(1.0) - self.share;
        let driven = LinearSystem {
            states: [
                [-rate, -(machine.kb * rate), zero, zero],
                [push, -drag, -mx, -ms],
                [zero, zero, zero, turn],
                [push, -drag, -x, -s],
            ],
            inputs: [[rate, zero], [zero, -push], [zero, zero], [zero, -push]],
            speed: 1,
        };
        let coast = LinearSystem {
            states: [[-drag, -mx, -ms], [zero, zero, turn], [-drag, -x, -s]],
            inputs: [[-push], [zero], [-push]],
            speed: 0,
        };
        let held = LinearSystem {
            states: [[zero, turn], [-(load * x), -(load * s)]],
            inputs: [[], []],
            speed: 0,
        };
        Ok(Maps {
            driven: driven.step(length, how)?,
            coast: coast.step(length, how)?,
            held: held.step(length, how)?,
        })
    }
}

/// The maps of a part in R, before they are lowered.
#[derive(Clone, Copy)]
struct Maps<R> {
    driven: LinearMap<R, 4, 2>,
    coast: LinearMap<R, 3, 1>,
    held: LinearMap<R, 2, 0>,
}

impl<R: Real> Maps<R> {
    fn twice(&self) -> Self {
        Maps {
            driven: self.driven.twice(),
            coast: self.coast.twice(),
            held: self.held.twice(),
        }
    }

    fn lower<S: Scalar>(
        &self,
        split: &Split<R>,
        machine: &Machine<R>,
        length: R,
    ) -> Result<Touching<S>, ModelError> {
        let (own, one) = (split.scale, R::from_f64(1.0));
        // What a row gives and what a column takes are twists in the third place.
        let (rows, columns) = (
            [one, one, own, one, one],
            [one, one, one / own, one, one, one],
        );
        let driven = |k: usize| {
            let map = &self.driven;
            let (x, u) = match k {
                4 => (map.angle_by_states, map.angle_by_inputs),
                _ => (map.states[k], map.inputs[k]),
            };
            let row = [x[0], x[1], x[2], x[3], u[0], u[1]];
            scaled::<S, R, 6>("coupled increment", row, rows[k], columns)
        };
        let coast = |k: usize| {
            let map = &self.coast;
            let (x, u) = match k {
                3 => (map.angle_by_states, map.angle_by_inputs),
                _ => (map.states[k], map.inputs[k]),
            };
            let columns = [one, one / own, one, one];
            let row = [x[0], x[1], x[2], u[0]];
            scaled::<S, R, 4>("coupled coasting increment", row, rows[k + 1], columns)
        };
        let held = |k: usize| {
            let columns = [one / own, one];
            let row = self.held.states[k];
            scaled::<S, R, 2>("held load increment", row, rows[k + 2], columns)
        };
        let flight = split.frequency * own * length;
        Ok(Touching {
            timing: Timing::new(
                machine,
                length,
                self.driven.inputs[0][0],
                self.driven.angle_by_inputs,
            ),
            driven: [driven(0)?, driven(1)?, driven(2)?, driven(3)?, driven(4)?],
            coast: [coast(0)?, coast(1)?, coast(2)?, coast(3)?],
            held: [held(0)?, held(1)?],
            flight: S::coefficient(flight.to_f64()),
        })
    }
}

impl<S: Scalar> Coupled<S> {
    /// The maps of a step of `step` intervals and of all its halvings; with them the machine of the
    /// motor alone.
    pub fn new<R: Real>(
        machine: &Machine<R>,
        coupling: &Coupling<R>,
        step: R,
        how: Discretisation,
    ) -> Result<(Self, Machine<R>), ModelError> {
        let split = Split::new(machine, coupling)?;
        let depth = RUNGS - 1;
        let (motor, lengths) = shortest(&split.motor, step, depth, how);
        let mut maps = split.maps(&motor, lengths[depth], how)?;
        let mut touching = [maps.lower::<S>(&split, &motor, lengths[depth])?; RUNGS];
        for level in (0..depth).rev() {
            maps = match how {
                Discretisation::Exact => maps.twice(),
                Discretisation::Euler => split.maps(&motor, lengths[level], how)?,
            };
            touching[level] = maps.lower::<S>(&split, &motor, lengths[level])?;
        }
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
        Ok((Coupled { joint, touching }, split.motor))
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

/// A [`Coupled`] and, for the time of free flight, the maps of the motor alone.
pub struct MotorAndLoad<'a, S: Scalar> {
    /// The motor alone.
    pub motor: &'a [Timed<S>; RUNGS],
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
                speed: weighed(&by, speed),
                angle: weighed(&by, angle),
                twist: weighed(&by, twist),
                slip: weighed(&by, slip),
            };
        }
        let by = [from.current, speed, bend, slip, volts, torque];
        let [current, speed, twist, slip, angle] = &maps.driven;
        Increment {
            current: weighed(&by, current),
            speed: weighed(&by, speed),
            angle: weighed(&by, angle),
            twist: weighed(&by, twist),
            slip: weighed(&by, slip),
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

impl<S: Scalar> Body<S> for MotorAndLoad<'_, S> {
    const COUPLED: bool = true;

    #[inline(always)]
    fn timing(&self, level: usize) -> &Timing<S> {
        &self.coupled.touching[level].timing
    }

    #[inline(always)]
    fn slide(
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
        let mut free = self.motor[level].slide(from, volts, torque, open);
        free.slip = free.speed;
        // The load flies on at the speed that it had.
        let ahead = (from.slip - from.speed).times(self.coupled.touching[level].flight);
        free.twist = free.angle.times(joint.twist_per_angle) + ahead;
        select(is_zero(side), free, touching)
    }

    #[inline(always)]
    fn settle(
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
        let still = self.motor.settle(level, from, side, volts, open);
        let touching = Increment {
            twist: weighed(&by, &maps.held[0]),
            slip: weighed(&by, &maps.held[1]),
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
    fn yields(&self, level: usize, torque: S) -> S {
        torque.times(self.coupled.touching[level].driven[1][5])
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
