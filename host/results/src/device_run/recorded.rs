//! The periods that a device sent, put together.

use shared::wire::{Row, Rows, Stage};
use std::collections::BTreeMap;

/// The periods of one stage, as far as they arrived.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// Which stage.
    pub stage: Stage,
    /// Encoder reading at the start.
    pub count: i32,
    /// In order; what was lost is left out.
    pub rows: Vec<Option<Row>>,
    /// Encoder readings at periods that begin a message.
    readings: BTreeMap<usize, i32>,
}

/// Periods of a stage that follow each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// Index of the first one.
    pub first: usize,
    /// Encoder reading at its start.
    pub count: i32,
    /// The periods.
    pub rows: Vec<Row>,
}

impl Recorded {
    /// Nothing yet, of a stage with the shaft at `count`.
    pub fn new(stage: Stage, count: i32) -> Self {
        Recorded {
            stage,
            count,
            rows: Vec::new(),
            readings: BTreeMap::new(),
        }
    }

    /// Periods that never arrived.
    pub fn missing(&self) -> usize {
        self.rows.iter().filter(|row| row.is_none()).count()
    }

    /// The rows before the first gap.
    pub fn whole(&self) -> impl Iterator<Item = Row> {
        self.rows.iter().map_while(|row| *row)
    }

    /// What lies before the first gap.
    pub fn start(&self) -> Piece {
        Piece {
            first: 0,
            count: self.count,
            rows: self.whole().collect(),
        }
    }

    /// What lies between the gaps. A piece behind one whose reading at the start did not arrive is left out.
    pub fn pieces(&self) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let mut first = 0;
        for part in self.rows.split(Option::is_none) {
            let reading = match first {
                0 => Some(self.count),
                first => self.readings.get(&first).copied(),
            };
            let rows: Vec<Row> = part.iter().copied().flatten().collect();
            let length = rows.len();
            if let (Some(count), false) = (reading, rows.is_empty()) {
                pieces.push(Piece { first, count, rows });
            }
            first += length + 1;
        }
        pieces
    }

    /// Puts rows that arrived into their places.
    pub fn take(&mut self, rows: &Rows) {
        let first = rows.first as usize;
        if first == 0 {
            self.count = rows.count;
        }
        self.readings.entry(first).or_insert(rows.count);
        self.take_again(rows);
    }

    /// Puts rows that were requested again into their places: the device no longer knows where the shaft stood.
    pub fn take_again(&mut self, rows: &Rows) {
        let first = rows.first as usize;
        let end = first + rows.rows.len();
        if self.rows.len() < end {
            self.rows.resize(end, None);
        }
        for (slot, row) in self.rows[first..end].iter_mut().zip(&rows.rows) {
            *slot = Some(*row);
        }
    }
}

/// A message of the periods from `first` on, of a shaft that begins at `count` and goes on by `steps`.
#[cfg(test)]
pub(super) fn message(first: u32, count: i32, steps: &[i16]) -> Rows {
    let row = |&step| Row {
        duty: 7,
        step,
        current_ma: 0,
        supply_mv: 0,
    };
    Rows {
        run: 1,
        stage: Stage::Excite,
        first,
        count,
        rows: steps.iter().map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_keep_their_place_and_their_reading() {
        let mut recorded = Recorded::new(Stage::Excite, 0);
        recorded.take(&message(0, 100, &[1, 2]));
        // The message of periods 2 and 3 is lost, that of 6 and 7 as well.
        recorded.take(&message(4, 110, &[3, 4]));
        recorded.take(&message(8, 130, &[5]));
        let pieces = recorded.pieces();
        let told: Vec<_> = pieces
            .iter()
            .map(|piece| (piece.first, piece.count, piece.rows.len()))
            .collect();
        assert_eq!(told, [(0, 100, 2), (4, 110, 2), (8, 130, 1)]);
        assert_eq!((recorded.missing(), recorded.whole().count()), (4, 2));
        // Rows that are sent again have no reading, and need none where they close a gap.
        recorded.take_again(&message(2, 0, &[9, 9]));
        let told: Vec<_> = recorded
            .pieces()
            .iter()
            .map(|piece| (piece.first, piece.count, piece.rows.len()))
            .collect();
        assert_eq!(told, [(0, 100, 6), (8, 130, 1)]);
    }

    #[test]
    fn a_stage_whose_first_message_is_lost_has_the_pieces_behind_it() {
        let mut recorded = Recorded::new(Stage::Excite, 50);
        recorded.take(&message(2, 52, &[1, 1]));
        let pieces = recorded.pieces();
        assert_eq!((pieces.len(), pieces[0].first, pieces[0].count), (1, 2, 52));
    }
}
