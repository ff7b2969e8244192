//! Fixed point for cores without a floating-point unit.
//!
//! A [`Fixed`] is 64 bits with 60 below the point: it holds magnitudes below 8 per unit. Products
//! read only the rounded upper 32 bits of it (28 below the point), one 32 × 32 → 64 multiplication
//! each; sums keep all 64. So a slow motor's small increments are never rounded away, which is what
//! makes plain 32-bit fixed point drift.
//!
//! A multiplier keeps 31 significant bits whatever its size: a mantissa and a shift.

use super::{Angle, ErrorValue, Readable, Real, Scalar};
use core::ops::{Add, Mul, Neg, Sub};

/// Bits below the point.
const POINT: u32 = 60;
/// Bits below the point in the upper word, which products read.
const UPPER_POINT: u32 = POINT - 32;

/// A number of magnitude below 8 with 60 bits below the point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fixed(i64);

/// A multiplier: `mantissa · 2^(−shift)`, the mantissa normalised to 31 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedCoefficient {
    mantissa: i32,
    shift: i32,
}

/// Largest shift of a multiplier; anything smaller than 2⁻³⁰ in magnitude gradually loses bits.
const MAX_SHIFT: i32 = 61;

impl FixedCoefficient {
    /// Nothing.
    pub const ZERO: Self = FixedCoefficient {
        mantissa: 0,
        shift: 0,
    };

    /// As a whole number with so many bits below the point, rounded; none if that is beyond 31 bits.
    pub fn mantissa(self, bits: i32) -> Option<i32> {
        i32::try_from(shifted(self.mantissa.into(), self.shift - bits)).ok()
    }

    /// Most bits below the point for which there is a [`mantissa`](Self::mantissa).
    pub fn room(self) -> i32 {
        if self.mantissa == 0 { 60 } else { self.shift }
    }

    /// The product with another multiplier.
    pub fn by(self, other: Self) -> Self {
        FixedCoefficient {
            mantissa: shifted(i64::from(self.mantissa) * i64::from(other.mantissa), 31) as i32,
            shift: self.shift + other.shift - 31,
        }
    }
}

impl Fixed {
    /// From its bits, of which 60 are below the point.
    #[inline(always)]
    pub const fn from_bits(bits: i64) -> Self {
        Fixed(bits)
    }

    /// The upper word, rounded down: 28 bits below the point.
    #[inline(always)]
    pub fn word(self) -> i32 {
        (self.0 >> 32) as i32
    }

    /// The upper word, rounded to nearest.
    #[inline(always)]
    fn upper(self) -> i32 {
        (self.0.wrapping_add(1 << 31) >> 32) as i32
    }

    /// As a float, for reports and tests.
    pub fn to_f64(self) -> f64 {
        self.0 as f64 / (1u64 << POINT) as f64
    }
}

/// `value · 2^(−shift)`, rounded to nearest, for shifts of either sign.
#[inline(always)]
fn shifted(value: i64, shift: i32) -> i64 {
    if shift <= 0 {
        value << (-shift).min(63)
    } else {
        let shift = shift.min(63);
        (value >> (shift - 1)).wrapping_add(1) >> 1
    }
}

/// The upper word times the mantissa, scaled by `2^(−shift)`.
#[inline(always)]
fn scaled(upper: i32, mantissa: i32, shift: i32) -> i64 {
    shifted(product(upper, mantissa), shift)
}

/// The product, with all its bits.
#[cfg(not(short_multiplier))]
#[inline(always)]
pub(crate) fn product(a: i32, b: i32) -> i64 {
    i64::from(a) * i64::from(b)
}

/// The product, with all its bits, where the core multiplies to 32 bits only: the compiler would call a routine for 64 by 64
/// bits, with which a sample of a linear motor takes 556 instructions on an M0 instead of 286, of one with friction 818 instead
/// of 510.
#[cfg(short_multiplier)]
#[inline(always)]
pub(crate) fn product(a: i32, b: i32) -> i64 {
    let (a_low, a_high) = (a & 0xffff, a >> 16);
    let (b_low, b_high) = (b & 0xffff, b >> 16);
    let low = (a_low as u32).wrapping_mul(b_low as u32);
    let high = a_high.wrapping_mul(b_high);
    let cross = i64::from(a_high.wrapping_mul(b_low)) + i64::from(b_high.wrapping_mul(a_low));
    ((i64::from(high) << 32) | i64::from(low)).wrapping_add(cross << 16)
}

