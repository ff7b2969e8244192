//! Sine, cosine and exponential of 64-bit numbers out of sums and products alone: the same bits on every machine
//! and, since there is no branch in them, in the lanes of a vector as well.

use super::{Mask, Scalar};

/// Added to a number and taken away again, it leaves the nearest whole number: 1.5·2⁵².
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// `sin(πx/2)/x` in powers of `x²`, highest first: Taylor's series, whose rest for `|x| ≤ ½` is below 1e-16.
const SINE: [f64; 8] = [
    -6.688_035_109_811_468e-10,
    5.692_172_921_967_927e-8,
    -3.598_843_235_212_085e-6,
    1.604_411_847_873_598_3e-4,
    -4.681_754_135_318_688e-3,
    7.969_262_624_616_705e-2,
    -0.645_964_097_506_246_3,
    core::f64::consts::FRAC_PI_2,
];

/// `cos(πx/2)` in powers of `x²`, highest first.
const COSINE: [f64; 9] = [
    6.565_963_114_979_473e-11,
    -6.386_603_083_791_852e-9,
    4.710_874_778_818_172e-7,
    -2.520_204_237_306_060_7e-5,
    9.192_602_748_394_266e-4,
    -2.086_348_076_335_296e-2,
    0.253_669_507_901_048_03,
    -1.233_700_550_136_169_7,
    1.0,
];

/// `e^x` in powers of `x`, highest first, for `|x| ≤ ln(2)/2`.
const EXPONENTIAL: [f64; 14] = [
    1.605_904_383_682_161_3e-10,
    2.087_675_698_786_81e-9,
    2.505_210_838_544_172e-8,
    2.755_731_922_398_589e-7,
    2.755_731_922_398_589_3e-6,
    2.480_158_730_158_73e-5,
    1.984_126_984_126_984e-4,
    1.388_888_888_888_889e-3,
    8.333_333_333_333_333e-3,
    4.166_666_666_666_666_4e-2,
    0.166_666_666_666_666_66,
    0.5,
    1.0,
    1.0,
];

/// `ln 2` in two parts, the first of which has few digits: whole multiples of it are exact.
const LN_2: (f64, f64) = (0.693_146_705_627_441_4, 4.749_325_039_031_672_6e-7);

/// Smaller exponents give what this one gives, 1e-304.
const LEAST_EXPONENT: f64 = -700.0;

/// Sine and cosine of an angle given as a fraction of a turn.
#[inline(always)]
pub fn sin_cos_turns<S: Scalar>(turns: S) -> (S, S) {
    let number = |constant| turns.like(constant);
    let quarters = turns * number(4.0);
    let whole = rounded(quarters);
    let rest = quarters - whole;
    // −2 to 2.
    let quarter = whole - rounded(whole * number(0.25)) * number(4.0);
    let square = rest * rest;
    let sine = polynomial(&SINE, square) * rest;
    let cosine = polynomial(&COSINE, square);
    let side = quarter.abs();
    let beside = number(0.5).less(side).and(side.less(number(1.5)));
    let behind = number(1.5).less(side);
    let (up, ahead) = (
        S::select(beside, cosine, sine),
        S::select(beside, sine, cosine),
    );
    let down = behind.or(quarter.less(number(-0.5)));
    let back = behind.or(number(0.5).less(quarter));
    (S::select(down, -up, up), S::select(back, -ahead, ahead))
}

/// `e^x` for `x ≤ 0`, with `power_of_two` made of `k + 1.5·2⁵² + 1023` for a whole `k`.
#[inline(always)]
pub fn exp_decay<S: Scalar>(x: S, power_of_two: impl Fn(S) -> S) -> S {
    let number = |constant| x.like(constant);
    let x = x.max(number(LEAST_EXPONENT));
    let doublings = rounded(x * number(core::f64::consts::LOG2_E));
    let rest = x - doublings * number(LN_2.0) - doublings * number(LN_2.1);
    let scale = power_of_two(doublings + number(ROUNDER + 1023.0));
    polynomial(&EXPONENTIAL, rest) * scale
}

/// Two to the power `k`, of `k + 1.5·2⁵² + 1023`: its lowest bits are the exponent's.
#[inline(always)]
pub fn power_of_two(shifted: f64) -> f64 {
    f64::from_bits(shifted.to_bits() << 52)
}

#[inline(always)]
fn rounded<S: Scalar>(x: S) -> S {
    (x + x.like(ROUNDER)) - x.like(ROUNDER)
}

/// A polynomial by its coefficients, the highest first.
#[inline(always)]
pub fn polynomial<S: Scalar>(terms: &[f64], x: S) -> S {
    let Some((first, others)) = terms.split_first() else {
        return S::zero();
    };
    let mut sum = x.like(*first);
    for term in others {
        sum = sum * x + x.like(*term);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_are_those_of_the_library_at_every_angle() {
        for k in -100_000..100_000 {
            let turns = f64::from(k) * 1.234_5e-4;
            let (sine, cosine) = sin_cos_turns(turns);
            let within = turns - libm::floor(turns);
            let (s, c) = libm::sincos(within * core::f64::consts::TAU);
            let off = (sine - s).abs().max((cosine - c).abs());
            assert!(off < 4e-15, "{off} at {turns} turns");
        }
        for (turns, sine, cosine) in [
            (0.0, 0.0, 1.0),
            (0.25, 1.0, 0.0),
            (0.5, 0.0, -1.0),
            (0.75, -1.0, 0.0),
        ] {
            assert_eq!(sin_cos_turns(turns), (sine, cosine), "{turns} turns");
        }
    }

    #[test]
    fn the_exponential_is_that_of_the_library() {
        for k in 0..100_000 {
            let x = -f64::from(k) * 6.9e-3;
            let (own, library) = (exp_decay(x, power_of_two), libm::exp(x));
            let off = (own / library - 1.0).abs();
            assert!(off < 4e-16, "{off} at {x}");
        }
        assert_eq!(exp_decay(0.0, power_of_two), 1.0);
    }
}
