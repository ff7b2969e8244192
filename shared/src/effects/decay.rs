//! Exponentials that reach further than a fixed-point number.

use crate::scalar::Scalar;

/// Where a [`decay`] ends: at `e` to the minus four times this, 7e-13.
pub(super) const REACH: f64 = 7.0;

/// `e^(−4·quarter)` for `0 ≤ quarter ≤ REACH`. An exponent of 28 does not fit fixed point, its
/// quarter does.
#[inline(always)]
pub(super) fn decay<S: Scalar>(quarter: S) -> S {
    let root = (-quarter).exp_decay();
    let square = root * root;
    square * square
}
