//! One number that is searched for: its range, and how the unit interval is stretched over it.

/// How a unit-cube coordinate is stretched to a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// Evenly in the logarithm.
    Log,
}

/// A coordinate nearer than this to the end of its range is at the end.
const AT_END: f64 = 1e-4;
/// A search that was held by a bound ended nearer than this to it.
const AT_BOUND: f64 = 1e-9;
/// A range is widened by this factor at a time.
const WIDER: f64 = 3.0;

/// One unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Name, with the effect's name before a point for an effect's parameter.
    pub name: String,
    /// Unit symbol.
    pub unit: &'static str,
    /// Search range in that unit.
    pub range: (f64, f64),
    /// Upper end of the range before it was widened.
    pub usual: f64,
    /// Upper end to which the range may be widened.
    pub widest: f64,
    /// The range that it has when it is searched for, where it is held at one value so far.
    pub held_from: Option<(f64, f64)>,
    /// How the range is searched.
    pub scale: Scale,
    /// Whether it is a whole number, as the waves of a revolution are.
    pub whole: bool,
}

impl Unknown {
    pub(super) fn new(name: &str, unit: &'static str, range: (f64, f64), scale: Scale) -> Self {
        Unknown {
            name: name.to_owned(),
            unit,
            range,
            usual: range.1,
            widest: range.1,
            held_from: None,
            scale,
            whole: false,
        }
    }

    /// One that stays at `value` until it is [freed](Self::free).
    pub(super) fn held(name: &str, unit: &'static str, value: f64, range: (f64, f64)) -> Self {
        Unknown {
            held_from: Some(range),
            ..Unknown::new(name, unit, (value, value), Scale::Linear)
        }
    }

    /// Holds it at another value, where it is held.
    pub(super) fn hold_at(&mut self, value: f64) {
        if self.held_from.is_some() {
            self.range = (value, value);
            (self.usual, self.widest) = self.range;
        }
    }

    /// Searches for it, where it was held.
    pub(super) fn free(&mut self) {
        if let Some(range) = self.held_from {
            self.confine(range);
        }
    }

    /// The same as a whole number.
    pub(super) fn whole(self) -> Self {
        Unknown {
            whole: true,
            ..self
        }
    }

    /// The same with a range that may be widened up to `widest`.
    pub(super) fn widening_to(self, widest: f64) -> Self {
        Unknown { widest, ..self }
    }

    /// Restricts the search to a range that is not widened.
    pub fn confine(&mut self, range: (f64, f64)) {
        self.range = range;
        (self.usual, self.widest) = (range.1, range.1);
        self.held_from = None;
    }

    /// Whether the coordinate `x` is beyond the usual range, in a part that a search has added.
    pub fn is_beyond_usual(&self, x: f64) -> bool {
        self.range.1 > self.usual && self.value(x) > (1.0 + AT_END) * self.usual
    }

    /// Whether a value is at an end of the range. Zero is where many quantities rightly end, and no bound that somebody chose.
    pub fn ends_at(&self, value: f64) -> bool {
        let (low, high) = self.range;
        let x = self.coordinate(value);
        low < high && (x > 1.0 - AT_BOUND || (x < AT_BOUND && low != 0.0))
    }

    /// Widens the range where the coordinate `x` is at its upper end. Returns whether it did.
    pub(super) fn widen_at(&mut self, x: f64) -> bool {
        let widens = x > 1.0 - AT_END && self.range.1 < self.widest;
        if widens {
            self.range.1 = (WIDER * self.range.1).min(self.widest);
        }
        widens
    }

    /// Value at the coordinate `x` in `[0, 1]`.
    pub fn value(&self, x: f64) -> f64 {
        let (low, high) = self.range;
        let value = match self.scale {
            Scale::Linear => low + (high - low) * x,
            Scale::Log => low * libm::pow(high / low, x),
        };
        if self.whole { value.round() } else { value }
    }

    /// Coordinate of a value, clamped to `[0, 1]`.
    pub fn coordinate(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        let x = match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Log => libm::log(value.max(low) / low) / libm::log(high / low),
        };
        if x.is_finite() {
            x.clamp(0.0, 1.0)
        } else {
            0.5
        }
    }
}
