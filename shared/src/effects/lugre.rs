//! LuGre friction: bristles that bend before they slide.

use super::decay::{REACH, decay};
use super::hump::Hump;
use super::{
    AtSpeed, Contained, Description, Effect, Evidence, Facts, Needs, Parameter, Place, Shaft,
    Starts, Stiff, Value,
};
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};

/// `dz/dt = ω − |ω|·z/zs(ω)`, `T = σ0·z + σ1·dz/dt`, with the deflection `zs` at which the bristles
/// slide: `σ0·zs(ω) = Tc·(1 + r·exp(−(ω/ωs)²))`. The memory is `u = z/zs(∞)`, so that `T = Tc·u`.
///
/// For a steady speed the bristles have an exact solution, and only the travel `a` (in deflections)
/// enters: `u` tends to `±(1 + r·exp…)` as `exp(−|a|/(1 + r·exp…))`. It is used for each part, so
/// that the part may be much longer than the bristles take to bend.
///
/// Its form is blended into damping `σ1·exp(−(ω/ωs)²)`, which leaves fast sliding alone (Olsson).
#[derive(Clone, Copy, Debug)]
pub struct Lugre<S: Scalar> {
    torque: S,
    /// Deflections beyond one at which slow bristles slide.
    excess: S,
    /// How slow they are: one at rest.
    slow: Hump<S>,
    /// Part of the damping that falls with the speed.
    form: S,
    /// Travel that bends the bristles as far as they go, turns.
    far: S,
    per_deflection: S::Coefficient,
    /// `σ1/σ0` in intervals.
    damping: S::Coefficient,
    /// Largest rate whose product with that the number format can hold.
    fastest: S,
    /// Largest angle per torque whose product with `per_deflection` the number format can hold.
    softest: S,
}

lanes!(Lugre {
    torque,
    excess,
    slow,
    form,
    far,
    per_deflection,
    damping,
    fastest,
    softest
});

/// Least deflection, turns.
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
            Parameter::form("form"),
        ],
        equation: "dz/dt = w - |w|*z/zs(w), T = s0*(z + t1*(1 - f + f*exp(-(w/ws)^2))*dz/dt), s0*zs(w) = Tc*(1 + r*exp(-(w/ws)^2)), zs(0) = presliding",
        signature: "hysteresis at small reversals; the angle moves before it breaks away",
        exposed_by: "small reversals below break-away",
        look_alikes: &["coulomb", "stribeck", "backlash", "compliance"],
        source: "Canudas de Wit, Olsson, Astrom, Lischinsky, IEEE TAC 40(3), 1995; Olsson, Control Systems with Friction, 1996 (falling damping)",
        facts: Facts {
            contains: &[
                Contained {
                    name: "coulomb",
                    values: &[Value::Own(0)],
                    at_rest: &[(1, 0.0), (3, 0.0), (4, 0.0)],
                    whole: true,
                },
                // Bristles that hardly bend; of the Stribeck humps only the Gaussian one.
                Contained {
                    name: "stribeck",
                    values: &[
                        Value::Own(0),
                        Value::Product(1, 0),
                        Value::Own(2),
                        Value::Fixed(2.0),
                        Value::Fixed(0.0),
                    ],
                    at_rest: &[(3, 0.0), (4, 0.0)],
                    whole: false,
                },
            ],
            // Bristles slide as dry friction does.
            starts: Starts::Fit("coulomb"),
            costly: true,
            series_parallel: false,
            evidence: Evidence::ChangesSign,
            at_speed: AtSpeed::Sliding {
                mean_of: &[0],
                without: Some("what is elastic and what is larger near standstill is left out"),
            },
            ..Facts::PLAIN
        },
    };
    const NEEDS: Needs = Needs {
        mean: true,
        stiff: true,
        memory: true,
        ..Needs::NOTHING
    };

    fn lower<R: Real>(values: &[R], units: &PerUnit<R>) -> Self {
        let speed = units.lower(values[2], Quantity::Speed);
        let excess = values[1].to_f64().max(0.0);
        let presliding = units.lower(values[3], Quantity::Angle).to_f64();
        let damping = units.lower(values[4], Quantity::Time).to_f64();
        let deflection = presliding.max(SHORTEST) / (1.0 + excess);
        Lugre {
            torque: units.number(values[0], Quantity::Torque),
            excess: S::from_f64(excess),
            slow: Hump::new(R::from_f64(1.0), speed, R::from_f64(2.0)),
            form: units.number(values[5], Quantity::Ratio),
            far: S::from_f64(4.0 * REACH * deflection),
            per_deflection: S::coefficient(1.0 / deflection),
            damping: units.multiplier::<S>(values[4], Quantity::Time),
            fastest: S::from_f64(S::LIMIT / 2.0 / damping.max(1.0)),
            softest: S::from_f64(S::LIMIT / 4.0 * deflection),
        }
    }

    #[inline(always)]
    fn stiff(&self, shaft: &Shaft<S>, memory: S) -> Stiff<S> {
        let half = S::coefficient(0.5);
        let bent = self.bent(memory, shaft);
        // Bristles know the travel, and the mean over time is not that over the travel.
        let late = shaft.late.max(-self.far).min(self.far);
        let late = late.times(self.per_deflection);
        // What a little more travel bends at the end of the part, it bends half in the mean.
        let compliance = (self.torque * shaft.compliance).min(self.softest);
        let further = compliance.times(self.per_deflection) * bent.further;
        Stiff {
            torque: self.torque * (bent.mean - late * bent.further)
                + self.damped(self.torque * (bent.end - memory), shaft) * bent.damping,
            slope: further.times(half) + self.damped(further, shaft) * bent.damping,
            doubt: self.torque * late.abs() * bent.to_go,
        }
    }

    #[inline(always)]
    fn remember(&self, memory: S, shaft: &Shaft<S>) -> S {
        self.bent(memory, shaft).end
    }
}

