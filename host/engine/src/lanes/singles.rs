//! Numbers in single precision side by side: twice as many to a register.
//!
//! Only for what is judged by bounds of its rounding: a result of these is never a result of the program.

use super::number::LANES;
use super::token::Token;
use bytemuck::cast;
use core::ops::{Add, Sub};

/// Numbers side by side.
pub const SINGLES: usize = 2 * LANES;

/// [`SINGLES`] numbers in `M` registers of the processor `T`.
#[derive(Clone, Copy)]
pub struct Singles<T: Token, const M: usize> {
    registers: [T::f32s; M],
    token: T,
}

impl<T: Token, const M: usize> Singles<T, M> {
    /// Zeros.
    #[inline(always)]
    pub fn zero() -> Self {
        let token = T::here();
        Singles {
            registers: [token.splat_f32s(0.0); M],
            token,
        }
    }

    /// The same number throughout, on the processor of `self`.
    #[inline(always)]
    pub fn like(mut self, x: f32) -> Self {
        self.registers = [self.token.splat_f32s(x); M];
        self
    }

    /// Some numbers, on the processor of `self`.
    #[inline(always)]
    pub fn each_like(mut self, each: [f32; SINGLES]) -> Self {
        self.registers = cast(each);
        self
    }

    /// Magnitudes.
    #[inline(always)]
    pub fn abs(mut self) -> Self {
        for register in &mut self.registers {
            *register = self.token.abs_f32s(*register);
        }
        self
    }

    /// `self + a·b`; the product may or may not be rounded before it is added.
    #[inline(always)]
    pub fn plus_product(mut self, a: Self, b: Self) -> Self {
        for k in 0..M {
            self.registers[k] =
                self.token
                    .mul_add_e_f32s(a.registers[k], b.registers[k], self.registers[k]);
        }
        self
    }

    /// The sum of all, halves added to halves: no number goes through more than `log2(SINGLES)` additions.
    #[inline(always)]
    pub fn sum(self) -> f32 {
        let mut all = self.registers[0];
        for k in 1..M {
            all = self.token.add_f32s(all, self.registers[k]);
        }
        self.token.reduce_sum_f32s(all)
    }

    #[inline(always)]
    fn zip(mut self, other: Self, f: impl Fn(T, T::f32s, T::f32s) -> T::f32s) -> Self {
        for k in 0..M {
            self.registers[k] = f(self.token, self.registers[k], other.registers[k]);
        }
        self
    }
}

impl<T: Token, const M: usize> Add for Singles<T, M> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.add_f32s(a, b),
        )
    }
}

impl<T: Token, const M: usize> Sub for Singles<T, M> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(
            other,
            #[inline(always)]
            |t, a, b| t.sub_f32s(a, b),
        )
    }
}
