//! A plan as text for a terminal.

use super::Plan;
use crate::report::fold::folded;
use servoid_identify::plan::{SEPARABLE_COUNTS, Separation};

/// A sentence, folded to a terminal's width.
fn line(sentence: &str) -> String {
    folded(sentence, "  ") + "\n"
}

impl Plan<'_> {
    fn pair(&self, pair: &Separation) -> String {
        format!(
            "     {} if {} is true: {:.2} counts left\n",
            self.hypothesis(pair.fitted).name(),
            self.hypothesis(pair.truth).name(),
            pair.counts
        )
    }

    /// As text for a terminal.
    pub fn text(&self) -> String {
        let mut text = line(&format!(
            "to separate {}, RMS error left above the encoder's own when the wrong one is fitted:",
            self.names().join(", ")
        ));
        for (place, ranked) in self.ranked.iter().enumerate() {
            text += &(folded(&format!("  {}. {}", place + 1, ranked.excitation), "     ") + "\n");
            for pair in &ranked.separations {
                text += &self.pair(pair);
            }
        }
        text += &line(&format!("the best: {}", self.usage(&self.best().usage)));
        if let Some(reason) = self.reason() {
            text += &line(&format!("why: {reason}"));
            text += &line(&format!(
                "{}: {} commands, {:.3} s; record them and run `servoid diagnose` on the recording",
                self.out.display(),
                self.samples(),
                self.samples() as f64 * self.work.setup.sample_s
            ));
        } else {
            text += &line(&format!(
                "even the best leaves less than {SEPARABLE_COUNTS} count: nothing was written"
            ));
        }
        for advice in self.advice() {
            text += &line(&advice);
        }
        text
    }
}
