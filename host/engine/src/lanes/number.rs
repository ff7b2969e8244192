//! One number of several candidates, in the lanes of vector registers.

use super::token::Token;
use super::transpose::{LANES, Tile};
use bytemuck::cast;
use core::fmt::{self, Debug};
use core::ops::{Add, Mul, Neg, Sub};
use shared::scalar::{Angle, Mask, Scalar, curves};

/// One number of each of [`LANES`] candidates, in `M` registers of the processor `T`. Every operation gives each lane
/// the bits that [`f64`] gives.
#[derive(Clone, Copy)]
pub struct Lanes<T: Token, const M: usize> {
    registers: [T::f64s; M],
    token: T,
}

/// A condition for each candidate.
#[derive(Clone, Copy)]
pub struct LaneMask<T: Token, const M: usize> {
    registers: [T::m64s; M],
    token: T,
}

impl<T: Token, const M: usize> Lanes<T, M> {
    /// The candidates' numbers.
    #[inline(always)]
    pub fn each(self) -> [f64; LANES] {
        cast(self.registers)
    }

    /// The candidates' numbers in lanes, with the token of `self`: [`From`] reads the static token each time.
    #[inline(always)]
    pub fn each_like(self, each: [f64; LANES]) -> Self {
        Lanes {
            registers: cast(each),
            token: self.token,
        }
    }

    /// Magnitudes; unlike [`abs`](Scalar::abs) the sign of zero is cleared too.
    #[inline(always)]
    pub fn magnitude(mut self) -> Self {
        for register in &mut self.registers {
            *register = self.token.abs_f64s(*register);
        }
        self
    }

    /// `self + a·b` with one rounding, as [`f64::mul_add`].
    #[inline(always)]
    pub fn plus_product(mut self, a: Self, b: Self) -> Self {
        for k in 0..M {
            self.registers[k] =
                self.token
                    .mul_add_f64s(a.registers[k], b.registers[k], self.registers[k]);
        }
        self
    }

    /// Rows with one number of each candidate into one row for each candidate, or back.
    #[inline(always)]
    pub fn transposed(rows: Tile) -> [Self; LANES] {
        let token = T::witness();
        let columns: [[T::f64s; M]; LANES] = cast(token.transposed(rows));
        let mut transposed = [Lanes {
            registers: columns[0],
            token,
        }; LANES];
        for (transposed, registers) in transposed.iter_mut().zip(columns) {
            transposed.registers = registers;
        }
        transposed
    }

    /// Each lane rounded down.
    #[inline(always)]
    pub fn floor(self) -> Self {
        self.each_by(
            #[inline(always)]
            |x| x.floor(),
        )
    }

    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(T, T::f64s, T::f64s) -> T::f64s) -> Self {
        for k in 0..M {
            self.registers[k] = f(self.token, self.registers[k], other.registers[k]);
        }
        self
    }

    #[inline(always)]
    fn each_by(self, f: impl Fn(f64) -> f64) -> Self {
        let mut each = self.each();
        for x in &mut each {
            *x = f(*x);
        }
        each.into()
    }
}

impl<T: Token, const M: usize> From<[f64; LANES]> for Lanes<T, M> {
    #[inline(always)]
    fn from(each: [f64; LANES]) -> Self {
        Lanes {
            registers: cast(each),
            token: T::witness(),
        }
    }
}

impl<T: Token, const M: usize> Default for Lanes<T, M> {
    #[inline(always)]
    fn default() -> Self {
        Lanes::from_f64(0.0)
    }
}

impl<T: Token, const M: usize> Debug for Lanes<T, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.each().fmt(f)
    }
}

impl<T: Token, const M: usize> Add for Lanes<T, M> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.add_f64s(a, b),
        )
    }
}

impl<T: Token, const M: usize> Sub for Lanes<T, M> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.sub_f64s(a, b),
        )
    }
}

impl<T: Token, const M: usize> Mul for Lanes<T, M> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.mul_f64s(a, b),
        )
    }
}

impl<T: Token, const M: usize> Neg for Lanes<T, M> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for register in &mut self.registers {
            *register = self.token.neg_f64s(*register);
        }
        self
    }
}

impl<T: Token, const M: usize> LaneMask<T, M> {
    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(T, T::m64s, T::m64s) -> T::m64s) -> Self {
        for k in 0..M {
            self.registers[k] = f(self.token, self.registers[k], other.registers[k]);
        }
        self
    }
}

