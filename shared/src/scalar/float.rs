//! f64 and f32 as [`Scalar`]s.
//!
//! f64 keeps the angle as one number. f32 keeps whole counts in an integer and the rest as a
//! fraction: as one number it would lose a count after a few revolutions.

use super::curves;
use super::{Angle, ErrorValue, Readable, Real, Scalar};
use micromath::F32;

/// Remainder for counts that the 32-bit counter has wrapped.
const WRAP: f64 = 4_294_967_296.0;

macro_rules! float_scalar {
    ($t:ty, $angle:ty, $exp:path, $ln:path, $sqrt:path, $approx:expr, $sincos:expr, $decay:expr, $bits:expr, $drawn:ty, $terms:expr) => {
        impl Scalar for $t {
            type Mask = bool;
            type Coefficient = $t;
            type Angle = $angle;
            const LIMIT: f64 = f64::INFINITY;

            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn from_q15(duty: i16) -> Self {
                duty as $t * (1.0 / 32_768.0)
            }
            #[inline(always)]
            fn coefficient(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn times(self, k: Self) -> Self {
                self * k
            }
            #[inline(always)]
            fn less(self, other: Self) -> bool {
                self < other
            }
            #[inline(always)]
            fn select(mask: bool, a: Self, b: Self) -> Self {
                if mask { a } else { b }
            }
            #[inline]
            fn sin_cos_turns(self) -> (Self, Self) {
                $sincos(self)
            }
            #[inline]
            fn part_of(self, whole: Self) -> Self {
                if whole > 0.0 {
                    <$t>::min(<$t>::max(self / whole, 0.0), 1.0)
                } else {
                    0.0
                }
            }
            #[inline]
            fn exp_decay(self) -> Self {
                $decay(self)
            }
        }

        impl Real for $t {
            const TERMS: u32 = $terms;
            const ZERO: Self = 0.0;

            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline]
            fn binary(self) -> (bool, i32, u64) {
                const FRACTION: u32 = <$t>::MANTISSA_DIGITS - 1;
                const LARGEST: u32 = (<$t>::MAX_EXP * 2 - 1) as u32;
                let bits = self.to_bits();
                let exponent = (bits >> FRACTION) as u32 & LARGEST;
                let fraction = bits & ((1 << FRACTION) - 1);
                let significand = (fraction as u64) << (52 - FRACTION) | 1 << 52;
                let exponent = if exponent == LARGEST {
                    1024
                } else {
                    exponent as i32 - (<$t>::MAX_EXP - 1)
                };
                (self.is_sign_negative(), exponent, significand)
            }
            fn exp(self) -> Self {
                $exp(self)
            }
            fn ln(self) -> Self {
                $ln(self)
            }
            fn sqrt(self) -> Self {
                $sqrt(self)
            }
            fn exp_approx(self) -> Self {
                $approx.0(self)
            }
            fn sin_turns_approx(self) -> Self {
                $approx.1(self)
            }
            #[inline(always)]
            fn is_finite(self) -> bool {
                <$t>::is_finite(self)
            }
            #[inline(always)]
            fn from_whole(x: u32) -> Self {
                x as $t
            }
            #[inline(always)]
            fn whole(self) -> u32 {
                self as u32
            }
            fn from_bits_uniform(bits: u64) -> Self {
                const BITS: u32 = $bits;
                (bits >> (64 - BITS)) as $drawn as $t / (1u64 << BITS) as $t
            }
        }

        impl ErrorValue for $t {
            #[inline(always)]
            fn from_f64(x: f64) -> Self {
                x as $t
            }
            #[inline(always)]
            fn to_f64(self) -> f64 {
                self as f64
            }
            #[inline(always)]
            fn abs(self) -> Self {
                <Self as Scalar>::abs(self)
            }
            #[inline(always)]
            fn squared(self) -> Self {
                self * self
            }
            #[inline(always)]
            fn floor(self) -> Self {
                libm::floor(self as f64) as $t
            }
        }
    };
}

float_scalar!(
    f64,
    f64,
    libm::exp,
    libm::log,
    libm::sqrt,
    (libm::exp, |turns: f64| curves::sin_cos_turns(turns).0),
    curves::sin_cos_turns,
    |x| curves::exp_decay(x, curves::power_of_two),
    53,
    u64,
    13
);
float_scalar!(
    f32,
    SplitAngle,
    libm::expf,
    libm::logf,
    libm::sqrtf,
    (
        |x: f32| F32(x).exp().0,
        |turns: f32| F32(turns * core::f32::consts::TAU).sin().0
    ),
    short_sin_cos,
    libm::expf,
    24,
    u32,
    7
);

