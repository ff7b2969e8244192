//! How an encoder's readings have gone.

/// Bad readings in a row from which on the encoder has failed: at a millisecond each, a shaft may turn far in them.
const FAILED: u8 = 5;

/// Bad readings, of late and in all.
#[derive(Debug, Clone, Copy, Default)]
pub struct Readings {
    in_a_row: u8,
    bad: u32,
}

impl Readings {
    /// A reading was good, or not.
    pub fn count(&mut self, good: bool) {
        self.in_a_row = if good {
            0
        } else {
            self.in_a_row.saturating_add(1)
        };
        self.bad = self.bad.saturating_add(u32::from(!good));
    }

    /// True after so many bad ones in a row that the count is not to be trusted.
    pub fn failed(&self) -> bool {
        self.in_a_row >= FAILED
    }

    /// Bad ones so far.
    pub fn bad(&self) -> u32 {
        self.bad
    }
}
