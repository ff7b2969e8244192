//! The count of an absolute encoder whose readings may be bad.

use shared::encoder::Unwrapped;

/// Bad readings in a row from which on the encoder has failed: at a millisecond each, a shaft may turn far in them.
const FAILED: u8 = 5;

/// Unwraps angles of `BITS` bits, and holds the last good one while they are bad.
#[derive(Debug, Clone, Copy, Default)]
pub struct Absolute<const BITS: u32> {
    angle: Unwrapped<BITS>,
    bad: u8,
    all_bad: u32,
}

impl<const BITS: u32> Absolute<BITS> {
    /// Takes a reading, or that there was no good one; gives the count.
    pub fn take(&mut self, reading: Option<u32>) -> i32 {
        if let Some(angle) = reading {
            self.bad = 0;
            return self.angle.read(angle);
        }
        self.bad = self.bad.saturating_add(1);
        self.all_bad = self.all_bad.saturating_add(1);
        self.angle.count()
    }

    /// True after so many bad readings in a row that the count is not to be trusted.
    pub fn failed(&self) -> bool {
        self.bad >= FAILED
    }

    /// Bad readings so far.
    pub fn bad(&self) -> u32 {
        self.all_bad
    }
}
