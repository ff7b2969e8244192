//! A value of JSON taken apart into single values with paths, like `joint.angle[2]`.

use crate::error::FormatFault;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::fmt::{self, Write};

/// A single value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell<'v> {
    /// A number, or a text that stands for one, like `"NaN"`.
    Number(f64),
    /// True or false.
    Flag(bool),
    /// A text.
    Text(&'v str),
    /// `null`.
    Missing,
}

impl<'v> Cell<'v> {
    /// A text, unless it is a number that JSON cannot write.
    pub(crate) fn text(text: &'v str) -> Self {
        match text {
            "NaN" | "nan" => Cell::Number(f64::NAN),
            "Infinity" | "inf" => Cell::Number(f64::INFINITY),
            "-Infinity" | "-inf" => Cell::Number(f64::NEG_INFINITY),
            text => Cell::Text(text),
        }
    }
}

/// Who takes single values.
pub(crate) trait Sink {
    /// Takes the value at `path`.
    fn cell(&mut self, path: &str, cell: Cell<'_>) -> Result<(), FormatFault>;

    /// Keeps why a value was not taken, since errors of serde are texts.
    fn refuse(&mut self, fault: FormatFault);
}

/// Takes the next value apart and gives its parts to a sink.
pub(crate) struct Apart<'a, S> {
    /// The path so far.
    pub(crate) path: &'a mut String,
    /// Who takes the values.
    pub(crate) sink: &'a mut S,
}

impl<S: Sink> Apart<'_, S> {
    fn give<E: Error>(self, cell: Cell<'_>) -> Result<(), E> {
        self.sink.cell(self.path, cell).map_err(|fault| {
            let text = fault.to_string();
            self.sink.refuse(fault);
            E::custom(text)
        })
    }
}

impl<'de, S: Sink> DeserializeSeed<'de> for Apart<'_, S> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<(), D::Error> {
        from.deserialize_any(self)
    }
}

impl<'de, S: Sink> Visitor<'de> for Apart<'_, S> {
    type Value = ();

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a value")
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<(), E> {
        self.give(Cell::Flag(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<(), E> {
        self.give(Cell::Number(value as f64))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<(), E> {
        self.give(Cell::Number(value as f64))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<(), E> {
        self.give(Cell::Number(value))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<(), E> {
        self.give(Cell::text(value))
    }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        self.give(Cell::Missing)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        let before = self.path.len();
        for at in 0_usize.. {
            write!(self.path, "[{at}]").map_err(Error::custom)?;
            let apart = Apart {
                path: &mut *self.path,
                sink: &mut *self.sink,
            };
            let more = list.next_element_seed(apart)?;
            self.path.truncate(before);
            if more.is_none() {
                break;
            }
        }
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let before = self.path.len();
        while let Some(key) = map.next_key::<String>()? {
            if !self.path.is_empty() {
                self.path.push('.');
            }
            self.path.push_str(&key);
            let apart = Apart {
                path: &mut *self.path,
                sink: &mut *self.sink,
            };
            map.next_value_seed(apart)?;
            self.path.truncate(before);
        }
        Ok(())
    }
}
