//! Variables of MATLAB as a tree, and what groups and datasets of HDF5 are in its terms.

use crate::log::{Column, Kind};

/// Fields with their names, in their order.
pub(crate) type Fields = Vec<(String, Value)>;

/// A variable, a field or an element of a cell array.
#[derive(Clone, Debug)]
pub(crate) enum Value {
    /// An array of numbers.
    Numbers(Numbers),
    /// A list of records, which have columns of their own.
    Records(Records),
    /// A text.
    Text(String),
    /// A struct array; a struct is one of one element.
    Struct(Vec<Fields>),
    /// A cell array.
    Cell(Vec<Value>),
    /// What is not read here.
    Unread(Unread),
    /// Nothing that a table could hold.
    Nothing,
}

/// An array of numbers.
#[derive(Clone, Debug)]
pub(crate) struct Numbers {
    /// Its length along each axis.
    pub(crate) axes: Vec<u64>,
    /// Whether they are numbers or flags.
    pub(crate) kind: Kind,
    /// Their unit.
    pub(crate) unit: Option<String>,
    /// The value, if it is a single one.
    pub(crate) single: Option<f64>,
    /// The reader's own number of it.
    pub(crate) id: usize,
}

/// A list of records.
#[derive(Clone, Debug)]
pub(crate) struct Records {
    /// Records.
    pub(crate) rows: u64,
    /// The columns.
    pub(crate) columns: Vec<Column>,
    /// The reader's own number of it.
    pub(crate) id: usize,
}

/// What is not read here.
#[derive(Clone, Debug)]
pub(crate) struct Unread {
    /// What it is.
    pub(crate) what: String,
    /// What the user can do.
    pub(crate) remedy: String,
}

impl Value {
    /// What is not read here.
    pub(crate) fn unread(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        let (what, remedy) = (what.into(), remedy.into());
        Value::Unread(Unread { what, remedy })
    }

    /// Complex numbers.
    pub(crate) fn complex() -> Self {
        Value::unread("an array of complex numbers", "save real(x) and imag(x)")
    }

    /// An object of a class of MATLAB, which only MATLAB can decode.
    pub(crate) fn object(class: &str) -> Self {
        let remedy = match class {
            "timeseries" => "save it as a struct: s = struct('time', ts.Time, 'data', ts.Data)",
            "table" => "save it as a struct: s = table2struct(T, 'ToScalar', true)",
            "timetable" => {
                "save it as a struct: s = table2struct(timetable2table(T), 'ToScalar', true), \
                 with its times as seconds(t)"
            }
            "duration" => "save it as numbers: seconds(d)",
            "datetime" => "save it as numbers: posixtime(t)",
            "string" => "save it as char(s)",
            _ => {
                "save its numbers as arrays or in a struct; a signal of Simulink in the format \
                 \"Structure With Time\""
            }
        };
        Value::unread(format!("an object of MATLAB's class `{class}`"), remedy)
    }
}