/// In f32 a polynomial does: turns need no reduction by multiples of π, which is most of `libm::sincosf` and two kilobytes
/// of a microcontroller's flash.
fn short_sin_cos(turns: f32) -> (f32, f32) {
    (sin_turns(turns), sin_turns(turns + 0.25))
}

/// Sine of a fraction of a turn: the turn is folded to a quarter, and Taylor's series of `sin(π/2·x)` is summed there; the
/// last term left out is below 6e-8.
fn sin_turns(turns: f32) -> f32 {
    const SERIES: [f32; 6] = [
        -3.598_843_2e-6,
        1.604_411_8e-4,
        -4.681_754e-3,
        7.969_262_6e-2,
        -6.459_641e-1,
        core::f32::consts::FRAC_PI_2,
    ];
    let quarters = 4.0 * (turns - libm::floorf(turns + 0.5));
    let folded = if quarters > 1.0 {
        2.0 - quarters
    } else if quarters < -1.0 {
        -2.0 - quarters
    } else {
        quarters
    };
    let square = folded * folded;
    let sum = SERIES.iter().fold(0.0, |sum, term| sum * square + term);
    sum * folded
}

impl Angle<f64> for f64 {
    #[inline(always)]
    fn from_counts(counts: f64) -> Self {
        counts
    }
    #[inline(always)]
    fn advance(self, step: f64, counts_per_unit: f64) -> Self {
        self + step * counts_per_unit
    }
    #[inline]
    fn turns(self, counts_per_rev: u32) -> f64 {
        let turns = self / counts_per_rev as f64;
        turns - libm::floor(turns)
    }
}

impl Readable<f64> for f64 {
    type Error = f64;

    #[inline]
    fn floor(self) -> i32 {
        let whole = libm::floor(self);
        // `as` saturates: take the remainder first, as the counter does.
        (whole - WRAP * libm::floor(whole / WRAP)) as u32 as i32
    }
    #[inline(always)]
    fn minus(self, counts: i32) -> f64 {
        let difference = self - counts as f64;
        if libm::fabs(difference) < WRAP / 2.0 {
            difference
        } else {
            difference - WRAP * libm::floor(difference / WRAP + 0.5)
        }
    }
}

/// Whole counts and a fraction in `[0, 1)`, so that the sum of many small steps stays exact to
/// the last bits of one step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SplitAngle {
    whole: i32,
    fraction: f32,
}

impl Angle<f32> for SplitAngle {
    fn from_counts(counts: f64) -> Self {
        let whole = libm::floor(counts);
        SplitAngle {
            whole: <f64 as Readable<f64>>::floor(counts),
            fraction: (counts - whole) as f32,
        }
    }
    #[inline(always)]
    fn advance(self, step: f32, counts_per_unit: f32) -> Self {
        let sum = self.fraction + step * counts_per_unit;
        // `as` truncates towards zero, which one instruction does; then step down below zero.
        let mut whole = sum as i32;
        let mut fraction = sum - whole as f32;
        if fraction < 0.0 {
            fraction += 1.0;
            whole = whole.wrapping_sub(1);
        }
        SplitAngle {
            whole: self.whole.wrapping_add(whole),
            fraction,
        }
    }
    #[inline]
    fn turns(self, counts_per_rev: u32) -> f32 {
        let within = (self.whole as i64).rem_euclid(counts_per_rev as i64);
        (within as f32 + self.fraction) / counts_per_rev as f32
    }
}

impl Readable<f32> for SplitAngle {
    type Error = f32;

    #[inline(always)]
    fn floor(self) -> i32 {
        self.whole
    }
    #[inline(always)]
    fn minus(self, counts: i32) -> f32 {
        self.whole.wrapping_sub(counts) as f32 + self.fraction
    }
}

#[cfg(test)]
mod tests {
    use super::{Real, short_sin_cos};

    #[test]
    fn the_rough_functions_are_as_exact_as_they_promise() {
        for k in -4000..=4000 {
            let x = k as f32 * 1e-3;
            let exp = Real::exp_approx(x) / Real::exp(x) - 1.0;
            assert!(exp.abs() < 3e-3, "e^{x} is off by a part of {exp}");
            let sine = Real::sin_turns_approx(x) - short_sin_cos(x).0;
            assert!(sine.abs() < 2e-3, "the sine of {x} turns is off by {sine}");
        }
    }

    #[test]
    fn the_short_sine_is_as_exact_as_f32_allows() {
        for k in -4000..4000 {
            let turns = k as f32 / 1000.0;
            let (sin, cos) = short_sin_cos(turns);
            let angle = f64::from(turns) * core::f64::consts::TAU;
            assert!(
                (f64::from(sin) - angle.sin()).abs() < 4e-6,
                "{turns}: {sin}"
            );
            assert!(
                (f64::from(cos) - angle.cos()).abs() < 4e-6,
                "{turns}: {cos}"
            );
        }
    }
}
