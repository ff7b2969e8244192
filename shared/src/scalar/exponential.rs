//! Exponential and logarithm in single precision, for set-up code: a third of the flash that `libm`'s take, and within three
//! units of the last place, which is what f32 makes of their arguments anyway.

use core::f32::consts::{LOG2_E, SQRT_2};

/// `e^x` in powers of `x`, highest first, for `|x| ≤ ln(2)/2`: Taylor's series, whose rest is below 1e-8.
const EXPONENTIAL: [f32; 8] = [
    1.0 / 5040.0,
    1.0 / 720.0,
    1.0 / 120.0,
    1.0 / 24.0,
    1.0 / 6.0,
    0.5,
    1.0,
    1.0,
];

/// `atanh(s)/s` in powers of `s²`, highest first, for `s` up to 0.172: the rest is below 1e-9.
const AREA_TANGENT: [f32; 5] = [1.0 / 9.0, 1.0 / 7.0, 0.2, 1.0 / 3.0, 1.0];

/// The upper bits of ln 2, whose product with a whole number below 2⁸ is exact; and the rest of it.
const UPPER_LN_2: f32 = 0.693_145_75;
const LOWER_LN_2: f32 = 1.428_606_8e-6;

/// `e^x`; zero where that is below 2⁻¹²⁶.
pub fn exp(x: f32) -> f32 {
    if x > 88.7 {
        return f32::INFINITY;
    }
    // `as` rounds towards zero.
    let doublings = (x * LOG2_E + if x < 0.0 { -0.5 } else { 0.5 }) as i32;
    if doublings < -126 {
        return 0.0;
    }
    let whole = doublings as f32;
    let rest = x - whole * UPPER_LN_2 - whole * LOWER_LN_2;
    // In two factors: 2¹²⁸ is no number, but what it is multiplied by is below one there.
    let half = doublings >> 1;
    polynomial(&EXPONENTIAL, rest) * power_of_two(half) * power_of_two(doublings - half)
}

/// Natural logarithm; NaN below zero.
pub fn ln(x: f32) -> f32 {
    if x == 0.0 {
        return f32::NEG_INFINITY;
    }
    if x.is_nan() || x < 0.0 {
        return f32::NAN;
    }
    if x == f32::INFINITY {
        return x;
    }
    // Below 2⁻¹²⁶ numbers have fewer bits than others.
    let (x, lifted) = if x < f32::MIN_POSITIVE {
        (x * 16_777_216.0, 24)
    } else {
        (x, 0)
    };
    let mut doublings = (x.to_bits() >> 23).cast_signed() - 127 - lifted;
    let mut significand = f32::from_bits((x.to_bits() & 0x7f_ffff) | 1.0f32.to_bits());
    if significand > SQRT_2 {
        significand *= 0.5;
        doublings += 1;
    }
    // ln(m) = 2·atanh((m − 1)/(m + 1))
    let s = (significand - 1.0) / (significand + 1.0);
    let whole = doublings as f32;
    whole * UPPER_LN_2 + (2.0 * s * polynomial(&AREA_TANGENT, s * s) + whole * LOWER_LN_2)
}

fn power_of_two(exponent: i32) -> f32 {
    f32::from_bits((exponent + 127).cast_unsigned() << 23)
}

fn polynomial(terms: &[f32], x: f32) -> f32 {
    terms.iter().fold(0.0, |sum, term| sum * x + term)
}

#[cfg(test)]
mod tests {
    use super::{exp, ln};

    /// Difference in units of the last place.
    fn places(own: f32, exact: f64) -> f64 {
        let next = f32::from_bits((exact as f32).to_bits() + 1);
        (f64::from(own) - exact).abs() / (f64::from(next) - f64::from(exact as f32)).abs()
    }

    #[test]
    fn the_exponential_is_within_two_places() {
        for k in -872_000..887_000 {
            let x = k as f32 * 1e-4;
            let off = places(exp(x), f64::from(x).exp());
            assert!(off < 2.0, "e^{x} = {}: {off} places", exp(x));
        }
        assert_eq!(exp(0.0), 1.0);
        assert_eq!(exp(-1000.0), 0.0);
        assert_eq!(exp(f32::NEG_INFINITY), 0.0);
        assert_eq!(exp(89.0), f32::INFINITY);
        assert!(exp(f32::NAN).is_nan());
    }

    #[test]
    fn the_logarithm_is_within_three_places() {
        // Every thousandth number.
        for bits in (1..f32::INFINITY.to_bits()).step_by(1000) {
            let x = f32::from_bits(bits);
            let off = places(ln(x), f64::from(x).ln());
            assert!(off < 3.0, "ln {x} = {}: {off} places", ln(x));
        }
        assert_eq!(ln(1.0), 0.0);
        assert_eq!(ln(f32::INFINITY), f32::INFINITY);
        assert_eq!(ln(0.0), f32::NEG_INFINITY);
        assert_eq!(exp(ln(0.0)), 0.0);
        assert!(ln(-1.0).is_nan() && ln(f32::NAN).is_nan());
    }
}
