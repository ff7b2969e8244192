//! The range in which a result lies (Moore, *Interval Analysis*, 1966), which scales it and says whether it can be a divisor.

/// All numbers from `low` to `high`, the ends included.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Interval {
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// A product in which nothing times anything is nothing, also of what has no bound.
fn times(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 { 0.0 } else { a * b }
}

impl Interval {
    /// From both ends.
    pub fn new(low: f64, high: f64) -> Self {
        Interval { low, high }
    }

    /// One number.
    pub fn point(x: f64) -> Self {
        Interval::new(x, x)
    }

    /// All numbers up to a magnitude.
    pub fn within(magnitude: f64) -> Self {
        Interval::new(-magnitude, magnitude)
    }

    /// Largest magnitude.
    pub fn most(self) -> f64 {
        libm::fmax(libm::fabs(self.low), libm::fabs(self.high))
    }

    /// Least magnitude.
    pub fn least(self) -> f64 {
        if self.low > 0.0 {
            self.low
        } else if self.high < 0.0 {
            -self.high
        } else {
            0.0
        }
    }

    /// The smallest that holds the given ones.
    fn around(ends: [f64; 4]) -> Self {
        let low = ends
            .iter()
            .fold(f64::INFINITY, |low, x| libm::fmin(low, *x));
        let high = (ends.iter()).fold(f64::NEG_INFINITY, |high, x| libm::fmax(high, *x));
        Interval { low, high }
    }

    /// Sum.
    pub fn plus(self, other: Self) -> Self {
        Interval::new(self.low + other.low, self.high + other.high)
    }

    /// With the other sign.
    pub fn negated(self) -> Self {
        Interval::new(-self.high, -self.low)
    }

    /// Product.
    pub fn times(self, other: Self) -> Self {
        Interval::around([
            times(self.low, other.low),
            times(self.low, other.high),
            times(self.high, other.low),
            times(self.high, other.high),
        ])
    }

    /// One over it; all numbers where it holds zero.
    pub fn inverse(self) -> Self {
        if self.least() == 0.0 {
            return Interval::within(f64::INFINITY);
        }
        Interval::new(1.0 / self.high, 1.0 / self.low)
    }

    /// Magnitudes.
    pub fn magnitude(self) -> Self {
        Interval::new(self.least(), self.most())
    }

    /// Squares.
    pub fn square(self) -> Self {
        let size = self.magnitude();
        Interval::new(size.low * size.low, size.high * size.high)
    }

    /// Signs.
    pub fn sign(self) -> Self {
        let sign = |x: f64| f64::from(i8::from(x > 0.0) - i8::from(x < 0.0));
        Interval::new(sign(self.low), sign(self.high))
    }

    /// The smaller of two.
    pub fn min(self, other: Self) -> Self {
        Interval::new(
            libm::fmin(self.low, other.low),
            libm::fmin(self.high, other.high),
        )
    }

    /// The larger of two.
    pub fn max(self, other: Self) -> Self {
        self.negated().min(other.negated()).negated()
    }

    /// By a function that rises.
    pub fn rising(self, f: impl Fn(f64) -> f64) -> Self {
        Interval::new(f(self.low), f(self.high))
    }

    /// Magnitudes to a power that is not negative.
    pub fn raised(self, power: f64) -> Self {
        self.magnitude().rising(|x| libm::pow(x, power))
    }
}
