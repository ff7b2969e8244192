//! Units that a factor and a zero convert, and lists of one value a measured channel.

use super::kind::Measured;
use std::ops::{Index, IndexMut, Range};

/// A unit of a measured channel.
#[derive(Debug, PartialEq)]
pub struct LinearUnit {
    /// Its name in `motor.toml`.
    pub name: &'static str,
    /// What stands for nothing in the channel's own unit.
    pub zero: f64,
    /// How many of it are one of the channel's own unit.
    pub per: f64,
    /// Names of columns that are looked for where the user names none, best first.
    pub(crate) columns: &'static [&'static str],
}

impl LinearUnit {
    /// A value in the channel's own unit.
    pub fn own(&self, value: f64) -> f64 {
        (value - self.zero) / self.per
    }
}

/// One value for each measured channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PerMeasured<T>(pub [T; Measured::COUNT]);

impl<T> Index<Measured> for PerMeasured<T> {
    type Output = T;

    fn index(&self, channel: Measured) -> &T {
        &self.0[channel.place()]
    }
}

impl<T> IndexMut<Measured> for PerMeasured<T> {
    fn index_mut(&mut self, channel: Measured) -> &mut T {
        &mut self.0[channel.place()]
    }
}

impl PerMeasured<Option<Vec<f64>>> {
    /// The samples of each column at the given places.
    pub(crate) fn at(&self, places: &[usize]) -> Self {
        let some = |column: &Option<Vec<f64>>| {
            let picked = |all: &Vec<f64>| places.iter().map(|&k| all[k]).collect();
            column.as_ref().map(picked)
        };
        PerMeasured(self.0.each_ref().map(some))
    }

    /// Some of the samples of each column.
    pub(crate) fn rows(&self, rows: &Range<usize>) -> Self {
        let some =
            |column: &Option<Vec<f64>>| column.as_ref().map(|all| all[rows.clone()].to_vec());
        PerMeasured(self.0.each_ref().map(some))
    }
}
