//! A plan as text for a terminal.

use super::Plan;
use servoid_identify::plan::{SEPARABLE_COUNTS, Separation};

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
        let mut text = format!(
            "to separate {}, RMS error left above the encoder's own when the wrong one is fitted:\n",
            self.names().join(", ")
        );
        for (place, ranked) in self.ranked.iter().enumerate() {
            text += &format!("  {}. {}\n", place + 1, ranked.excitation);
            for pair in &ranked.separations {
                text += &self.pair(pair);
            }
        }
        text += &format!("the best: {}\n", self.usage(&self.best().usage));
        if let Some(reason) = self.reason() {
            text += &format!("why: {reason}\n");
            text += &format!(
                "{}: {} commands, {:.3} s; record them and run `servoid diagnose` on the recording\n",
                self.out.display(),
                self.samples(),
                self.samples() as f64 * self.work.setup.sample_s
            );
        } else {
            text += &format!(
                "even the best leaves less than {SEPARABLE_COUNTS} count: nothing was written\n"
            );
        }
        for advice in self.advice() {
            text += &format!("{advice}\n");
        }
        text
    }
}
