//! Search by ask and tell, in fixed arrays: a method asks for the cost of a point of the unit cube
//! and is told it, so that a search can be laid down between two control ticks and taken up again.
//!
//! All points lie in `[0, 1]^dim`; what they mean is the caller's affair. Costs are only compared,
//! never added, so a cost that was cut off above [`Optimiser::bound`] does just as well.

mod firefly;
mod pso;
mod random;

pub use firefly::{Firefly, FireflySettings};
pub use pso::{Pso, PsoSettings};
pub use random::RandomSearch;

use crate::scalar::Real;

/// A point with its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate<R, const D: usize> {
    /// Where; the first `dim` coordinates count.
    pub x: [R; D],
    /// Its cost; infinite until it is known.
    pub cost: R,
}

impl<R: Real, const D: usize> Candidate<R, D> {
    /// Of zeros, before a search begins.
    const EMPTY: Self = Candidate {
        x: [R::ZERO; D],
        cost: R::ZERO,
    };

    fn unknown() -> Self {
        Candidate {
            x: [R::zero(); D],
            cost: R::from_f64(f64::INFINITY),
        }
    }

    /// Takes the place of `worse`. Out of line: of two candidates of one search a compiler cannot tell that they do not
    /// overlap, and would want a routine for that case too.
    #[inline(never)]
    fn replace(&self, worse: &mut Self) {
        *worse = *self;
    }
}

/// A search method. `ask` and `tell` alternate; within one generation, up to
/// [`batch`](Self::batch) points may be asked for before the first of them is told.
pub trait Optimiser<R: Real, const D: usize> {
    /// Number of unknowns, at most `D`.
    fn dim(&self) -> usize;
    /// How many points may be outstanding now.
    fn batch(&self) -> usize;
    /// The next point to evaluate.
    fn ask(&mut self) -> [R; D];
    /// Cost of the oldest point not yet told. NaN counts as infinite.
    fn tell(&mut self, cost: R);
    /// A cost above which the oldest point not yet told cannot matter: evaluation may stop there
    /// and tell any cost above it.
    fn bound(&self) -> R;
    /// The best point so far.
    fn best(&self) -> Candidate<R, D>;
}

/// NaN as infinity, so that a failed evaluation can never look good.
fn sanitised<R: Real>(cost: R) -> R {
    if cost.is_finite() {
        cost
    } else {
        R::from_f64(f64::INFINITY)
    }
}
