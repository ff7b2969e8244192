//! The log of one array or several.

use super::header::Header;
use super::pass::Pass;
use super::strip::{Strip, strip};
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::{Log, ROWS_AT_A_TIME, Rows, Table};
use crate::origin::Origin;
use crate::plan::Plan;
use std::collections::HashMap;
use std::io::Read;
use std::ops::ControlFlow;

/// Bytes of a row of a structured array; a longer one is no record of signals.
const LONGEST_ROW: u64 = 1 << 24;

/// Where arrays are.
pub(crate) trait Store {
    /// Begins to read the data of the array with the index `array` at byte `start`.
    fn data(&self, array: usize, start: u64) -> Result<Box<dyn Read + '_>, FormatError>;
}

/// The log of one array or several.
pub(crate) struct Arrays<S> {
    pub(crate) origin: Origin,
    pub(crate) format: Format,
    pub(crate) plan: Plan,
    pub(crate) arrays: Vec<(String, Header)>,
    pub(crate) store: S,
}

impl<S: Store> Arrays<S> {
    /// The passes that read all columns that were asked for.
    fn passes(
        &self,
        table: usize,
        columns: &[usize],
    ) -> Result<(u64, Vec<(String, Pass<'_>)>), FormatError> {
        let (rows, sources) = self.plan.sources(&self.origin, table, columns)?;
        let mut passes = Vec::new();
        // Columns of one array that begin together lie in the same rows.
        let mut begun: HashMap<(usize, u64, u64), usize> = HashMap::new();
        for (output, source) in sources.iter().enumerate() {
            let absent = || self.origin.error("", FormatFault::Absent);
            let (name, header) = self.arrays.get(source.array).ok_or_else(absent)?;
            let column: Strip = strip(header, source).ok_or_else(absent)?;
            if column.stride > LONGEST_ROW {
                let what = format!("an array with {} bytes a row", column.stride);
                let remedy = "save the signals without what else is in a row";
                return Err(self.origin.unsupported(name, what, remedy));
            }
            let key = (source.array, column.start, column.stride);
            let at = match begun.get(&key) {
                Some(&at) => at,
                None => {
                    let reader = self.store.data(source.array, column.start)?;
                    let stride = usize::try_from(column.stride).map_err(|_| absent())?;
                    passes.push((name.clone(), Pass::new(reader, stride)));
                    begun.insert(key, passes.len() - 1);
                    passes.len() - 1
                }
            };
            let (_, pass) = passes.get_mut(at).ok_or_else(absent)?;
            pass.add(output, &column).ok_or_else(absent)?;
        }
        Ok((rows, passes))
    }
}

impl<S: Store> Log for Arrays<S> {
    fn format(&self) -> Format {
        self.format
    }

    fn tables(&self) -> &[Table] {
        &self.plan.tables
    }

    fn facts(&self) -> &[(String, String)] {
        &self.plan.facts
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let (rows, mut passes) = self.passes(table, columns)?;
        if columns.is_empty() {
            return Ok(());
        }
        let failed = |name: &str, error| self.origin.failed_read(name, "the values", error);
        let mut out = vec![Vec::new(); columns.len()];
        let mut left = rows;
        while left > 0 {
            let now = usize::try_from(left).map_or(ROWS_AT_A_TIME, |left| left.min(ROWS_AT_A_TIME));
            left -= now as u64;
            out.iter_mut().for_each(Vec::clear);
            for (name, pass) in &mut passes {
                pass.rows(now, &mut out)
                    .map_err(|error| failed(name, error))?;
            }
            if each(&out).is_break() {
                return Ok(());
            }
        }
        for (name, pass) in passes {
            pass.finish().map_err(|error| failed(&name, error))?;
        }
        Ok(())
    }
}
