//! The tables of variables.

use super::simulink;
use super::value::{Fields, Numbers, Records, Value};
use crate::error::FormatFault;
use crate::plan::{Along, Plan, Source, join};
use crate::together::{self, Array};

/// Makes tables of variables.
pub(crate) struct Tables {
    /// The tables.
    pub(crate) plan: Plan,
    /// What stands between the names of a path.
    pub(crate) separator: &'static str,
}

impl Tables {
    /// Adds the variables, or the fields of the struct at `path`.
    pub(crate) fn fields(&mut self, path: &str, fields: Fields) -> Result<(), FormatFault> {
        let mut arrays = simulink::signals(&fields).unwrap_or_default();
        let is_simulink = !arrays.is_empty();
        let units = units(&fields);
        let mut structs = Vec::new();
        // Elements of a cell array stand beside the fields: they may be signals of one length.
        let mut left: Vec<(String, Value)> = fields.into_iter().rev().collect();
        while let Some((name, value)) = left.pop() {
            let whole = join(path, self.separator, &name);
            match value {
                Value::Nothing => {}
                Value::Text(text) => self.plan.fact(whole, text),
                Value::Unread(unread) => self.plan.unread(whole, unread.what, unread.remedy),
                Value::Records(records) => self.records(whole, records)?,
                Value::Struct(_) if is_simulink && name == simulink::SIGNALS => {}
                Value::Numbers(_) if is_simulink && name == simulink::TIME => {}
                Value::Struct(elements) => structs.push((whole, elements)),
                Value::Cell(values) => {
                    let name = |at| format!("{name}[{at}]");
                    let elements = values.into_iter().enumerate().rev();
                    left.extend(elements.map(|(at, value)| (name(at), value)));
                }
                Value::Numbers(numbers) => {
                    let unit = units.iter().find(|(of, _)| *of == name);
                    let unit = unit.map(|(_, unit)| unit.clone());
                    arrays.extend(self.numbers(name, whole, numbers, unit));
                }
            }
        }
        together::add(&mut self.plan, path, self.separator, arrays)?;
        for (path, mut elements) in structs {
            if elements.len() == 1 {
                self.fields(&path, elements.pop().unwrap_or_default())?;
                continue;
            }
            for (at, fields) in elements.into_iter().enumerate() {
                self.fields(&format!("{path}[{at}]"), fields)?;
            }
        }
        Ok(())
    }

    /// The array of some numbers, unless they are a single one or have more than two axes.
    fn numbers(
        &mut self,
        name: String,
        path: String,
        numbers: Numbers,
        unit: Option<String>,
    ) -> Option<Array> {
        if let Some(single) = numbers.single {
            self.plan.fact(path, single.to_string());
            return None;
        }
        let Some(shape) = together::shape(&numbers.axes) else {
            self.plan.unread(
                path,
                format!("an array with the axes {:?}", numbers.axes),
                "reshape it to one row a sample, for instance `reshape(x, [], size(x, 3))'`",
            );
            return None;
        };
        Some(Array {
            name,
            shape,
            kind: numbers.kind,
            unit: numbers.unit.or(unit),
            id: numbers.id,
        })
    }

    fn records(&mut self, path: String, records: Records) -> Result<(), FormatFault> {
        if records.rows == 0 {
            return Ok(());
        }
        let columns = records.columns.into_iter().zip(0..).map(|(shown, column)| {
            let source = Source {
                array: records.id,
                column,
                along: Along::First,
                kind: shown.kind,
            };
            (shown, source)
        });
        self.plan.table(path, records.rows, columns.collect())
    }
}

/// The units that a `timeseries` turned into a struct has beside its fields: `Time` has that of
/// `TimeInfo.Units`, and `Data` that of `DataInfo.Units`.
fn units(fields: &Fields) -> Vec<(String, String)> {
    let unit = |(name, value): &(String, Value)| {
        let of = name.strip_suffix("Info")?;
        let Value::Struct(elements) = value else {
            return None;
        };
        let info = elements.first()?;
        let units = info.iter().find(|(name, _)| name == "Units")?;
        match &units.1 {
            Value::Text(unit) if !unit.is_empty() => Some((of.to_owned(), unit.clone())),
            _ => None,
        }
    };
    fields.iter().filter_map(unit).collect()
}
