//! The hyperbolic tangent out of sums, products and quotients alone: number formats have no other functions, and in fixed point
//! an exponential keeps too few digits.

use crate::scalar::Scalar;
use crate::scalar::curves::polynomial;

/// `tanh(x)/x` as a quotient of polynomials in `x²`, the fourth approximant of its continued
/// fraction (Lambert): off by less than 2e-6 up to `x = 2.45`, highest powers first.
const ABOVE: [f64; 3] = [21.0 / 10_395.0, 1_260.0 / 10_395.0, 1.0];
const BELOW: [f64; 4] = [1.0 / 10_395.0, 210.0 / 10_395.0, 4_725.0 / 10_395.0, 1.0];

/// `tanh(x)/x`, of `x²` up to 6.
#[inline(always)]
pub(super) fn tanh_share<S: Scalar>(square: S) -> S {
    polynomial(&ABOVE, square).part_of(polynomial(&BELOW, square))
}

/// `tanh(x)` for `0 ≤ x ≤ 7`, by twice `tanh 2x = 2·tanh x/(1 + tanh² x)`: off by less than 1e-8.
#[inline(always)]
pub(super) fn tanh<S: Scalar>(x: S) -> S {
    let quarter = x.times(S::coefficient(0.25));
    doubled(doubled(quarter * tanh_share(quarter * quarter)))
}

/// `tanh(2x)` of `tanh(x)`.
#[inline(always)]
fn doubled<S: Scalar>(t: S) -> S {
    (t + t).part_of(S::from_f64(1.0) + t * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scalar::Fixed;

    fn furthest<S: Scalar>(to_f64: impl Fn(S) -> f64) -> f64 {
        (0..=7000)
            .map(|k| f64::from(k) / 1000.0)
            .map(|x| (to_f64(tanh(S::from_f64(x))) - libm::tanh(x)).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn is_the_tangent_in_every_format() {
        let off = [
            furthest::<f64>(|x| x),
            furthest::<f32>(f64::from),
            furthest::<Fixed>(Fixed::to_f64),
        ];
        assert!(off[0] < 1e-8 && off[1] < 3e-7 && off[2] < 1e-8, "{off:?}");
    }
}
