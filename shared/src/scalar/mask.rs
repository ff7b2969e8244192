//! Results of comparisons: one truth value, or one for each lane.

/// Truth, for every lane at once.
pub trait Mask: Copy {
    /// Both.
    fn and(self, other: Self) -> Self;
    /// Either.
    fn or(self, other: Self) -> Self;
    /// The opposite.
    fn not(self) -> Self;
    /// Whether it holds in any lane.
    fn any(self) -> bool;
}

impl Mask for bool {
    fn and(self, other: Self) -> Self {
        self & other
    }
    fn or(self, other: Self) -> Self {
        self | other
    }
    fn not(self) -> Self {
        !self
    }
    fn any(self) -> bool {
        self
    }
}
