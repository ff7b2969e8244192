//! Why an effect was added, from what was measured.

use super::DiagnosisReport;
use super::bars::counts;
use servoid_identify::diagnose::evidence::{before, sentence};

/// How an error changed, in the word that its numbers allow: "`what` falls from 12.0 to 0.3 counts RMS".
pub(super) fn changed(what: &str, before: f64, after: f64) -> String {
    let (from, to) = (counts(before), counts(after));
    match before.total_cmp(&after) {
        _ if from == to => format!("{what} stays at {to} counts RMS"),
        std::cmp::Ordering::Greater => format!("{what} falls from {from} to {to} counts RMS"),
        _ => format!("{what} rises from {from} to {to} counts RMS"),
    }
}

impl DiagnosisReport<'_> {
    /// The evidence for step `index`.
    pub(super) fn evidence(&self, index: usize) -> String {
        let step = &self.diagnosis.steps[index];
        let before = before(self.diagnosis, index);
        let after = step.candidates.first().unwrap_or(&self.diagnosis.last);
        let falls = changed(
            "the held-out error",
            before.validate_rms_counts,
            after.validate_rms_counts,
        );
        let missing = self.findings.steps.get(index).and_then(Option::as_ref);
        match missing.and_then(|m| sentence(step.added, &after.values_of(step.added), m)) {
            Some(shown) => format!("{shown}; {falls}"),
            None => falls,
        }
    }
}
