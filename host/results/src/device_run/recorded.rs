//! The periods that a device sent, put together.

use shared::wire::{Row, Rows, Stage};

/// The periods of one stage, as far as they arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// Which stage.
    pub stage: Stage,
    /// Encoder reading at the start.
    pub count: i32,
    /// In order; what was lost is left out.
    pub rows: Vec<Option<Row>>,
}

impl Recorded {
    /// Periods that never arrived.
    pub fn missing(&self) -> usize {
        self.rows.iter().filter(|row| row.is_none()).count()
    }

    /// The rows before the first gap.
    pub fn whole(&self) -> impl Iterator<Item = Row> {
        self.rows.iter().map_while(|row| *row)
    }

    /// Puts rows that arrived into their places.
    pub fn take(&mut self, rows: &Rows) {
        let first = rows.first as usize;
        if first == 0 {
            self.count = rows.count;
        }
        let end = first + rows.rows.len();
        if self.rows.len() < end {
            self.rows.resize(end, None);
        }
        for (slot, row) in self.rows[first..end].iter_mut().zip(&rows.rows) {
            *slot = Some(*row);
        }
    }
}