/// As `(x · 2⁶⁰) as i64` saturates, gives zero for NaN and drops what is below the last bit. Only the bits of a float are
/// read: small cores are spared the routines for its arithmetic.
#[inline(never)]
fn from_binary((negative, exponent, significand): (bool, i32, u64)) -> Fixed {
    let magnitude = match exponent + POINT as i32 - 52 {
        _ if exponent == 1024 && significand != 1 << 52 => 0,
        left @ 0..11 => (significand << left) as i64,
        right @ ..0 => (significand >> (-right).min(63)) as i64,
        _ if negative => i64::MIN,
        _ => i64::MAX,
    };
    Fixed(if negative {
        magnitude.wrapping_neg()
    } else {
        magnitude
    })
}

#[inline(never)]
fn coefficient((negative, exponent, significand): (bool, i32, u64)) -> FixedCoefficient {
    if !(30 - MAX_SHIFT..=30).contains(&exponent) {
        return FixedCoefficient::default();
    }
    // 53 bits to 31 (value in [2³⁰, 2³¹)), rounded; a carry to 2³¹ is clipped by one part in 2³¹.
    let rounded = ((significand >> 21) + 1) >> 1;
    let magnitude = rounded.min(i32::MAX as u64) as i32;
    FixedCoefficient {
        mantissa: if negative { -magnitude } else { magnitude },
        shift: 30 - exponent,
    }
}

impl Add for Fixed {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Fixed(self.0.wrapping_add(other.0))
    }
}

impl Sub for Fixed {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Fixed(self.0.wrapping_sub(other.0))
    }
}

impl Neg for Fixed {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Fixed(self.0.wrapping_neg())
    }
}

impl Mul for Fixed {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let shift = 2 * UPPER_POINT as i32 - POINT as i32;
        Fixed(scaled(self.upper(), other.upper(), shift))
    }
}

impl Scalar for Fixed {
    type Mask = bool;
    type Coefficient = FixedCoefficient;
    type Angle = FixedAngle;
    const LIMIT: f64 = 8.0;

    #[inline]
    fn from_f64(x: f64) -> Self {
        from_binary(x.binary())
    }

    #[inline]
    fn of<R: Real>(x: R) -> Self {
        from_binary(x.binary())
    }

    #[inline(always)]
    fn one() -> Self {
        Fixed(1 << POINT)
    }

    #[inline(always)]
    fn from_q15(duty: i16) -> Self {
        Fixed(i64::from(duty) << (POINT - 15))
    }

    #[inline]
    fn coefficient(x: f64) -> FixedCoefficient {
        coefficient(x.binary())
    }

    #[inline]
    fn coefficient_of<R: Real>(x: R) -> FixedCoefficient {
        coefficient(x.binary())
    }

    #[inline(always)]
    fn times(self, k: FixedCoefficient) -> Self {
        Fixed(scaled(
            self.upper(),
            k.mantissa,
            k.shift - (POINT - UPPER_POINT) as i32,
        ))
    }

    #[inline(always)]
    fn less(self, other: Self) -> bool {
        self.0 < other.0
    }

    #[inline(always)]
    fn select(mask: bool, a: Self, b: Self) -> Self {
        if mask { a } else { b }
    }

    fn sin_cos_turns(self) -> (Self, Self) {
        (
            sin_turns(self.0),
            sin_turns(self.0.wrapping_add(1 << (POINT - 2))),
        )
    }

    fn part_of(self, whole: Self) -> Self {
        // Both are far from the top of their range here: 31 more bits fit before the division.
        let (part, whole) = (self.0 >> 29, whole.0 >> 29);
        if whole <= 0 {
            return Fixed(0);
        }
        let part = part.clamp(0, whole).cast_unsigned() << 29;
        Fixed((part / whole.cast_unsigned()).cast_signed() << (POINT - 29))
    }

