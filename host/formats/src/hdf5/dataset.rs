//! A dataset as a variable.

use super::element::{Single, fields, number};
use super::stored::Stored;
use super::tree::{CLASS, MOST_ELEMENTS, Tree, class};
use crate::log::Kind;
use crate::matlab::{Numbers, Records, Value};
use hdf5_reader::{Dataset, Datatype};

/// How much smaller a file may be than what it holds; deflate does no better.
const MOST_PACKED: u64 = 2048;

impl Tree {
    /// A dataset as a variable.
    pub(super) fn dataset(&mut self, dataset: Dataset, depth: usize) -> Value {
        let is_empty = dataset.attribute("MATLAB_empty").is_ok();
        let elements = dataset.num_elements().unwrap_or(0);
        if self.is_full() || is_empty || elements == 0 {
            return Value::Nothing;
        }
        let class = class(dataset.attribute(CLASS));
        let is_object = dataset.attribute("MATLAB_object_decode").is_ok();
        match class.as_deref() {
            Some("char") => return text(&dataset, elements),
            Some("cell") => {
                let depth = depth.checked_sub(1);
                let values = depth.and_then(|depth| self.referred(&dataset, depth));
                return values.map_or(Value::Nothing, Value::Cell);
            }
            Some("function_handle" | "FileWrapper__") => return Value::Nothing,
            Some(class) if is_object => return Value::object(class),
            _ => {}
        }
        if let Datatype::String { .. } | Datatype::VarLen { .. } = dataset.dtype() {
            let text = (elements == 1).then(|| dataset.read_string());
            return match text {
                Some(Ok(text)) => Value::Text(text),
                _ => Value::Nothing,
            };
        }
        let size = hdf5_reader::dtype_element_size(dataset.dtype()).unwrap_or(0) as u64;
        let most = self.bytes.saturating_mul(MOST_PACKED);
        if elements.saturating_mul(size) > most {
            let what = format!("a dataset of {elements} values, more than the file can hold,");
            return Value::unread(what, "copy the file again");
        }
        self.numbers(dataset, elements, class.as_deref())
    }

    fn numbers(&mut self, dataset: Dataset, elements: u64, class: Option<&str>) -> Value {
        let unit = ["units", "unit"]
            .iter()
            .find_map(|name| dataset.attribute(name).ok()?.read_string().ok());
        let mut order: Vec<usize> = (0..dataset.ndim()).collect();
        if self.is_matlab {
            order.reverse();
        }
        let length = |axis: &usize| dataset.shape().get(*axis).copied().unwrap_or(1);
        let lengths: Vec<u64> = order.iter().map(length).collect();
        let axes: Vec<usize> = order.into_iter().filter(|axis| length(axis) != 1).collect();
        let id = self.stored.len();
        if let Some((_, kind)) = number(dataset.dtype()) {
            let only = (elements == 1).then(|| dataset.read_array::<Single>());
            let only = only.and_then(Result::ok);
            self.stored.push(Stored {
                dataset,
                axes,
                fields: None,
            });
            let is_flag = class == Some("logical");
            return Value::Numbers(Numbers {
                axes: lengths,
                kind: if is_flag { Kind::Flag } else { kind },
                unit,
                single: only.and_then(|only| only.first().map(|single| single.0)),
                id,
            });
        }
        if !matches!(dataset.dtype(), Datatype::Compound { .. }) {
            return Value::Nothing;
        }
        let (columns, fields): (Vec<_>, Vec<_>) = fields(dataset.dtype()).into_iter().unzip();
        let names: Vec<&str> = columns.iter().map(|column| &*column.name).collect();
        if matches!(&*names, ["real", "imag"] | ["r", "i"]) {
            return Value::complex();
        }
        if axes.len() > 1 {
            let what = format!("a dataset of records with the axes {lengths:?}");
            return Value::unread(what, "save one record a sample");
        }
        self.stored.push(Stored {
            dataset,
            axes,
            fields: Some(fields),
        });
        Value::Records(Records {
            rows: elements,
            columns,
            id,
        })
    }
}

/// A text of MATLAB: letters of two bytes.
fn text(dataset: &Dataset, elements: u64) -> Value {
    if elements > MOST_ELEMENTS {
        return Value::Nothing;
    }
    let Ok(letters) = dataset.read_array::<Single>() else {
        return Value::Nothing;
    };
    let codes = letters.iter().map(|letter| letter.0 as u16);
    let letters = char::decode_utf16(codes);
    Value::Text(
        letters
            .map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER))
            .collect(),
    )
}
