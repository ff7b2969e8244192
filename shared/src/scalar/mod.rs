//! The number that a model is computed in.
//!
//! The equations are written once, over [`Scalar`]. Three things set it apart from "a float":
//!
//! * multipliers are a type of their own ([`Scalar::Coefficient`]), so that a fixed-point number can
//!   keep 31 significant bits in a coefficient of any size;
//! * the shaft angle is a type of its own ([`Angle`]), wide enough not to lose low bits over an hour;
//! * comparisons give a [`Mask`] and choices are [`Scalar::select`], so that a SIMD lane type, where
//!   every lane is another candidate, can be a `Scalar` too.

pub mod curves;
mod fixed;
mod float;
mod lanes;
mod mask;

pub(crate) use fixed::product;
pub use fixed::{Fixed, FixedCoefficient};
pub(crate) use lanes::lanes;
pub use lanes::{FromLanes, parts};
pub use mask::Mask;

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A signed number near one: voltages, speeds and torques per unit.
pub trait Scalar:
    Copy
    + Default
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Mul<Output = Self>
{
    /// Result of a comparison.
    type Mask: Mask;
    /// A multiplier that is fixed for the life of a model; zero by default.
    type Coefficient: Copy + Default + Debug;
    /// The shaft angle in encoder counts.
    type Angle: Angle<Self>;
    /// Magnitudes below this are represented; infinity for floats.
    const LIMIT: f64;

    /// The nearest representable number; saturates at [`LIMIT`](Self::LIMIT).
    fn from_f64(x: f64) -> Self;
    /// A constant beside this number. In lanes, the number vouches for the instructions that make it.
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Self::from_f64(x)
    }
    /// A multiplier of any size from 2⁻³⁰ to 2³⁰ in magnitude, or nearly zero.
    fn coefficient(x: f64) -> Self::Coefficient;
    /// [`from_f64`](Self::from_f64) of another format's number.
    #[inline(always)]
    fn of<R: Real>(x: R) -> Self {
        Self::from_f64(x.to_f64())
    }
    /// [`coefficient`](Self::coefficient) of another format's number.
    #[inline(always)]
    fn coefficient_of<R: Real>(x: R) -> Self::Coefficient {
        Self::coefficient(x.to_f64())
    }
    /// `self · k`.
    fn times(self, k: Self::Coefficient) -> Self;
    /// `self < other`.
    fn less(self, other: Self) -> Self::Mask;
    /// `a` where the mask is set, else `b`.
    fn select(mask: Self::Mask, a: Self, b: Self) -> Self;
    /// Sine and cosine of an angle given as a fraction of a turn.
    fn sin_cos_turns(self) -> (Self, Self);
    /// `self / whole` for `0 ≤ self ≤ whole`: a part in `[0, 1]`, zero of nothing.
    fn part_of(self, whole: Self) -> Self;
    /// `e` to the power `self`, for `self ≤ 0`.
    fn exp_decay(self) -> Self;

    /// A duty in Q15, as a part of one.
    fn from_q15(duty: i16) -> Self {
        Self::from_f64(f64::from(duty) * (1.0 / 32_768.0))
    }
    /// Computes what is long and needed in several places. A number that is computed with instructions which
    /// the rest of the program must do without makes it a routine of its own that has them too.
    #[inline(always)]
    fn routine<A>(mut body: impl FnMut() -> A) -> A {
        body()
    }

    /// Zero.
    #[inline(always)]
    fn zero() -> Self {
        Self::default()
    }
    /// One.
    #[inline(always)]
    fn one() -> Self {
        Self::from_f64(1.0)
    }
    /// Magnitude.
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.less(Self::zero()), -self, self)
    }
    /// The smaller of two.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(other.less(self), other, self)
    }
    /// The larger of two.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(self.less(other), other, self)
    }
    /// −1, 0 or 1.
    #[inline(always)]
    fn signum(self) -> Self {
        let (one, zero) = (Self::one(), Self::zero());
        Self::select(
            self.less(zero),
            -one,
            Self::select(zero.less(self), one, zero),
        )
    }
}

/// Shaft angle in encoder counts, kept so that it never loses low bits.
pub trait Angle<S: Scalar>: Copy + Default + Debug {
    /// From a number of counts.
    fn from_counts(counts: f64) -> Self;
    /// Adds `step · counts_per_unit` counts.
    fn advance(self, step: S, counts_per_unit: S::Coefficient) -> Self;
    /// Position within a revolution, as a fraction of a turn in `[0, 1)`.
    fn turns(self, counts_per_rev: u32) -> S;
}

/// An angle that an encoder can read. Of several candidates side by side there is no one reading.
pub trait Readable<S: Scalar>: Angle<S> {
    /// A difference of angles in counts, the stuff of which costs are summed.
    type Error: ErrorValue;
    /// The encoder's reading: rounded down, and wrapped like its 32-bit counter.
    fn floor(self) -> i32;
    /// `self − counts`, by way of the shorter way round the 32-bit counter.
    fn minus(self, counts: i32) -> Self::Error;
}

/// An angle error in counts.
pub trait ErrorValue: Copy + Default + Debug + PartialOrd + Add<Output = Self> {
    /// From a number of counts; saturates.
    fn from_f64(x: f64) -> Self;
    /// In counts.
    fn to_f64(self) -> f64;
    /// Magnitude.
    fn abs(self) -> Self;
    /// Square; saturates in fixed point beyond 2¹⁵ counts.
    fn squared(self) -> Self;
    /// Rounded down to whole counts.
    fn floor(self) -> Self;
}

/// A floating-point [`Scalar`] with the functions that set-up code needs (never the hot loop).
/// All of them come from `libm`, or from `micromath` where a rough value does, so that the PC and the MCU get the same bits.
pub trait Real:
    Scalar<Coefficient = Self, Mask = bool, Angle: Readable<Self>> + PartialOrd + Div<Output = Self>
{
    /// Terms of a Taylor series in matrices of norm up to ¼ after which the rest is below the format's last digit.
    const TERMS: u32;
    /// Zero, for what begins as zeros.
    const ZERO: Self;

    /// As f64, exactly.
    fn to_f64(self) -> f64;
    /// Whether it is negative, and `|self| = significand · 2^(exponent − 52)` with 53 bits of significand; the exponent is 1024 of
    /// what is not finite, and below −126 of what is nearly nothing.
    fn binary(self) -> (bool, i32, u64);
    /// Natural exponential.
    fn exp(self) -> Self;
    /// Natural logarithm.
    fn ln(self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Natural exponential, in f32 to three parts in a thousand only: for what steers a search, never for a model or a cost.
    fn exp_approx(self) -> Self;
    /// Sine of a fraction of a turn, in f32 to 0.002 only: for a command that is recorded as it was played.
    fn sin_turns_approx(self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// A whole number, rounded to the format.
    fn from_whole(x: u32) -> Self;
    /// The whole part; saturates, so that there is none of what is below zero.
    fn whole(self) -> u32;
    /// A uniform number in `[0, 1)` from 64 random bits, with as many of them as fit.
    fn from_bits_uniform(bits: u64) -> Self;
}
