//! Powers of a number between zero and one: brought to between one half and one by doublings, then by a series.

use super::number::Number;
use crate::scalar::Scalar;
use core::f64::consts::PI;

/// Numbers that a power needs: what is left of one by each of the [`DOUBLINGS`], and the terms of the series.
pub(super) const NUMBERS: usize = DOUBLINGS.len() + TERMS;

/// Doublings that bring a number near one; together they reach down to 2⁻³².
const DOUBLINGS: [i32; 5] = [16, 8, 4, 2, 1];

/// Terms of the Chebyshev series over ½ to 1. Its singularity at zero makes each of them 5.8 times smaller than the one before:
/// 4e-9 are left out.
const TERMS: usize = 11;

/// The numbers of a power `p`, which is not negative.
pub(super) fn numbers(p: f64) -> [f64; NUMBERS] {
    let mut numbers = [0.0; NUMBERS];
    let (lost, terms) = numbers.split_at_mut(DOUBLINGS.len());
    for (lost, doublings) in lost.iter_mut().zip(DOUBLINGS) {
        *lost = libm::exp2(-p * f64::from(doublings));
    }
    for (k, term) in terms.iter_mut().enumerate() {
        let mut sum = 0.0;
        for j in 0..TERMS {
            let angle = PI * (j as f64 + 0.5) / TERMS as f64;
            let x = 0.75 + 0.25 * libm::cos(angle);
            sum += libm::pow(x, p) * libm::cos(k as f64 * angle);
        }
        let whole = if k == 0 { 1.0 } else { 2.0 };
        *term = sum * whole / TERMS as f64;
    }
    numbers
}

/// The power of a number from 0 to 1.
#[inline(always)]
fn at<S: Scalar>(x: S, numbers: &[S::Coefficient]) -> S {
    let (lost, terms) = numbers.split_at(DOUBLINGS.len());
    let one = S::one();
    let nothing = x.less(S::from_f64(NOTHING));
    let (mut x, mut left) = (x, one);
    for (doublings, lost) in DOUBLINGS.into_iter().zip(lost) {
        let doubled = f64::from(1u32 << doublings);
        let small = x.less(S::from_f64(1.0 / doubled));
        x = S::select(small, x.times(S::coefficient(doubled)), x);
        left = S::select(small, left.times(*lost), left);
    }
    // ½ to 1 becomes −1 to 1; Clenshaw's recurrence.
    let y = x.times(S::coefficient(4.0)) - S::from_f64(3.0);
    let twice = y + y;
    let (mut next, mut after) = (S::zero(), S::zero());
    for term in terms[1..].iter().rev() {
        (next, after) = (twice * next + (one.times(*term) - after), next);
    }
    let power = (y * next + (one.times(terms[0]) - after)) * left;
    S::select(nothing, S::zero(), power)
}

/// Below this the power of a number is that of nothing.
const NOTHING: f64 = 1.0 / 4_294_967_296.0;

/// The power of a number or of a number with derivatives. At nothing, where the slope of a root has no bound, it is that a little off.
#[inline(always)]
pub(super) fn raised<S: Scalar, N: Number<S>>(
    x: N,
    exponent: S::Coefficient,
    numbers: &[S::Coefficient],
) -> N {
    const NEAR: f64 = 1.0 / 1024.0;
    let value = x.value();
    let power = at::<S>(value, numbers);
    x.map(
        power,
        #[inline(always)]
        || {
            let near = S::from_f64(NEAR);
            let inverse = near
                .part_of(value.max(near))
                .times(S::coefficient(1.0 / NEAR));
            (power * inverse).times(exponent)
        },
    )
}