    fn exp_decay(self) -> Self {
        // e^x = (e^(x/256))^256: the series is short there, and squaring is exact enough.
        let x = Fixed(self.0.clamp(-(7 << POINT), 0) >> 8);
        let one = Fixed(1 << POINT);
        let half = Fixed(1 << (POINT - 1));
        let mut y = one + x + x * x * half;
        for _ in 0..8 {
            y = y * y;
        }
        y
    }
}

/// Sine of a fraction of a turn: the turn is folded to a quarter and a polynomial does the rest.
fn sin_turns(raw: i64) -> Fixed {
    // The fraction of a turn, as a signed number of quarter turns in [-2, 2).
    let quarters = Fixed((raw << (64 - POINT)) >> 2);
    let two = Fixed(2 << POINT);
    let one = Fixed(1 << POINT);
    // sin(π − a) = sin(a)
    let folded = if one < quarters {
        two - quarters
    } else if quarters < -one {
        -two - quarters
    } else {
        quarters
    };
    let square = folded * folded;
    // Taylor series of sin(π/2 · x); the last term left out is below 6e-8 on [-1, 1].
    const SERIES: [f64; 6] = [
        -3.598843235212085e-6,
        1.6044118478735982e-4,
        -4.681754135318687e-3,
        7.969262624616704e-2,
        -6.459640975062462e-1,
        core::f64::consts::FRAC_PI_2,
    ];
    let mut sum = Fixed::zero();
    for term in SERIES {
        sum = sum * square + Fixed::from_f64(term);
    }
    sum * folded
}

/// Counts with 32 bits below the point; wraps like the encoder's counter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FixedAngle(i64);

impl FixedAngle {
    /// Counts, with 32 bits below the point.
    #[inline(always)]
    pub fn bits(self) -> i64 {
        self.0
    }
}

impl Angle<Fixed> for FixedAngle {
    fn from_counts(counts: f64) -> Self {
        let whole = libm::floor(counts);
        let fraction = ((counts - whole) * 4_294_967_296.0) as i64;
        FixedAngle(
            ((<f64 as Readable<f64>>::floor(counts) as i64) << 32) | fraction.min(u32::MAX as i64),
        )
    }
    #[inline(always)]
    fn advance(self, step: Fixed, counts_per_unit: FixedCoefficient) -> Self {
        FixedAngle(self.0.wrapping_add(scaled(
            step.upper(),
            counts_per_unit.mantissa,
            counts_per_unit.shift - (32 - UPPER_POINT) as i32,
        )))
    }
    fn turns(self, counts_per_rev: u32) -> Fixed {
        let within = (self.0 >> 32).rem_euclid(counts_per_rev as i64) as u64;
        // within + fraction, as a fraction of a turn with 60 bits below the point.
        let fraction = self.0 as u32 as u64;
        let rest = ((within << 32) | fraction) / counts_per_rev as u64;
        Fixed((rest << (POINT - 32)) as i64)
    }
}

impl Readable<Fixed> for FixedAngle {
    type Error = FixedError;

    #[inline(always)]
    fn floor(self) -> i32 {
        (self.0 >> 32) as i32
    }
    #[inline(always)]
    fn minus(self, counts: i32) -> FixedError {
        FixedError(self.0.wrapping_sub((counts as i64) << 32) >> 16)
    }
}

/// Counts with 16 bits below the point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct FixedError(i64);

impl Add for FixedError {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        FixedError(self.0.saturating_add(other.0))
    }
}

impl ErrorValue for FixedError {
    fn from_f64(x: f64) -> Self {
        FixedError((x * 65_536.0) as i64)
    }
    fn to_f64(self) -> f64 {
        self.0 as f64 / 65_536.0
    }
    #[inline(always)]
    fn abs(self) -> Self {
        FixedError(self.0.saturating_abs())
    }
    #[inline(always)]
    fn squared(self) -> Self {
        let limited = self.0.clamp(-(1 << 31), 1 << 31);
        FixedError((limited * limited) >> 16)
    }
    #[inline(always)]
    fn floor(self) -> Self {
        FixedError(self.0 & !0xffff)
    }
}
