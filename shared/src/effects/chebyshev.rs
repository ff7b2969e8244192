//! Functions that no number format has, as series of Chebyshev polynomials.

use crate::scalar::{Real, Scalar, lanes};
use core::array::from_fn;

/// Degree of the series.
const DEGREE: usize = 16;

/// A function of a variable within −1 and 1: `Σ c_k·T_k(x)`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chebyshev<S: Scalar> {
    terms: [S; DEGREE + 1],
}

lanes!(Chebyshev { terms });

impl<S: Scalar> Chebyshev<S> {
    /// The series that agrees with `f` at the extrema of `T_n`, both ends among them (Trefethen,
    /// *Approximation Theory and Approximation Practice*, 3).
    pub(super) fn through<R: Real>(f: impl Fn(R) -> R) -> Self {
        let nodes: [R; DEGREE + 1] = from_fn(|j| {
            let turns = R::from_f64(j as f64 / (2 * DEGREE) as f64);
            turns.sin_cos_turns().1
        });
        let values = nodes.map(f);
        let halved = |k: usize| if k.is_multiple_of(DEGREE) { 0.5 } else { 1.0 };
        let terms = from_fn(|k| {
            let sum = values
                .iter()
                .enumerate()
                .fold(R::zero(), |sum, (j, value)| {
                    // cos(π·jk/n) is again a node.
                    let turn = j * k % (2 * DEGREE);
                    let cosine = nodes[turn.min(2 * DEGREE - turn)];
                    sum + *value * cosine * R::from_f64(halved(j))
                });
            S::from_f64(sum.to_f64() * halved(k) * 2.0 / DEGREE as f64)
        });
        Chebyshev { terms }
    }

    /// The function at `x`, by Clenshaw's recurrence.
    #[inline(always)]
    pub(super) fn at(&self, x: S) -> S {
        let twice = x + x;
        let (first, others) = (self.terms[0], &self.terms[1..]);
        let (mut next, mut after) = (S::zero(), S::zero());
        for term in others.iter().rev() {
            (next, after) = (twice * next + (*term - after), next);
        }
        x * next + (first - after)
    }
}
