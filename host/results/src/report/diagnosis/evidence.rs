//! Why an effect was added, from what was measured.

use super::DiagnosisReport;
use super::bars::counts;
use servoid_identify::diagnose::evidence::{before, sentence};

impl DiagnosisReport<'_> {
    /// The evidence for step `index`.
    pub(super) fn evidence(&self, index: usize) -> String {
        let step = &self.diagnosis.steps[index];
        let before = before(self.diagnosis, index);
        let after = step.candidates.first().unwrap_or(&self.diagnosis.last);
        let falls = format!(
            "the held-out error falls from {} to {} counts RMS",
            counts(before.validate_rms_counts),
            counts(after.validate_rms_counts)
        );
        let missing = self.findings.steps.get(index).and_then(Option::as_ref);
        match missing.and_then(|m| sentence(step.added, &after.values_of(step.added), m)) {
            Some(shown) => format!("{shown}; {falls}"),
            None => falls,
        }
    }
}