/// Bristles over a part.
struct Bent<S> {
    /// Mean deflection.
    mean: S,
    /// Deflection at the end.
    end: S,
    /// Deflections to go at the start; not negative.
    to_go: S,
    /// By how much it grows there with further travel, both in deflections; not negative.
    further: S,
    /// Part of the damping that the speed leaves; not negative.
    damping: S,
}

impl<S: Scalar> Lugre<S> {
    /// Damping of a torque that changes by `change` over the part. It may be beyond the number format
    /// for a moment: far less is left of it when the torque has been solved for.
    #[inline(always)]
    fn damped(&self, change: S, shaft: &Shaft<S>) -> S {
        let most = self.fastest.times(shaft.length);
        let change = change.min(most).max(-most);
        change.times(shaft.per_length).times(self.damping)
    }

    /// The bristles over a part that they begin at a deflection `from`.
    #[inline(always)]
    fn bent(&self, from: S, shaft: &Shaft<S>) -> Bent<S> {
        let one = S::from_f64(1.0);
        let half = S::from_f64(0.5);
        let slow = shaft.mean_over_speed(
            #[inline(always)]
            |speed| self.slow.at(speed),
        );
        let steady = one + self.excess * slow;
        // A quarter of the deflections travelled, x/4, at most seven: its eighth is a part.
        let quarter = S::coefficient(0.25);
        let travel = shaft.travel.abs().min(self.far).times(quarter);
        let eighth = travel
            .times(self.per_deflection)
            .times(S::coefficient(0.125));
        let short = eighth.part_of(steady).times(S::coefficient(8.0));
        let left = decay(short);
        // (1 − e^−x)/x, by its series where the difference would lose digits.
        let x = short.times(S::coefficient(4.0));
        let series = one - x * (half - x * S::from_f64(1.0 / 6.0));
        let quotient = (one - left).times(quarter).part_of(short);
        let small = short.less(S::from_f64(1.0 / 1024.0));
        let mean_left = S::select(small, series, quotient);
        let sense = shaft.travel.signum();
        let goal = steady * sense;
        let gap = from - goal;
        // The bristles may be bent the other way: a gap of up to twice what is steady.
        let to_go = (-(gap * sense)).max(S::zero());
        let share = (to_go * half).part_of(steady);
        Bent {
            mean: goal + gap * mean_left,
            end: goal + gap * left,
            to_go,
            further: (share * left).times(S::coefficient(2.0)),
            damping: (one - self.form + self.form * slow).max(S::zero()),
        }
    }
}
