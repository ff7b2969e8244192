//! Why an effect was added, from what was measured.

use super::DiagnosisReport;
use super::bars::counts;

impl DiagnosisReport<'_> {
    /// The evidence for step `index`, one sentence.
    pub(super) fn evidence(&self, index: usize) -> String {
        let step = &self.diagnosis.steps[index];
        let before = match index.checked_sub(1) {
            None => &self.diagnosis.base,
            Some(earlier) => match self.diagnosis.steps[earlier].candidates.first() {
                Some(after) => after,
                None => &self.diagnosis.base,
            },
        };
        let after = step.candidates.first().unwrap_or(&self.diagnosis.last);
        format!(
            "the held-out error falls from {} to {} counts RMS",
            counts(before.validate_rms_counts),
            counts(after.validate_rms_counts)
        )
    }
}
