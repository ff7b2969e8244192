//! The samples of a recording as they are read.

use std::collections::TryReserveError;

use super::cells::Sample;
use super::csv_file::MAX_ROWS;
use super::read_error::ReadFault;
use crate::channel::{Measured, PerMeasured};

/// Columns beside those that every recording has.
#[derive(Clone, Debug, Default)]
pub(super) struct Further {
    pub(super) measured: Vec<Measured>,
    pub(super) enabled: bool,
}

/// The columns as they grow, of equal length. A column that has nothing in a row holds its last value.
#[derive(Clone, Debug, Default)]
pub(super) struct Samples {
    pub(super) time_s: Vec<f64>,
    pub(super) command: Vec<f64>,
    /// NaN in a row that tells no angle.
    pub(super) counts: Vec<f64>,
    /// NaN before the first row that tells it.
    pub(super) measured: PerMeasured<Option<Vec<f64>>>,
    pub(super) enabled: Option<Vec<bool>>,
    /// Rows whose command is that of a row before.
    pub(super) held_commands: u64,
}

impl Samples {
    pub(super) fn new(further: &Further) -> Self {
        let mut samples = Samples {
            enabled: further.enabled.then(Vec::new),
            ..Samples::default()
        };
        for channel in &further.measured {
            samples.measured[*channel] = Some(Vec::new());
        }
        samples
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Takes the next sample; one without a command before the first that has one is left out.
    pub(super) fn push(&mut self, sample: &Sample) -> Result<(), ReadFault> {
        if self.time_s.len() == MAX_ROWS {
            return Err(ReadFault::TooManyRows { limit: MAX_ROWS });
        }
        let Some(command) = sample.command.or(self.command.last().copied()) else {
            return Ok(());
        };
        self.held_commands += u64::from(sample.command.is_none());
        self.try_push(sample, command)
            .map_err(|_| ReadFault::OutOfMemory)
    }

    fn try_push(&mut self, sample: &Sample, command: f64) -> Result<(), TryReserveError> {
        append(&mut self.time_s, sample.time_s)?;
        append(&mut self.command, command)?;
        append(&mut self.counts, sample.counts.unwrap_or(f64::NAN))?;
        for channel in Measured::ALL {
            if let Some(values) = &mut self.measured[channel] {
                let last = values.last().copied().unwrap_or(f64::NAN);
                append(values, sample.measured[channel].unwrap_or(last))?;
            }
        }
        if let Some(values) = &mut self.enabled {
            let last = values.last().copied().unwrap_or(true);
            append(values, sample.enabled.unwrap_or(last))?;
        }
        Ok(())
    }

    /// Gives the last sample the time half-way from that of the sample before to `now`.
    pub(super) fn move_last_before(&mut self, now: f64) {
        if let [.., before, last] = &mut self.time_s[..] {
            *last = 0.5 * (*before + now);
        } else {
            self.pop();
        }
    }

    /// Takes samples behind its own.
    pub(super) fn extend(&mut self, other: Samples) {
        self.time_s.extend(other.time_s);
        self.command.extend(other.command);
        self.counts.extend(other.counts);
        let columns = self.measured.0.iter_mut().zip(other.measured.0);
        for (own, other) in columns {
            if let (Some(own), Some(other)) = (own, other) {
                own.extend(other);
            }
        }
        if let (Some(own), Some(other)) = (&mut self.enabled, other.enabled) {
            own.extend(other);
        }
        self.held_commands += other.held_commands;
    }

    /// Takes the last sample out again.
    pub(super) fn pop(&mut self) {
        self.time_s.pop();
        self.command.pop();
        self.counts.pop();
        let columns = self.measured.0.iter_mut().flatten();
        columns.for_each(|column| {
            column.pop();
        });
        if let Some(enabled) = &mut self.enabled {
            enabled.pop();
        }
    }

    /// The samples from one index to another.
    pub(super) fn rows(&self, rows: std::ops::Range<usize>) -> Self {
        let some = |values: &[f64]| values[rows.clone()].to_vec();
        Samples {
            time_s: some(&self.time_s),
            command: some(&self.command),
            counts: some(&self.counts),
            measured: self.measured.rows(&rows),
            enabled: self.enabled.as_ref().map(|all| all[rows.clone()].to_vec()),
            held_commands: 0,
        }
    }

    /// Keeps some of the samples.
    pub(super) fn keep(&mut self, keep: &[bool]) {
        fn kept<T: Copy>(values: &mut Vec<T>, keep: &[bool]) {
            let mut keep = keep.iter();
            values.retain(|_| keep.next().copied().unwrap_or(false));
        }
        kept(&mut self.time_s, keep);
        kept(&mut self.command, keep);
        kept(&mut self.counts, keep);
        for column in self.measured.0.iter_mut().flatten() {
            kept(column, keep);
        }
        if let Some(enabled) = &mut self.enabled {
            kept(enabled, keep);
        }
    }
}

/// Pushes where memory allows it; a plain push would abort the program.
fn append<T>(values: &mut Vec<T>, value: T) -> Result<(), TryReserveError> {
    values.try_reserve(1)?;
    values.push(value);
    Ok(())
}
