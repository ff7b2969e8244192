//! What an effect sees of the motor, and what it may give back. Per unit.

use crate::scalar::{Mask, Real, Scalar, lanes};

/// The mean state of shaft and winding over a part of a step.
#[derive(Clone, Copy, Debug)]
pub struct Shaft<S: Scalar> {
    /// Mean position within a revolution, as a fraction of a turn; only if
    /// the effect [needs](super::Needs::angle) it.
    pub turns: S,
    /// Travel, turns.
    pub travel: S,
    /// By how much the mean position lies before the middle of the travel, turns: a shaft that
    /// gathers speed is late.
    pub late: S,
    /// Speed.
    pub speed: S,
    /// By how much the speed changes.
    pub speed_change: S,
    /// Current, as the voltage across the resistance.
    pub current: S,
    /// By how much the current changes.
    pub current_change: S,
    /// Volts from the drive, which are held.
    pub volts: S,
    /// Temperature that the recording tells; zero where it tells none.
    pub temperature: S,
    /// Torque that the motor and its load pass to each other, without dry friction; only in
    /// [`Effect::friction`](super::Effect::friction).
    pub transmitted: S,
    /// By how much the travel falls per torque against it, turns.
    pub compliance: S,
    /// Torque that changes the speed by one within the part, without back-EMF and friction.
    pub inertia: S::Coefficient,
    /// Length of the part in intervals.
    pub length: S::Coefficient,
    /// One over that.
    pub per_length: S::Coefficient,
}

impl<S: Scalar> Shaft<S> {
    /// One instant.
    #[inline(always)]
    pub fn at(turns: S, speed: S, current: S) -> Self {
        let zero = S::zero();
        Shaft {
            turns,
            travel: zero,
            late: zero,
            speed,
            speed_change: zero,
            current,
            current_change: zero,
            volts: zero,
            temperature: zero,
            transmitted: current,
            compliance: zero,
            inertia: S::coefficient(0.0),
            length: S::coefficient(0.0),
            per_length: S::coefficient(0.0),
        }
    }

    /// Mean over the part of what depends on the speed alone, by Gauss's rule of two points.
    #[inline(always)]
    pub fn mean_over_speed(&self, f: impl Fn(S) -> S) -> S {
        mean(self.speed, self.speed_change, f)
    }

    /// Mean over the part of what depends on the current alone, by Gauss's rule of two points.
    #[inline(always)]
    pub fn mean_over_current(&self, f: impl Fn(S) -> S) -> S {
        mean(self.current, self.current_change, f)
    }
}

/// Mean of `f` over an interval of width `change` about `middle`: exact for cubics.
#[inline(always)]
fn mean<S: Scalar>(middle: S, change: S, f: impl Fn(S) -> S) -> S {
    let zero = S::zero();
    if !change.less(zero).or(zero.less(change)).any() {
        return f(middle);
    }
    // 1/(2√3)
    let reach = change * S::from_f64(0.288_675_134_594_812_9);
    (f(middle - reach) + f(middle + reach)) * S::from_f64(0.5)
}

/// A torque budget: friction that may stop the shaft and hold it, but never push it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Budget<S> {
    /// Available against motion.
    pub moving: S,
    /// Available to hold a shaft at rest.
    pub holding: S,
    /// How much more of both there is against forward motion, and how much less against backward
    /// motion; never more than they are. A torque to the equations: friction `F + B` forward and
    /// `F − B` backward holds the same pulls as friction `F` with a load `B`.
    pub bias: S,
}

lanes!(Budget {
    moving,
    holding,
    bias
});

impl<S: Scalar> Budget<S> {
    /// The same at rest and in motion, and in both directions.
    #[inline(always)]
    pub fn even(torque: S) -> Self {
        Budget {
            moving: torque,
            holding: torque,
            bias: S::zero(),
        }
    }

    /// Both.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Budget {
            moving: self.moving + other.moving,
            holding: self.holding + other.holding,
            bias: self.bias + other.bias,
        }
    }
}

/// A torque that rises so steeply with the travel that it must be solved for: by one step of Newton,
/// from the torque for the travel as foreseen and its slope there (the linearly implicit method of
/// Hairer, Wanner, *Solving Ordinary Differential Equations II*, IV.7).
#[derive(Clone, Copy, Debug, Default)]
pub struct Stiff<S> {
    /// Torque against positive rotation for the travel as foreseen.
    pub torque: S,
    /// By how much it falls per torque, for the travel that the torque takes; not negative.
    pub slope: S,
    /// What may be wrong with the torque if the speed changes within the part; not negative.
    pub doubt: S,
}

impl<S: Scalar> Stiff<S> {
    /// Both.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Stiff {
            torque: self.torque + other.torque,
            slope: self.slope + other.slope,
            doubt: self.doubt + other.doubt,
        }
    }

    /// The torque that agrees with the travel it leaves, if `reckoned` with was another.
    #[inline(always)]
    pub fn from(self, reckoned: S) -> S {
        let one = S::from_f64(1.0);
        reckoned + (self.torque - reckoned) * one.part_of(one + self.slope)
    }
}

/// Changes of the winding, as shares of its own constants, and volts at it; zero where nothing changes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Winding<S> {
    /// Extra resistance.
    pub resistance: S,
    /// Extra of one over the inductance.
    pub rate: S,
    /// Extra back-EMF.
    pub back_emf: S,
    /// Volts beside those of the drive.
    pub volts: S,
    /// What may be wrong with them; not negative.
    pub doubt: S,
}

impl<S: Scalar> Winding<S> {
    /// No change but volts beside those of the drive.
    #[inline(always)]
    pub fn volts(volts: S, doubt: S) -> Self {
        Winding {
            volts,
            doubt,
            ..Winding::default()
        }
    }

    /// Both.
    #[inline(always)]
    pub fn and(self, other: Self) -> Self {
        Winding {
            resistance: self.resistance + other.resistance,
            rate: self.rate + other.rate,
            back_emf: self.back_emf + other.back_emf,
            volts: self.volts + other.volts,
            doubt: self.doubt + other.doubt,
        }
    }
}

/// A second inertia behind a spring, perhaps behind a gap.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coupling<R> {
    /// Share of the machine's inertia that is the load's.
    pub load_share: R,
    /// One over the spring rate: angle (base speed × interval) per torque.
    pub compliance: R,
    /// Damping ratio of the two inertias against each other.
    pub damping_ratio: R,
    /// Half of the gap, in base speed × interval.
    pub half_gap: R,
    /// Share of the dry friction that acts on the load.
    pub friction_share: R,
}

impl<R: Real> Coupling<R> {
    /// Two inertias that swing against each other with `period` (in intervals), sharing the
    /// inertia of a machine; without a gap, and with all dry friction on the motor.
    pub fn new(load_share: R, inertia: R, period: R, damping_ratio: R) -> Self {
        let reduced = load_share * (R::from_f64(1.0) - load_share) * inertia;
        let per_radian = period / R::from_f64(core::f64::consts::TAU);
        Coupling {
            load_share,
            compliance: per_radian * per_radian / reduced,
            damping_ratio,
            half_gap: R::zero(),
            friction_share: R::zero(),
        }
    }

    /// Both in series, in front of one load.
    #[inline(always)]
    pub fn in_series_with(self, other: Self) -> Self {
        Coupling {
            load_share: self.load_share.max(other.load_share),
            compliance: self.compliance + other.compliance,
            damping_ratio: self.damping_ratio.max(other.damping_ratio),
            half_gap: self.half_gap + other.half_gap,
            friction_share: self.friction_share.max(other.friction_share),
        }
    }
}
