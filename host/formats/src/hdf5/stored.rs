//! A dataset whose rows are read some at a time.

use super::element::{Field, Record, Single};
use crate::log::ROWS_AT_A_TIME;
use crate::plan::{Along, Source};
use hdf5_reader::error::Result;
use hdf5_reader::{Dataset, SliceInfo, SliceInfoElem};

/// Values that are read at a time.
const BLOCK: u64 = 1 << 20;
/// Rows that are read at a time, so that a chunk is not unpacked again and again.
const MOST_ROWS: u64 = 1 << 16;

/// A dataset, and how its axes are to be understood.
pub(crate) struct Stored {
    /// The dataset.
    pub(crate) dataset: Dataset,
    /// Its axes that have more than one element, in the order in which they are named: MATLAB
    /// names the axis first that changes fastest.
    pub(crate) axes: Vec<usize>,
    /// Where the columns of its records are; `None` for a dataset of numbers.
    pub(crate) fields: Option<Vec<Option<Field>>>,
}

impl Stored {
    fn axis(&self, source: &Source) -> (Option<usize>, Option<usize>) {
        let (first, second) = (self.axes.first().copied(), self.axes.get(1).copied());
        match source.along {
            Along::First => (first, second),
            Along::Second => (second, first),
        }
    }

    /// Rows that are well read at a time.
    pub(crate) fn rows_at_a_time(&self, source: &Source) -> u64 {
        let (time, across) = self.axis(source);
        let length = |axis: usize| self.dataset.shape().get(axis).copied();
        let chunk = |axis: usize| Some(u64::from(*self.dataset.chunks()?.get(axis)?));
        let width = match across {
            // What lies between the rows is read with them.
            Some(across) if Some(across) > time => length(across).unwrap_or(1),
            _ => 1,
        };
        let chunk = time.and_then(chunk).unwrap_or(0);
        chunk
            .clamp(ROWS_AT_A_TIME as u64, MOST_ROWS)
            .min((BLOCK / width.max(1)).max(1))
    }

    /// Appends rows of some columns, of which each comes with its place in `out`.
    pub(crate) fn rows(
        &self,
        columns: &[(usize, Source)],
        start: u64,
        end: u64,
        out: &mut [Vec<f64>],
    ) -> Result<()> {
        if let Some(fields) = &self.fields {
            return self.records(fields, columns, start, end, out);
        }
        for of_axis in columns.chunk_by(|(_, a), (_, b)| a.along == b.along) {
            let Some((_, source)) = of_axis.first() else {
                continue;
            };
            match self.axis(source) {
                (time, Some(across)) if Some(across) > time => {
                    self.together(of_axis, time, across, start, end, out)?;
                }
                (time, across) => self.apart(of_axis, time, across, start, end, out)?,
            }
        }
        Ok(())
    }

    /// Columns that lie between each other's rows.
    fn together(
        &self,
        columns: &[(usize, Source)],
        time: Option<usize>,
        across: usize,
        start: u64,
        end: u64,
        out: &mut [Vec<f64>],
    ) -> Result<()> {
        let first = columns.iter().map(|(_, source)| source.column).min();
        let last = columns.iter().map(|(_, source)| source.column).max();
        let (first, last) = (first.unwrap_or(0), last.unwrap_or(0));
        let width = (last - first + 1) as usize;
        let across = (across, first, last + 1);
        let block = self.slice(time, start, end, Some(across))?;
        for (output, source) in columns {
            let skipped = (source.column - first) as usize;
            if let Some(out) = out.get_mut(*output) {
                out.extend(block.iter().skip(skipped).step_by(width));
            }
        }
        Ok(())
    }

    /// Columns that lie one behind the other.
    fn apart(
        &self,
        columns: &[(usize, Source)],
        time: Option<usize>,
        across: Option<usize>,
        start: u64,
        end: u64,
        out: &mut [Vec<f64>],
    ) -> Result<()> {
        for (output, source) in columns {
            let column = source.column;
            let across = across.map(|axis| (axis, column, column + 1));
            let block = self.slice(time, start, end, across)?;
            if let Some(out) = out.get_mut(*output) {
                out.extend(block);
            }
        }
        Ok(())
    }

    fn slice(
        &self,
        time: Option<usize>,
        start: u64,
        end: u64,
        across: Option<(usize, u64, u64)>,
    ) -> Result<Vec<f64>> {
        let selection = self.selection(time, start, end, across);
        let block = self.dataset.read_slice::<Single>(&selection)?;
        Ok(block.iter().map(|single| single.0).collect())
    }

    fn records(
        &self,
        fields: &[Option<Field>],
        columns: &[(usize, Source)],
        start: u64,
        end: u64,
        out: &mut [Vec<f64>],
    ) -> Result<()> {
        let selection = self.selection(self.axes.first().copied(), start, end, None);
        let block = self.dataset.read_slice::<Record>(&selection)?;
        for (output, source) in columns {
            let field = fields.get(source.column as usize).copied().flatten();
            if let (Some(out), Some(field)) = (out.get_mut(*output), field) {
                out.extend(block.iter().map(|record| field.value(record)));
            }
        }
        Ok(())
    }

    fn selection(
        &self,
        time: Option<usize>,
        start: u64,
        end: u64,
        across: Option<(usize, u64, u64)>,
    ) -> SliceInfo {
        let part = |axis| match across {
            _ if Some(axis) == time => (start, end),
            Some((other, first, last)) if axis == other => (first, last),
            _ => (0, 1),
        };
        let slice = |axis| {
            let (start, end) = part(axis);
            SliceInfoElem::Slice {
                start,
                end,
                step: 1,
            }
        };
        SliceInfo {
            selections: (0..self.dataset.ndim()).map(slice).collect(),
        }
    }
}
