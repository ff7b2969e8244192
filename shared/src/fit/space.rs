//! The search space: unknowns and their ranges.
//!
//! The first coordinate is the acceleration from standstill, gain over mechanical time constant: a slow motor's recording
//! shows that well and either of the two badly, so gain itself would lie along a narrow slanted valley (a swarm of 20 missed
//! 8 % of drawn motors with it, 3 % without).

use super::Settings;
use super::motor::Motor;
use crate::scalar::Real;
use crate::trace::Trace;

/// Most unknowns.
pub const MOST: usize = 8;

/// A point of the unit cube.
pub type Point = [f32; MOST];

/// One unknown, in the device's own measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// Steady speed under the whole supply, counts a period.
    Gain,
    /// First-order coefficient a1 of the response to voltage, which is nearly the mechanical time constant, periods.
    FirstOrder,
    /// Second-order coefficient a2 by a1, the electrical time constant if nothing is viscous, periods.
    Electrical,
    /// Coulomb friction, as a part of the supply.
    Coulomb,
    /// Constant load against positive rotation, as a part of the supply.
    Load,
    /// What the bridge's dead time takes, as a part of the supply. Not searched for, but polished from the board's own figure: in six dimensions
    /// twenty fireflies miss a quarter of even ideal motors.
    DeadTime,
    /// Part of the damping that is viscous friction, polished from zero: nothing but the current's sign tells it from back-EMF. The response to
    /// voltage does not depend on it.
    Viscous,
    /// Resistance of the supply as a part of the winding's, polished from zero when all else is, and kept only where it explains most of what
    /// was left: a little of everything that the model lacks looks like it.
    Supply,
}

/// The unknowns and their ranges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Space {
    unknowns: [Unknown; MOST],
    dim: usize,
    /// The first so many are searched for.
    searched: usize,
    /// Where the others stand meanwhile.
    held: Point,
    /// Waves of the bridge's carrier in a period.
    carriers: f32,
    /// Duty that is the whole supply, a part of the unit.
    full: f32,
    /// How far the origin was moved, see [`about`](Self::about).
    moved: Point,
    /// Values where all coordinates are zero.
    origin: Point,
    /// What a coordinate of one adds: to a logarithm, or to a value.
    span: Point,
}

/// Accelerations are searched from a third of the gain that the trace shows, regressed without lag, over the longest time
/// constant, to twice that gain in one period.
const GAIN_BELOW: f32 = 3.0;
const ABRUPT: f32 = 2.0;
/// Mechanical time constants: from half a period to twice the trace.
const SHORTEST: f32 = 0.5;
/// Electrical time constants, periods.
const ELECTRICAL: [f32; 2] = [0.02, 50.0];
/// Places among the coordinates: the logarithms, before all others.
const GAIN: usize = 0;
const FIRST_ORDER: usize = 1;
/// Friction and load, parts of the supply.
const MOST_FRICTION: f32 = 0.5;
/// What a dead time takes, a part of the supply: 2.5 µs at 20 kHz.
const MOST_DEAD_TIME: f32 = 0.1;
/// 500 ns at 20 kHz.
const ORDINARY_DEAD_TIME: f32 = 0.02;
/// Resistance of the supply, a part of the winding's.
const MOST_SUPPLY: f32 = 0.3;
/// Viscous part of the damping.
const MOST_VISCOUS: f32 = 0.3;

impl Space {
    /// Of nothing.
    pub(super) const NONE: Space = Space {
        unknowns: [Unknown::Gain; MOST],
        dim: 0,
        searched: 0,
        held: [0.0; MOST],
        carriers: 0.0,
        full: 0.0,
        moved: [0.0; MOST],
        origin: [0.0; MOST],
        span: [0.0; MOST],
    };

    /// Around what the trace shows at a glance; `None` if the shaft did not move with the drive.
    pub fn around(trace: &Trace<'_>, settings: &Settings) -> Option<Self> {
        let (mut cross, mut power) = (0i64, 0i64);
        for (duty, step) in trace.iter() {
            let duty = i64::from(duty.unwrap_or(0));
            cross += duty * i64::from(step);
            power += duty * duty;
        }
        if cross <= 0 || power <= 0 {
            return None;
        }
        let gain = cross as f32 / power as f32 * 32_768.0;
        let longest = 2.0 * trace.len() as f32;
        let mut space = Space::NONE;
        space.push(
            Unknown::Gain,
            gain * (SHORTEST / GAIN_BELOW) / longest,
            Real::ln(ABRUPT * GAIN_BELOW * longest),
        );
        space.push(Unknown::FirstOrder, SHORTEST, Real::ln(longest / SHORTEST));
        let [low, high] = ELECTRICAL;
        space.push(Unknown::Electrical, low, high - low);
        if settings.coulomb {
            space.push(Unknown::Coulomb, 0.0, MOST_FRICTION);
        }
        if settings.load {
            space.push(Unknown::Load, -MOST_FRICTION, 2.0 * MOST_FRICTION);
        }
        space.searched = space.dim;
        space.full = match settings.full {
            0 => 1.0,
            full => f32::from(full) * (1.0 / 32_768.0),
        };
        if settings.carriers > 0 {
            space.carriers = settings.carriers.into();
            let told = f32::from(settings.dead_time) * (1.0 / 32_768.0);
            space.held[space.dim] = (told / MOST_DEAD_TIME).min(1.0);
            space.push(Unknown::DeadTime, 0.0, MOST_DEAD_TIME);
            space.push(Unknown::Viscous, 0.0, MOST_VISCOUS);
        }
        Some(space)
    }

