//! The columns of a recording beside time, command and angle.

use super::kind::Measured;
use super::unit::PerMeasured;
use std::ops::Range;

/// Measured columns, each with one value a sample in its channel's own unit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series(PerMeasured<Option<Vec<f64>>>);

impl Series {
    /// No column at all.
    pub const NONE: Series = Series(PerMeasured([const { None }; Measured::COUNT]));

    /// The column of a channel.
    pub fn get(&self, channel: Measured) -> Option<&[f64]> {
        self.0[channel].as_deref()
    }

    /// These and the column of one more channel, if there is one.
    pub fn with(mut self, channel: Measured, values: Option<Vec<f64>>) -> Self {
        self.0[channel] = values;
        self
    }

    /// The channels that have a column.
    pub fn told(&self) -> impl Iterator<Item = (Measured, &[f64])> {
        Measured::ALL
            .into_iter()
            .filter_map(|channel| Some((channel, self.get(channel)?)))
    }

    /// Some of the samples.
    pub fn rows(&self, rows: Range<usize>) -> Self {
        Series(self.0.rows(&rows))
    }

    /// The samples at the given places.
    pub fn at(&self, places: &[usize]) -> Self {
        Series(self.0.at(places))
    }

    /// Puts the samples of another recording behind. A column that only one of the two has is left out.
    pub fn append(&mut self, next: Series) {
        for (own, next) in self.0.0.iter_mut().zip(next.0.0) {
            *own = own.take().zip(next).map(|(own, next)| [own, next].concat());
        }
    }
}

impl From<PerMeasured<Option<Vec<f64>>>> for Series {
    fn from(columns: PerMeasured<Option<Vec<f64>>>) -> Self {
        Series(columns)
    }
}
