//! Reading columns of arrays in passes over their bytes, some rows at a time.

use super::dtype::Scalar;
use super::strip::Strip;
use std::io::{self, Read};

/// Bytes that a pass holds, if a row is not longer.
const BLOCK: u64 = 1 << 18;

/// Columns that are read by one pass.
pub(crate) struct Pass<'r> {
    reader: Box<dyn Read + 'r>,
    stride: usize,
    columns: Vec<Cell>,
    block: Vec<u8>,
}

/// One column of a pass.
struct Cell {
    output: usize,
    within: usize,
    bytes: usize,
    scalar: Scalar,
    /// The first of its times, in ticks.
    origin: Option<i64>,
}

/// The count of ticks that stands for no time.
const NOT_A_TIME: i64 = i64::MIN;

impl<'r> Pass<'r> {
    /// A pass over rows of `stride` bytes, of which `reader` gives the first.
    pub(crate) fn new(reader: Box<dyn Read + 'r>, stride: usize) -> Self {
        Pass {
            reader,
            stride,
            columns: Vec::new(),
            block: Vec::new(),
        }
    }

    /// Reads a column, too, as the one with the index `output` of what is handed on.
    pub(crate) fn add(&mut self, output: usize, strip: &Strip) -> Option<()> {
        self.columns.push(Cell {
            output,
            within: usize::try_from(strip.within).ok()?,
            bytes: usize::try_from(strip.bytes).ok()?,
            scalar: strip.scalar,
            origin: None,
        });
        Some(())
    }

    /// Appends the next rows to their columns.
    pub(crate) fn rows(&mut self, rows: usize, out: &mut [Vec<f64>]) -> io::Result<()> {
        let at_a_time = (BLOCK / (self.stride as u64).max(1)).max(1);
        let at_a_time = usize::try_from(at_a_time).unwrap_or(1);
        let mut left = rows;
        while left > 0 {
            let now = left.min(at_a_time);
            left -= now;
            self.block.resize(now.saturating_mul(self.stride), 0);
            self.reader.read_exact(&mut self.block)?;
            for cell in &mut self.columns {
                let Some(out) = out.get_mut(cell.output) else {
                    continue;
                };
                let span = cell.within..cell.within.saturating_add(cell.bytes);
                let rows = self.block.chunks_exact(self.stride.max(1));
                out.extend(rows.map(|row| cell.value(row.get(span.clone()).unwrap_or(&[]))));
            }
        }
        Ok(())
    }

    /// Reads what is left, so that a checksum at the end is verified.
    pub(crate) fn finish(mut self) -> io::Result<()> {
        io::copy(&mut self.reader, &mut io::sink()).map(|_| ())
    }
}

impl Cell {
    fn value(&mut self, bytes: &[u8]) -> f64 {
        match self.scalar {
            Scalar::Number(number) => number.value(bytes),
            Scalar::Flag => bytes
                .first()
                .map_or(f64::NAN, |&byte| f64::from(u8::from(byte != 0))),
            Scalar::Ticks {
                big,
                numerator,
                denominator,
            } => {
                let Ok(bytes) = <[u8; 8]>::try_from(bytes) else {
                    return f64::NAN;
                };
                let ticks = if big {
                    i64::from_be_bytes(bytes)
                } else {
                    i64::from_le_bytes(bytes)
                };
                if ticks == NOT_A_TIME {
                    return f64::NAN;
                }
                let origin = *self.origin.get_or_insert(ticks);
                (i128::from(ticks) - i128::from(origin)) as f64 * numerator / denominator
            }
            Scalar::Text => f64::NAN,
        }
    }
}
