//! What a user chooses beside the format.

use super::brushless::Winding;
use super::error::ExportError;
use super::gains::asked::Asked;
use super::subject::Subject;

/// What a user chooses beside the format.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Period of the program that the export is for, s; the recording's if none.
    pub sample_s: Option<f64>,
    /// Controllers.
    pub gains: Asked,
    /// What voltage and current of the recording were those of.
    pub winding: Winding,
    /// Pairs of poles of a brushless motor.
    pub pole_pairs: Option<u32>,
}

impl Options {
    /// The period, s.
    ///
    /// # Errors
    /// Neither the user nor the result says it.
    pub fn period(&self, subject: &Subject, format: &'static str) -> Result<f64, ExportError> {
        // The recording's is the median of rounded times; nine digits of it mean something.
        let rounded = |s: f64| format!("{s:.8e}").parse().unwrap_or(s);
        let period = self.sample_s.or(subject.sample_s.map(rounded));
        period.ok_or_else(|| ExportError::Undetermined {
            format,
            needs: "the sample interval".to_owned(),
            remedy: "give it with --sample S",
        })
    }
}
