//! Counts that the encoder's counter lost.

/// Counts that were lost between two readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// First sample that was read without them.
    pub sample: usize,
    /// How many, with the sign of the motion.
    pub counts: f64,
}

/// The losses of both recordings.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Losses {
    /// Of the fitted one.
    pub fitted: Vec<Loss>,
    /// Of the held-out one.
    pub held_out: Vec<Loss>,
}
