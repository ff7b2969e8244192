//! The states of a formula over a part.

use super::MAX_STATES;
use super::interpret::At;
use super::number::{Dual, Number};
use super::run::{Stated, reverses};
use crate::effects::{Memory, Shaft};
use crate::scalar::Scalar;

/// A state over a part, as a part of its range.
#[derive(Clone, Copy)]
pub(super) struct Followed<S> {
    /// Its mean, with the derivative by the speed and its change over the part.
    pub mean: Dual<S>,
    pub end: S,
    /// As its slope at the beginning has it, of the whole part.
    pub rate_at_end: S,
}

impl<S: Scalar> Followed<S> {
    fn resting(at: S) -> Self {
        Followed {
            mean: Dual::constant(at),
            end: at,
            rate_at_end: S::zero(),
        }
    }
}

/// The states over a part.
pub(super) struct Moved<S> {
    pub each: [Followed<S>; MAX_STATES],
    /// How much the mean of the first is another one for what the second does within the part.
    pub coupled: S,
}

/// `1/a − x/b + x²/c − x³/d`.
#[inline(always)]
fn series<S: Scalar>(x: S, [a, b, c, d]: [f64; 4]) -> S {
    let by = S::from_f64;
    by(1.0 / a) - x * (by(1.0 / b) - x * (by(1.0 / c) - x * by(1.0 / d)))
}

impl<S: Scalar> Stated<S> {
    #[inline(always)]
    pub(super) fn differentiated(&self, shaft: &Shaft<S>) -> At<Dual<S>> {
        let swinging = |value, swing| Dual {
            swing,
            ..Dual::constant(value)
        };
        // Where the motion reverses, what depends on its direction bends.
        let speed_change = S::select(reverses(shaft), S::zero(), shaft.speed_change);
        At {
            speed: Dual {
                by_speed: S::one(),
                ..swinging(shaft.speed, speed_change)
            },
            turns: swinging(shaft.turns, shaft.travel),
            current: swinging(shaft.current, shaft.current_change),
            transmitted: swinging(shaft.transmitted, shaft.current_change),
            command: Dual::constant(shaft.volts),
            temperature: Dual::constant(shaft.temperature),
            ..At::all(Dual::constant(S::zero()))
        }
    }

    /// Rate of a state, by the interval.
    #[inline(always)]
    pub(super) fn rate<N: Number<S>>(&self, place: usize, at: &At<N>) -> N {
        let rate = self.run(self.program.states[place].rate, self.rates_from[place], at);
        rate.scaled(self.rates[place])
    }

    /// The states over a part: each beside the mean of the other, the first again where the second has moved. Of states that do not
    /// depend on each other, this is each by itself.
    #[inline(always)]
    pub(super) fn moved(&self, shaft: &Shaft<S>, memory: &Memory<S>) -> Moved<S> {
        let mut at = self.differentiated(shaft);
        at.states = memory.map(Dual::constant);
        let first = self.followed(0, memory[0], shaft, &at);
        let rests = Followed::resting(memory[1]);
        if self.program.states.len() < 2 {
            return Moved {
                each: [first, rests],
                coupled: S::zero(),
            };
        }
        at.states[0] = first.mean;
        let second = self.followed(1, memory[1], shaft, &at);
        at.states[1] = second.mean;
        let again = self.followed(0, memory[0], shaft, &at);
        Moved {
            each: [again, second],
            coupled: (again.mean.value - first.mean.value).abs(),
        }
    }

    /// One state from `begin` over a part, whose rate is taken as linear in it and in the time: exact where it is (the exponential
    /// Rosenbrock–Euler method with its functions φ₁ to φ₃: Hochbruck, Ostermann, *Acta Numerica* 19, 2010, 2.1 and 2.3).
    #[inline(always)]
    fn followed(&self, place: usize, begin: S, shaft: &Shaft<S>, at: &At<Dual<S>>) -> Followed<S> {
        let mut at = *at;
        at.states[place] = Dual {
            by_state: S::one(),
            ..Dual::constant(begin)
        };
        let rate = self.rate(place, &at).scaled(shaft.length);
        let one = S::one();
        let half = S::from_f64(0.5);
        // How often the state is renewed within the part; not negative.
        let x = (-rate.by_state).max(S::zero()).min(S::from_f64(600.0));
        let small = x.less(S::from_f64(1.0 / 64.0));
        // φ₁ to φ₃ of −x: (1 − e^−x)/x, and each next one (1/n! − the one before)/x; by their series where a difference would lose digits.
        let quotient = (one - (-x).exp_decay()).part_of(x);
        let first = S::select(small, series(x, [1.0, 2.0, 6.0, 24.0]), quotient);
        let quotient = (one - first).part_of(x);
        let second = S::select(small, series(x, [2.0, 6.0, 24.0, 120.0]), quotient);
        let quotient = (half - second).part_of(x);
        let third = S::select(small, series(x, [6.0, 24.0, 120.0, 720.0]), quotient);
        // The rate is the one in the middle of the part; it begins half of its change before.
        let early = rate.value - half * rate.swing;
        let gone = early * first + rate.swing * second;
        let mean = begin + early * second + rate.swing * third;
        Followed {
            mean: Dual {
                by_speed: rate.by_speed * second,
                swing: gone,
                ..Dual::constant(mean)
            },
            end: begin + gone,
            rate_at_end: rate.value - x * gone,
        }
    }
}
