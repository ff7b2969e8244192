//! A recording in the model's units: per-unit commands and encoder counts.

/// One stretch of samples at a constant interval. `command[k]` is held from the reading of
/// `counts[k]` until that of `counts[k + 1]`.
#[derive(Clone, Copy, Debug)]
pub struct Recording<'a, S> {
    /// Commanded voltage (or current), per unit.
    pub command: &'a [S],
    /// Encoder readings.
    pub counts: &'a [i32],
    /// True where the bridge is open and the motor coasts; `None` if it never is.
    pub open: Option<&'a [bool]>,
    /// Temperature at each reading, per unit; `None` if it is not known.
    pub temperature: Option<&'a [S]>,
}

impl<S: Copy> Recording<'_, S> {
    /// Samples that have a command and a reading.
    pub fn len(&self) -> usize {
        self.command.len().min(self.counts.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The temperature at sample `k`, if it is known.
    #[inline(always)]
    pub fn temperature_at(&self, k: usize) -> Option<S> {
        self.temperature
            .and_then(|temperature| temperature.get(k).copied())
    }

    /// Whether the bridge is open after sample `k`.
    #[inline(always)]
    pub fn is_open(&self, k: usize) -> bool {
        self.open
            .is_some_and(|open| open.get(k).copied().unwrap_or(false))
    }
}
