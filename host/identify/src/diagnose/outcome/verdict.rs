//! What a recording says of a model.

/// What the recording says of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// The linear motor explains the recording down to the encoder.
    Complete,
    /// The named effects were missing, and with them the rest is the encoder's.
    MissingEffects,
    /// What is left is not the encoder's, and no effect of the catalogue explains it.
    Unexplained,
    /// The recording cannot tell.
    Inconclusive,
}

impl Verdict {
    /// Its name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::Complete => "complete",
            Verdict::MissingEffects => "missing_effects",
            Verdict::Unexplained => "unexplained",
            Verdict::Inconclusive => "inconclusive",
        }
    }
}