    fn push(&mut self, unknown: Unknown, origin: f32, span: f32) {
        self.unknowns[self.dim] = unknown;
        self.origin[self.dim] = origin;
        self.span[self.dim] = span;
        self.dim += 1;
    }

    /// Adds the resistance of the supply.
    pub(super) fn add_supply(&mut self) {
        self.push(Unknown::Supply, 0.0, MOST_SUPPLY);
    }

    /// Puts the origin of the logarithms at `x`, whose coordinates along them become zero; returns what they are in the unit cube. An f32 along
    /// the whole range of a logarithm has steps of a millionth of the value, and a gain that is off by that much is a tenth of a
    /// count off after a hundred thousand; near zero its steps are as fine as those of the value.
    pub(super) fn about(&mut self, x: &mut Point) -> Point {
        let (gain, mechanical) = (self.value(GAIN, x), self.value(FIRST_ORDER, x));
        (self.origin[GAIN], self.origin[FIRST_ORDER]) = (gain, mechanical);
        for k in [GAIN, FIRST_ORDER] {
            self.moved[k] += x[k];
            x[k] = 0.0;
        }
        self.moved
    }

    /// Number of unknowns that are searched for; the others are only polished.
    pub fn searched(&self) -> usize {
        self.searched
    }

    /// `x` with what is not searched for where it is held.
    pub(super) fn of_search(&self, mut x: Point) -> Point {
        x[self.searched..].copy_from_slice(&self.held[self.searched..]);
        x
    }

    /// Searches on from the other end: with nothing lost where the board told a dead time, and with an ordinary one where it told none.
    pub(super) fn hold_elsewhere(&mut self) {
        let told = self.held[self.searched] > 0.0;
        self.held = [0.0; MOST];
        if !told && self.carriers > 0.0 {
            self.held[self.searched] = ORDINARY_DEAD_TIME / MOST_DEAD_TIME;
        }
    }

    /// Searches on with what is not searched for where it ended in another search.
    pub(super) fn hold_as(&mut self, x: &Point) {
        self.held[self.searched..].copy_from_slice(&x[self.searched..]);
    }

    /// Number of unknowns.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// The unknowns, in the order in which they are reported.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns[..self.dim]
    }

    /// The value of unknown `k` at `x`.
    pub fn value(&self, k: usize, x: &Point) -> f32 {
        let mut added = self.span[k] * x[k];
        if k == GAIN {
            added += self.span[FIRST_ORDER] * x[FIRST_ORDER];
        }
        if k > FIRST_ORDER {
            self.origin[k] + added
        } else {
            self.origin[k] * Real::exp(added)
        }
    }

    /// By how much the value of unknown `k` changes with each coordinate of `x`.
    pub fn gradient(&self, k: usize, x: &Point) -> Point {
        let scale = if k > FIRST_ORDER {
            1.0
        } else {
            self.value(k, x)
        };
        let mut gradient = [0.0; MOST];
        gradient[k] = self.span[k] * scale;
        if k == GAIN {
            gradient[FIRST_ORDER] = self.span[FIRST_ORDER] * scale;
        }
        gradient
    }

    /// The motor at `x`.
    // Out of line, as `build`, and for the sake of short instructions, which reach the first kilobyte of a stack.
    #[inline(never)]
    pub fn motor(&self, x: &Point) -> Motor {
        let mut motor = Motor {
            carriers: self.carriers,
            full: self.full,
            ..Motor::NONE
        };
        for (k, unknown) in self.unknowns().iter().enumerate() {
            let slot = match unknown {
                Unknown::Gain => &mut motor.gain,
                Unknown::FirstOrder => &mut motor.first_order,
                Unknown::Electrical => &mut motor.electrical,
                Unknown::Coulomb => &mut motor.coulomb,
                Unknown::Load => &mut motor.load,
                Unknown::DeadTime => &mut motor.dead_time,
                Unknown::Viscous => &mut motor.viscous,
                Unknown::Supply => &mut motor.supply,
            };
            *slot = self.value(k, x);
        }
        motor
    }
}
