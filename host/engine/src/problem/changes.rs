//! Changes of the errors from one model to others near it, passed on a range of samples at a time: for an hour's
//! recording, a column for each of them would be larger than the recording.

use super::fit_problem::FitProblem;
use crate::simulation::{Candidate, segments};
use shared::cost::Cost;

/// Whether the changes already have the shift by the free start angle in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Centring {
    /// They have, or the start angle is not free.
    Done,
    /// The caller must still subtract each column's mean.
    Pending,
}

impl FitProblem<'_> {
    /// Calls `each` with the errors of each of the `others` less those of `here`, counts, a range of samples at a time in
    /// their order. `None` where one of them cannot run.
    pub fn stream_changes(
        &self,
        here: &Candidate,
        others: &[Candidate],
        mut each: impl FnMut(&[&[f64]]),
    ) -> Option<Centring> {
        let centred = self.is_centred(here);
        // Absolute errors are centred on their median, and each of several recordings by itself: that needs all at once.
        let by_median = centred && matches!(self.cost, Cost::Absolute { .. });
        let at_once = by_median || self.data.recordings.are_several();
        let segments =
            |model: &Candidate| segments(self.data, model, &self.horizon, self.start_angle);
        if !at_once
            && self
                .batch()
                .stream(here, others, segments, |_, changes| each(changes))
        {
            return Some(if centred {
                Centring::Pending
            } else {
                Centring::Done
            });
        }
        let changes = self.changes_of(here, others);
        let columns: Option<Vec<&[f64]>> = changes.iter().map(Option::as_deref).collect();
        each(&columns?);
        Some(Centring::Done)
    }
}
