//! What a formula is computed with: a number, or a number with its derivatives by the state or the current, the speed and the time.

use crate::scalar::Scalar;

/// A number, perhaps with derivatives (forward differentiation: Griewank, Walther, *Evaluating Derivatives*, 2008).
pub(super) trait Number<S: Scalar>: Copy {
    /// A number that depends on nothing.
    fn constant(value: S) -> Self;
    /// Its value.
    fn value(self) -> S;
    /// A function of it with this value; `slope` is its derivative.
    fn map(self, value: S, slope: impl FnOnce() -> S) -> Self;
    /// Sum.
    fn plus(self, other: Self) -> Self;
    /// Product.
    fn by(self, other: Self) -> Self;
    /// Times a multiplier.
    fn scaled(self, k: S::Coefficient) -> Self;
    /// `a` where the mask is set, else `b`.
    fn choose(mask: S::Mask, a: Self, b: Self) -> Self;
    /// The other sign.
    fn negated(self) -> Self;
}

impl<S: Scalar> Number<S> for S {
    #[inline(always)]
    fn constant(value: S) -> Self {
        value
    }
    #[inline(always)]
    fn value(self) -> S {
        self
    }
    #[inline(always)]
    fn map(self, value: S, _: impl FnOnce() -> S) -> Self {
        value
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        self + other
    }
    #[inline(always)]
    fn by(self, other: Self) -> Self {
        self * other
    }
    #[inline(always)]
    fn scaled(self, k: S::Coefficient) -> Self {
        self.times(k)
    }
    #[inline(always)]
    fn choose(mask: S::Mask, a: Self, b: Self) -> Self {
        S::select(mask, a, b)
    }
    #[inline(always)]
    fn negated(self) -> Self {
        -self
    }
}

/// A number with its derivatives.
#[derive(Clone, Copy)]
pub(super) struct Dual<S> {
    /// Its value.
    pub(super) value: S,
    /// By the state, or by the current where a voltage depends on that.
    pub(super) by_state: S,
    /// By the speed.
    pub(super) by_speed: S,
    /// What it changes by over a part, as what it depends on changes, the state left out.
    pub(super) swing: S,
}

impl<S: Scalar> Number<S> for Dual<S> {
    #[inline(always)]
    fn constant(value: S) -> Self {
        Dual {
            value,
            by_state: S::zero(),
            by_speed: S::zero(),
            swing: S::zero(),
        }
    }
    #[inline(always)]
    fn value(self) -> S {
        self.value
    }
    #[inline(always)]
    fn map(self, value: S, slope: impl FnOnce() -> S) -> Self {
        let slope = slope();
        Dual {
            value,
            by_state: self.by_state * slope,
            by_speed: self.by_speed * slope,
            swing: self.swing * slope,
        }
    }
    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Dual {
            value: self.value + other.value,
            by_state: self.by_state + other.by_state,
            by_speed: self.by_speed + other.by_speed,
            swing: self.swing + other.swing,
        }
    }
    #[inline(always)]
    fn by(self, other: Self) -> Self {
        Dual {
            value: self.value * other.value,
            by_state: self.by_state * other.value + self.value * other.by_state,
            by_speed: self.by_speed * other.value + self.value * other.by_speed,
            swing: self.swing * other.value + self.value * other.swing,
        }
    }
    #[inline(always)]
    fn scaled(self, k: S::Coefficient) -> Self {
        Dual {
            value: self.value.times(k),
            by_state: self.by_state.times(k),
            by_speed: self.by_speed.times(k),
            swing: self.swing.times(k),
        }
    }
    #[inline(always)]
    fn choose(mask: S::Mask, a: Self, b: Self) -> Self {
        Dual {
            value: S::select(mask, a.value, b.value),
            by_state: S::select(mask, a.by_state, b.by_state),
            by_speed: S::select(mask, a.by_speed, b.by_speed),
            swing: S::select(mask, a.swing, b.swing),
        }
    }
    #[inline(always)]
    fn negated(self) -> Self {
        Dual {
            value: -self.value,
            by_state: -self.by_state,
            by_speed: -self.by_speed,
            swing: -self.swing,
        }
    }
}