impl<T: Token, const M: usize> Mask for LaneMask<T, M> {
    #[inline(always)]
    fn and(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.and_m64s(a, b),
        )
    }
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.or_m64s(a, b),
        )
    }
    #[inline(always)]
    fn not(mut self) -> Self {
        for register in &mut self.registers {
            *register = self.token.not_m64s(*register);
        }
        self
    }
    #[inline(always)]
    fn any(self) -> bool {
        let mut any = self.registers[0];
        for k in 1..M {
            any = self.token.or_m64s(any, self.registers[k]);
        }
        self.token.first_true_m64s(any) < T::F64_LANES
    }
}

/// A closure run with the vector instructions at hand.
struct Routine<F>(F);

impl<A, F: FnMut() -> A> pulp::WithSimd for Routine<F> {
    type Output = A;
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(mut self, _: S) -> A {
        (self.0)()
    }
}

impl<T: Token, const M: usize> Scalar for Lanes<T, M> {
    type Mask = LaneMask<T, M>;
    type Coefficient = Self;
    type Angle = Self;
    const LIMIT: f64 = f64::INFINITY;

    #[inline(always)]
    fn from_f64(x: f64) -> Self {
        Lanes::from([x; LANES])
    }
    #[inline(always)]
    fn like(self, x: f64) -> Self {
        Lanes {
            registers: [self.token.splat_f64s(x); M],
            token: self.token,
        }
    }
    #[inline(always)]
    fn coefficient(x: f64) -> Self {
        Self::from_f64(x)
    }
    #[inline(always)]
    fn times(self, k: Self) -> Self {
        self * k
    }
    #[inline(always)]
    fn less(self, other: Self) -> LaneMask<T, M> {
        let token = self.token;
        let mut registers = [token.less_than_f64s(self.registers[0], other.registers[0]); M];
        let pairs = self.registers.into_iter().zip(other.registers);
        for (register, (a, b)) in registers.iter_mut().zip(pairs) {
            *register = token.less_than_f64s(a, b);
        }
        LaneMask { registers, token }
    }
    #[inline(always)]
    fn select(mask: LaneMask<T, M>, mut a: Self, b: Self) -> Self {
        for k in 0..M {
            a.registers[k] =
                mask.token
                    .select_f64s(mask.registers[k], a.registers[k], b.registers[k]);
        }
        a
    }
    // As the default, with constants from the token at hand.
    #[inline(always)]
    fn abs(self) -> Self {
        Self::select(self.less(self.like(0.0)), -self, self)
    }
    #[inline(always)]
    fn signum(self) -> Self {
        let (zero, one) = (self.like(0.0), self.like(1.0));
        let positive = Self::select(zero.less(self), one, zero);
        Self::select(self.less(zero), -one, positive)
    }
    #[inline(always)]
    fn routine<A>(body: impl FnMut() -> A) -> A {
        T::witness().vectorize(Routine(body))
    }
    #[inline(always)]
    fn sin_cos_turns(self) -> (Self, Self) {
        curves::sin_cos_turns(self)
    }
    #[inline(always)]
    fn part_of(self, whole: Self) -> Self {
        let (zero, one) = (self.like(0.0), self.like(1.0));
        let part = self.zip(
            whole,
            #[inline(always)]
            |t, a, b| t.div_f64s(a, b),
        );
        // In this order a NaN becomes zero, as it does for f64.
        let part = Self::select(zero.less(part), part, zero);
        let part = Self::select(part.less(one), part, one);
        Self::select(zero.less(whole), part, zero)
    }
    #[inline(always)]
    fn exp_decay(self) -> Self {
        curves::exp_decay(
            self,
            #[inline(always)]
            |shifted| shifted.each_by(curves::power_of_two),
        )
    }
}

impl<T: Token, const M: usize> Angle<Lanes<T, M>> for Lanes<T, M> {
    #[inline(always)]
    fn from_counts(counts: f64) -> Self {
        Self::from_f64(counts)
    }
    #[inline(always)]
    fn advance(self, step: Self, counts_per_unit: Self) -> Self {
        self + step * counts_per_unit
    }
    #[inline(always)]
    fn turns(self, counts_per_rev: u32) -> Self {
        self.each_by(
            #[inline(always)]
            |angle| <f64 as Angle<f64>>::turns(angle, counts_per_rev),
        )
    }
}
