//! A variable of a MATLAB file of level 5, taken apart without reading its numbers.

use super::parts::{axes, letters, part, text, word};
use super::stream::{MATRIX, Stream, Tag, damaged};
use super::value::{Fields, Numbers, Value};
use crate::log::Kind;
use crate::number::Number;
use crate::window::Window;
use std::io;

/// Depth to which structs are nested.
const DEEPEST: usize = 64;
/// Parts of all variables together.
const MOST_PARTS: usize = 1 << 20;
const COMPLEX: u32 = 0x800;
const LOGICAL: u32 = 0x200;

/// Where the numbers of an array are.
#[derive(Clone, Debug)]
pub(crate) struct Place {
    /// The variable's elements.
    pub(crate) window: Window,
    /// Whether they are compressed.
    pub(crate) is_packed: bool,
    /// Where in them the numbers begin.
    pub(crate) start: u64,
    /// How a number is written.
    pub(crate) number: Number,
    /// The name of the variable, for errors.
    pub(crate) variable: usize,
    /// The length along each axis.
    pub(crate) axes: Vec<u64>,
}

/// Takes variables apart.
#[derive(Debug, Default)]
pub(crate) struct Found {
    /// The arrays of numbers.
    pub(crate) places: Vec<Place>,
    parts: usize,
}

/// The variable that is being taken apart.
#[derive(Clone, Debug)]
pub(crate) struct Variable {
    /// Its elements.
    pub(crate) window: Window,
    /// Whether they are compressed.
    pub(crate) is_packed: bool,
    /// Its number.
    pub(crate) index: usize,
}

impl Found {
    /// Reads a variable, whose tag is next, with its name.
    pub(crate) fn variable(
        &mut self,
        stream: &mut Stream,
        of: &Variable,
    ) -> io::Result<(String, Value)> {
        let tag = stream.tag(u64::MAX)?;
        if tag.kind != MATRIX {
            return Ok((String::new(), Value::Nothing));
        }
        self.matrix(stream, tag, of, DEEPEST)
    }

    fn matrix(
        &mut self,
        stream: &mut Stream,
        tag: Tag,
        of: &Variable,
        depth: usize,
    ) -> io::Result<(String, Value)> {
        self.parts += 1;
        let depth = depth
            .checked_sub(1)
            .filter(|_| self.parts <= MOST_PARTS)
            .ok_or_else(|| damaged("it has too many parts, or they are nested too deep"))?;
        if tag.bytes == 0 {
            return Ok((String::new(), Value::Nothing));
        }
        let end = tag.start.saturating_add(tag.bytes);
        let flags = part(stream, end)?;
        let flags = word(&flags, stream.big).ok_or_else(|| damaged("an array has no class"))?;
        let class = flags & 0xff;
        if class == 17 {
            let name = text(&part(stream, end)?);
            let _system = part(stream, end)?;
            let class = text(&part(stream, end)?);
            return Ok((name, Value::object(&class)));
        }
        let axes = axes(&part(stream, end)?, stream.big)?;
        let name = text(&part(stream, end)?);
        let elements = axes
            .iter()
            .try_fold(1_u64, |elements, &length| elements.checked_mul(length))
            .ok_or_else(|| damaged("an array has too many elements"))?;
        let value = match class {
            1 => {
                let mut cells = Vec::new();
                for _ in 0..elements {
                    cells.push(self.inner(stream, end, of, depth)?);
                }
                Value::Cell(cells)
            }
            2 => self.structs(stream, end, of, depth, elements)?,
            3 => {
                let _class = part(stream, end)?;
                self.structs(stream, end, of, depth, elements)?
            }
            4 => letters(stream, end, &axes)?,
            5 => Value::unread("a sparse matrix", "save full(x)"),
            6..=15 if flags & COMPLEX != 0 => Value::complex(),
            6..=15 if elements == 0 => Value::Nothing,
            6..=15 => {
                let is_flag = flags & LOGICAL != 0;
                self.numbers(stream, end, of, axes, elements, is_flag)?
            }
            16 => Value::Nothing,
            class => return Err(damaged(format!("there is no class {class} of arrays"))),
        };
        Ok((name, value))
    }

    /// Reads the next element, an array within another one.
    fn inner(
        &mut self,
        stream: &mut Stream,
        end: u64,
        of: &Variable,
        depth: usize,
    ) -> io::Result<Value> {
        let tag = stream.tag(end)?;
        if tag.kind != MATRIX {
            return Err(damaged("an array holds what is none"));
        }
        let (_, value) = self.matrix(stream, tag, of, depth)?;
        stream.go_to(tag.next)?;
        Ok(value)
    }

    fn structs(
        &mut self,
        stream: &mut Stream,
        end: u64,
        of: &Variable,
        depth: usize,
        elements: u64,
    ) -> io::Result<Value> {
        let length = word(&part(stream, end)?, stream.big).unwrap_or(0);
        let names = part(stream, end)?;
        let length = usize::try_from(length).unwrap_or(0);
        if length == 0 || names.is_empty() {
            return Ok(Value::Nothing);
        }
        let names: Vec<String> = names.chunks_exact(length).map(text).collect();
        let mut structs = Vec::new();
        if names.is_empty() {
            return Ok(Value::Nothing);
        }
        for _ in 0..elements {
            let mut fields = Fields::new();
            for name in &names {
                fields.push((name.clone(), self.inner(stream, end, of, depth)?));
            }
            structs.push(fields);
        }
        Ok(Value::Struct(structs))
    }

    fn numbers(
        &mut self,
        stream: &mut Stream,
        end: u64,
        of: &Variable,
        axes: Vec<u64>,
        elements: u64,
        is_flag: bool,
    ) -> io::Result<Value> {
        let tag = stream.tag(end)?;
        let number = tag
            .number(stream.big)
            .ok_or_else(|| damaged("an array of numbers holds none"))?;
        let width = number.class.bytes() as u64;
        if elements.checked_mul(width) != Some(tag.bytes) {
            return Err(damaged("an array has not as many numbers as its axes say"));
        }
        let single = if elements == 1 {
            Some(number.value(&stream.data(tag, width)?))
        } else {
            None
        };
        self.places.push(Place {
            window: of.window.clone(),
            is_packed: of.is_packed,
            start: tag.start,
            number,
            variable: of.index,
            axes: axes.clone(),
        });
        Ok(Value::Numbers(Numbers {
            axes,
            kind: if is_flag { Kind::Flag } else { Kind::Number },
            unit: None,
            single,
            id: self.places.len() - 1,
        }))
    }
}
