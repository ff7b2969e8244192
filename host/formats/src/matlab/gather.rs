//! The numbers of arrays, gathered in one pass over each variable.
//!
//! A variable is compressed as a whole, its fields one after the other, so that columns that were
//! sampled together are far apart in it: those that are asked for are held.

use super::matrix::Place;
use super::stream::Stream;
use crate::error::FormatFault;
use crate::plan::Along;
use crate::together;

/// Numbers that are read at a time.
const BLOCK: u64 = 8192;
/// Numbers that are held.
const MOST: u64 = 1 << 28;

/// A column that is asked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wanted<'p> {
    /// Its index in what is handed on.
    pub(crate) output: usize,
    /// Which column of its array.
    pub(crate) column: u64,
    /// Which axis of the array is time.
    pub(crate) along: Along,
    /// The array.
    pub(crate) place: &'p Place,
}

/// Gathers columns; an error comes with the index of the variable.
pub(crate) fn gather(
    mut wanted: Vec<Wanted<'_>>,
    outputs: usize,
    big: bool,
) -> Result<Vec<Vec<f64>>, (usize, FormatFault)> {
    let mut out = vec![Vec::new(); outputs];
    let mut held = 0;
    wanted.sort_by_key(|wanted| (wanted.place.variable, wanted.place.start));
    let mut left = wanted.as_slice();
    while let Some(first) = left.first() {
        let variable = first.place.variable;
        let end = left
            .iter()
            .position(|wanted| wanted.place.variable != variable)
            .unwrap_or(left.len());
        let (of_it, others) = left.split_at(end);
        left = others;
        let mut stream = Stream::new(first.place.window.clone(), first.place.is_packed, big);
        let arrays = of_it.chunk_by(|a, b| a.place.start == b.place.start);
        for columns in arrays {
            array(columns, &mut stream, &mut out, &mut held).map_err(|fault| (variable, fault))?;
        }
        stream.finish().map_err(|error| (variable, error.into()))?;
    }
    Ok(out)
}

/// Reads the columns of one array.
fn array(
    columns: &[Wanted<'_>],
    stream: &mut Stream,
    out: &mut [Vec<f64>],
    held: &mut u64,
) -> Result<(), FormatFault> {
    let Some(place) = columns.first().map(|wanted| wanted.place) else {
        return Ok(());
    };
    let [rows, width] = together::shape(&place.axes).unwrap_or([0, 0]);
    let elements = rows.saturating_mul(width);
    let bytes = place.number.class.bytes();
    // In the order of the file, the first axis changes fastest.
    let picks = |wanted: &Wanted<'_>| match wanted.along {
        Along::First => (wanted.column * rows, 1, (wanted.column + 1) * rows),
        Along::Second => (wanted.column, rows, elements),
    };
    let needed = columns.iter().map(|wanted| picks(wanted).2).max();
    let needed = needed.unwrap_or(0).min(elements);
    stream.go_to(place.start)?;
    let mut block = Vec::new();
    let mut at = 0;
    while at < needed {
        let now = BLOCK.min(needed - at);
        block.resize(usize::try_from(now).unwrap_or(0).saturating_mul(bytes), 0);
        stream.fill(&mut block)?;
        for wanted in columns {
            let (first, step, end) = picks(wanted);
            let Some(out) = out.get_mut(wanted.output) else {
                continue;
            };
            let skipped = at.saturating_sub(first).div_ceil(step.max(1));
            let mut next = first + skipped * step;
            while next < end.min(at + now) {
                let byte = usize::try_from(next - at)
                    .unwrap_or(0)
                    .saturating_mul(bytes);
                let number = block.get(byte..byte.saturating_add(bytes));
                out.push(place.number.value(number.unwrap_or(&[])));
                next += step.max(1);
                *held += 1;
            }
        }
        if *held > MOST {
            return Err(FormatFault::TooLarge {
                what: "what is asked for".to_owned(),
                limit: MOST * 8,
            });
        }
        at += now;
    }
    Ok(())
}
