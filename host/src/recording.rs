//! A recording in memory: what was commanded, what the encoder read, and when.

/// What the command column drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// A voltage on the armature.
    Voltage,
    /// A current (or torque): the amplifier closes a current loop, so that no back-EMF is seen.
    Current,
}

/// One recording, in SI units and encoder counts, checked on entry: all columns have equal length,
/// every number is finite and time increases.
#[derive(Clone, Debug)]
pub struct Recording {
    /// Where it came from, for messages.
    pub source: String,
    /// Time of each sample, s; strictly increasing.
    pub time_s: Vec<f64>,
    /// Command in V (or A, see [`Drive`]), held from its own row until the next.
    pub command: Vec<f64>,
    /// Encoder reading in counts, cumulative. Whole numbers if [`quantised`](Self::quantised).
    pub counts: Vec<f64>,
    /// Armature current, A.
    pub current_a: Option<Vec<f64>>,
    /// False while the bridge is open: no current flows and the motor coasts.
    pub enabled: Option<Vec<bool>>,
    /// Encoder counts per revolution.
    pub counts_per_rev: f64,
    /// Whether `counts` are whole encoder counts (floored), rather than an angle from elsewhere.
    pub quantised: bool,
    /// Supply voltage, V, when the user stated it.
    pub supply_v: Option<f64>,
    /// What the command drives.
    pub drive: Drive,
}

impl Recording {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there is no sample at all.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }
}
