//! LuGre friction: bristles that bend before they slide.

use super::{Description, Effect, Needs, Parameter, Place, Shaft};
use crate::scalar::{Real, Scalar};
use crate::units::{PerUnit, Quantity};

/// `dz/dt = ω − |ω|·z/zs(ω)`, `T = σ0·z + σ1·dz/dt`, with the deflection `zs` at which the bristles
/// slide: `σ0·zs(ω) = Tc·(1 + r·exp(−(ω/ωs)²))`. The memory is `u = z/zs(∞)`, so that `T = Tc·u`.
///
/// For a steady speed the bristles have an exact solution, and only the travel `a` (in deflections)
/// enters: `u` tends to `±(1 + r·exp…)` as `exp(−|a|/(1 + r·exp…))`. It is used for each part, so
/// that the part may be much longer than the bristles take to bend.
#[derive(Clone, Copy, Debug)]
pub struct Lugre<S: Scalar> {
    torque: S,
    excess: S,
    /// Speed at which the Stribeck hump is over.
    reach: S,
    per_speed: S::Coefficient,
    /// Travel that bends the bristles as far as they go, turns.
    far: S,
    per_deflection: S::Coefficient,
    /// `σ1/σ0` in intervals.
    damping: S::Coefficient,
}

/// Deflections of travel after which the bristles slide steadily, and Stribeck speeds, squared,
/// after which the hump is over: `e` to the minus this is as good as nothing.
const REACH: f64 = 7.0;

/// Slowest Stribeck speed, as a part of the base speed, and least deflection, turns.
const SLOWEST: f64 = 1e-4;
const SHORTEST: f64 = 1e-7;

impl<S: Scalar> Effect<S> for Lugre<S> {
    const DESCRIPTION: Description = Description {
        name: "lugre",
        place: Place::Torque,
        title: "LuGre friction (elastic before it slides)",
        parameters: &[
            Parameter::amplitude("torque", Quantity::Torque, (0.0, 0.5), 0.03),
            Parameter::shape("excess", Quantity::Ratio, (0.0, 1.5), 0.3),
            Parameter::shape("speed", Quantity::Speed, (0.001, 0.3), 0.03),
            Parameter::shape("presliding", Quantity::Angle, (0.0005, 0.1), 0.008),
            Parameter::shape("damping_time", Quantity::Time, (0.0, 0.05), 0.003),
        ],
        equation: "dz/dt = w - |w|*z/zs(w), T = s0*(z + t1*dz/dt), s0*zs(w) = Tc*(1 + r*exp(-(w/ws)^2)), zs(0) = presliding",
        signature: "hysteresis at small reversals; the angle moves before it breaks away",
        exposed_by: "small reversals below break-away",
        look_alikes: &["coulomb", "stribeck", "backlash", "compliance"],
        source: "Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40(3), 1995",
    };
    const NEEDS: Needs = Needs {
        mean: true,
        memory: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let speed = units.lower(values[2], Quantity::Speed).to_f64();
        let speed = speed.max(SLOWEST);
        let excess = values[1].to_f64().max(0.0);
        let presliding = units.lower(values[3], Quantity::Angle).to_f64();
        let deflection = presliding.max(SHORTEST) / (1.0 + excess);
        Lugre {
            torque: units.number(values[0], Quantity::Torque),
            excess: S::from_f64(excess),
            reach: S::from_f64(libm::sqrt(REACH) * speed),
            per_speed: S::coefficient(1.0 / speed),
            far: S::from_f64(REACH * deflection),
            per_deflection: S::coefficient(1.0 / deflection),
            damping: units.multiplier::<S>(values[4], Quantity::Time),
        }
    }

    fn torque(&self, shaft: &Shaft<S>, memory: S) -> S {
        let (mean, end) = self.bent(memory, shaft);
        let rate = (end - memory).times(shaft.per_length);
        self.torque * (mean + rate.times(self.damping))
    }

    fn remember(&self, memory: S, shaft: &Shaft<S>) -> S {
        self.bent(memory, shaft).1
    }
}

impl<S: Scalar> Lugre<S> {
    /// Mean and final deflection of a part that begins at `from`.
    fn bent(&self, from: S, shaft: &Shaft<S>) -> (S, S) {
        let one = S::from_f64(1.0);
        let half = S::from_f64(0.5);
        let slow = shaft.speed.abs().min(self.reach).times(self.per_speed);
        let steady = one + self.excess * (-(slow * slow)).exp_decay();
        let travel = shaft.travel.abs().min(self.far).times(self.per_deflection);
        // Deflections travelled: at most seven, so the quotient of an eighth is below one.
        let eighth = S::coefficient(0.125);
        let bends = travel
            .times(eighth)
            .part_of(steady)
            .times(S::coefficient(8.0));
        let left = (-bends).exp_decay();
        // (1 − e^−x)/x, by its series where the difference would lose digits.
        let series = one - bends * half + bends * bends * S::from_f64(1.0 / 6.0);
        let quotient = (one - left).part_of(bends);
        let small = bends.less(S::from_f64(1.0 / 256.0));
        let mean_left = S::select(small, series, quotient);
        let goal = steady * shaft.travel.signum();
        let gap = from - goal;
        (goal + gap * mean_left, goal + gap * left)
    }
}
