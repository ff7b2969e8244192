//! One number that is searched for: its range, and how the unit interval is stretched over it.

/// How a unit-cube coordinate is stretched to a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly in the logarithm.
    Log,
}

/// One unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Name, with the effect's name before a point for an effect's parameter.
    pub name: String,
    /// Unit symbol.
    pub unit: &'static str,
    /// Search range in that unit.
    pub range: (f64, f64),
    /// How the range is searched.
    pub scale: Scale,
}

impl Unknown {
    pub(super) fn new(name: &str, unit: &'static str, range: (f64, f64), scale: Scale) -> Self {
        Unknown {
            name: name.to_owned(),
            unit,
            range,
            scale,
        }
    }

    /// Value at the coordinate `x` in `[0, 1]`.
    pub fn value(&self, x: f64) -> f64 {
        let (low, high) = self.range;
        match self.scale {
            Scale::Linear => low + (high - low) * x,
            Scale::Log => low * (high / low).powf(x),
        }
    }

    /// Coordinate of a value, clamped to `[0, 1]`.
    pub fn coordinate(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        let x = match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Log => (value.max(low) / low).ln() / (high / low).ln(),
        };
        if x.is_finite() {
            x.clamp(0.0, 1.0)
        } else {
            0.5
        }
    }
}
