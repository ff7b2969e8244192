//! The data of a run: rows for the host, and the recording that the device fits.

use heapless::Vec;
use shared::trace::{OPEN, Trace};
use shared::wire::{MOST_ROWS, Row, Rows, Stage};

/// Rows of a message. A message of [`MOST_ROWS`] takes a core without a floating-point unit nearly a control period to
/// encode and to send, beside what the period itself needs; a third of them leaves it most of the period.
const ROWS: usize = 8;
const _: () = assert!(ROWS <= MOST_ROWS);

/// Rows under way to the host.
#[derive(Debug)]
pub struct Batch {
    run: u32,
    stage: Stage,
    first: u32,
    count: i32,
    rows: Vec<Row, MOST_ROWS>,
}

impl Batch {
    /// At the start of a stage of a run, with the shaft at `count`.
    pub fn new(run: u32, stage: Stage, count: i32) -> Self {
        Batch {
            run,
            stage,
            first: 0,
            count,
            rows: Vec::new(),
        }
    }

    /// Rows of the recording once more, from `first` on; where the shaft stood is known from the first time.
    pub fn resumed(run: u32, first: u32) -> Self {
        Batch {
            first,
            ..Batch::new(run, Stage::Record, 0)
        }
    }

    /// Takes a row, and gives the message that it fills.
    pub fn push(&mut self, row: Row) -> Option<Rows> {
        let _ = self.rows.push(row);
        if self.rows.len() >= ROWS {
            self.take()
        } else {
            None
        }
    }

    /// The rows so far, if there are any.
    pub fn take(&mut self) -> Option<Rows> {
        if self.rows.is_empty() {
            return None;
        }
        let rows = core::mem::take(&mut self.rows);
        let message = Rows {
            run: self.run,
            stage: self.stage,
            first: self.first,
            count: self.count,
            rows,
        };
        self.first += message.rows.len() as u32;
        for row in &message.rows {
            self.count = self.count.wrapping_add(row.step.into());
        }
        Some(message)
    }
}

/// Periods that the device keeps to fit.
#[derive(Debug)]
pub struct Recording<const N: usize> {
    duties: [i16; N],
    steps: [i16; N],
    len: usize,
    /// Periods before the first with an open bridge.
    closed: usize,
}

impl<const N: usize> Default for Recording<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Recording<N> {
    /// Empty.
    pub const fn new() -> Self {
        Recording {
            duties: [0; N],
            steps: [0; N],
            len: 0,
            closed: 0,
        }
    }

    /// Forgets everything.
    pub fn clear(&mut self) {
        self.len = 0;
        self.closed = 0;
    }

    /// Keeps a period, while there is room.
    pub fn push(&mut self, duty: i16, step: i16) {
        if let (Some(d), Some(s)) = (self.duties.get_mut(self.len), self.steps.get_mut(self.len)) {
            (*d, *s) = (duty, step);
            if duty != OPEN && self.closed == self.len {
                self.closed += 1;
            }
            self.len += 1;
        }
    }

    /// The recorded trace.
    pub fn trace(&self) -> Trace<'_> {
        Trace {
            duties: self.duties.get(..self.len).unwrap_or(&[]),
            steps: self.steps.get(..self.len).unwrap_or(&[]),
            closed: self.closed,
        }
    }
}
