//! By how much the errors of models near one differ from its own, handed over as they come: of an hour's recording, a column
//! for each of them would be larger than the recording.

use super::fit_problem::FitProblem;
use crate::simulation::{Candidate, segments};
use shared::cost::Cost;

/// What changes are counted from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Centring {
    /// They are as they count.
    Done,
    /// The mean of each model's own is still to be taken away: the start angle is free.
    Pending,
}

impl FitProblem<'_> {
    /// Hands over, some samples at a time and in their order, by how much the errors of each of the `others` differ from those
    /// of `here`, counts. `None` where one of them cannot run.
    pub fn stream_changes(
        &self,
        here: &Candidate,
        others: &[Candidate],
        mut each: impl FnMut(&[&[f64]]),
    ) -> Option<Centring> {
        let centred = self.is_centred(here);
        // The middle of absolute errors is their median, which takes all of them.
        let by_median = centred && matches!(self.cost, Cost::Absolute { .. });
        let segments =
            |model: &Candidate| segments(self.data, model, &self.horizon, self.start_angle);
        if !by_median
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
