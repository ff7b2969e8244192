//! Several recordings of one motor as one.

use super::{Data, Recordings};
use servoid_io::recording::Recording;
use shared::error::ModelError;
use std::ops::Range;

/// Time from one recording to the next, s: any will do, since nothing runs across it.
const BETWEEN_S: f64 = 1.0;

/// Why recordings cannot be taken together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum JoinError {
    /// There is none.
    #[error("no recording is given")]
    Empty,
    /// They measure or drive differently.
    #[error(
        "{first} and {other} differ in {what}, so that they cannot be fitted together; give recordings of one motor \
         with one encoder and one kind of drive"
    )]
    Differ {
        /// Source of the first.
        first: String,
        /// Source of the one that differs.
        other: String,
        /// In what.
        what: &'static str,
    },
    /// They are copies, and would count twice.
    #[error("{first} and {other} hold the same samples; give each recording once")]
    Copies {
        /// Source of the first.
        first: String,
        /// Source of its copy.
        other: String,
    },
    /// The bases of the model.
    #[error(transparent)]
    Model(#[from] ModelError),
}

impl Data {
    /// Recordings of one motor as one. Each keeps its readings: effects that depend on the angle take them from one zero.
    ///
    /// # Errors
    /// [`JoinError::Differ`] where encoder or drive differ; [`JoinError::Copies`] where two have the same samples;
    /// [`JoinError::Model`] as [`Data::taken`].
    pub fn joined(recordings: Vec<Recording>) -> Result<Data, JoinError> {
        for (k, one) in recordings.iter().enumerate() {
            if let Some(other) = recordings[k + 1..]
                .iter()
                .find(|other| one.is_copy_of(other))
            {
                return Err(JoinError::Copies {
                    first: one.source.clone(),
                    other: other.source.clone(),
                });
            }
        }
        let mut list = recordings.into_iter();
        let mut whole = list.next().ok_or(JoinError::Empty)?;
        let one = Recordings::one(&whole.source, whole.len());
        let mut parts = one.driven_by(whole.position.take());
        for mut next in list {
            if let Some(what) = difference(&whole, &next) {
                return Err(JoinError::Differ {
                    first: whole.source,
                    other: next.source,
                    what,
                });
            }
            let drive = next.position.take();
            parts.push(&next.source, next.len(), drive);
            append(&mut whole, next);
        }
        whole.source = parts.sources().join(" + ");
        Ok(Data::of_recordings(whole, parts)?)
    }

    /// Each of the recordings alone, with the bases of all.
    pub fn parts(&self) -> impl Iterator<Item = Data> {
        (self.recordings.ranges().enumerate()).map(|(index, range)| self.part(index, range))
    }

    fn part(&self, index: usize, range: Range<usize>) -> Data {
        let source = &self.recordings.sources()[index];
        let start = self.time_s.get(range.start).copied().unwrap_or(0.0);
        let some = |values: &[f64]| values[range.clone()].to_vec();
        Data {
            source: source.clone(),
            time_s: some(&self.time_s).iter().map(|t| t - start).collect(),
            command: some(&self.command),
            counts: some(&self.counts),
            open: self.open.as_ref().map(|open| open[range.clone()].to_vec()),
            measured: self.measured.rows(range.clone()),
            lengths: self.lengths.clone(),
            length_of: self.length_of[range.clone()].to_vec(),
            recordings: self.recordings.only(index),
            end_of: None,
            ..*self
        }
    }
}

/// In what two recordings differ that keeps them from being fitted together.
fn difference(one: &Recording, other: &Recording) -> Option<&'static str> {
    if one.counts_per_rev != other.counts_per_rev {
        Some("counts per revolution")
    } else if one.quantised != other.quantised {
        Some("whether the angle is a whole count")
    } else if one.drive != other.drive {
        Some("what the command drives")
    } else {
        None
    }
}

/// Puts `next` behind `whole`. A measured column that only one of the two has is left out; a bridge is closed where nothing is said.
fn append(whole: &mut Recording, next: Recording) {
    let before = whole.len();
    let end = whole.time_s.last().map_or(0.0, |end| end + BETWEEN_S);
    let shift = end - next.time_s.first().copied().unwrap_or(0.0);
    whole.enabled = match (whole.enabled.take(), next.enabled) {
        (None, None) => None,
        (one, other) => {
            let mut enabled = one.unwrap_or_else(|| vec![true; before]);
            enabled.extend(other.unwrap_or_else(|| vec![true; next.time_s.len()]));
            Some(enabled)
        }
    };
    whole.measured.append(next.measured);
    whole.supply_v = match (whole.supply_v, next.supply_v) {
        (Some(one), Some(other)) => Some(one.max(other)),
        (one, other) => one.or(other),
    };
    whole.time_s.extend(next.time_s.iter().map(|t| t + shift));
    whole.command.extend(next.command);
    whole.counts.extend(next.counts);
}
