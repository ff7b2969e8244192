//! Messages of ROS 2 and ROS 1, decoded by their definition.

mod cdr;
mod parse;
mod schema;

pub(super) use schema::Schema;

use crate::batch::Value;
use crate::log::Kind;
use crate::shape::{Give, MOST_ELEMENTS, Room, Shape};
use cdr::Cdr;
use schema::{Count, Field, Type};

/// Lists of texts with these names say which joint each element of the lists beside them and below is of.
const NAMES: [&str; 3] = ["name", "names", "joint_names"];

/// Gives the values of a message; `None` where it is not what the definition says.
pub(super) fn decode(
    schema: &Schema,
    message: &[u8],
    shape: &mut Shape,
    room: &mut Room,
    give: Give<'_>,
) -> Option<()> {
    let cdr = if schema.is_ros1 {
        Cdr::ros1(message)
    } else {
        Cdr::ros2(message)?
    };
    let mut decoder = Decoder {
        cdr,
        schema,
        room,
        give,
    };
    decoder.message(0, Some(shape), &[])
}

struct Decoder<'s, 'm, 'g> {
    cdr: Cdr<'m>,
    schema: &'s Schema,
    room: &'g mut Room,
    give: Give<'g>,
}

impl<'m> Decoder<'_, 'm, '_> {
    fn message(
        &mut self,
        number: usize,
        mut shape: Option<&mut Shape>,
        names: &[&'m str],
    ) -> Option<()> {
        let fields = self.schema.messages.get(number)?;
        if fields.is_empty() && !self.schema.is_ros1 {
            // ROS 2 writes one byte where nothing would be.
            self.cdr.u8()?;
        }
        let (mut own, mut has_own) = (Vec::new(), false);
        for (at, field) in fields.iter().enumerate() {
            let part = match &mut shape {
                Some(shape) => shape.part(&field.name, at, self.room),
                None => None,
            };
            let names = if has_own { &own } else { names };
            let count = match field.count {
                Count::One => {
                    self.value(field.kind, part, names)?;
                    continue;
                }
                Count::Fixed(count) => count,
                Count::Any => self.cdr.length()?,
            };
            if field.kind == Type::Text {
                let texts = self.texts(count, part)?;
                if NAMES.contains(&field.name.as_str()) {
                    (own, has_own) = (texts, true);
                }
                continue;
            }
            self.elements(field, count, part, names)?;
        }
        Some(())
    }

    fn texts(&mut self, count: usize, part: Option<&mut Shape>) -> Option<Vec<&'m str>> {
        if count > self.cdr.left() {
            return None;
        }
        let texts: Option<Vec<&str>> = (0..count)
            .map(|_| {
                self.cdr
                    .text()
                    .map(|text| str::from_utf8(text).unwrap_or("?"))
            })
            .collect();
        if let Some(part) = part {
            part.text(self.room);
        }
        texts
    }

    fn elements(
        &mut self,
        field: &Field,
        count: usize,
        mut part: Option<&mut Shape>,
        names: &[&'m str],
    ) -> Option<()> {
        if count > self.cdr.left() {
            return None;
        }
        let size = field.kind.size();
        if count > MOST_ELEMENTS
            && let Some(part) = &mut part
        {
            part.text(self.room);
        }
        if let (Some(size), None | Some(Shape::Leaf { .. })) = (size, &part) {
            return self.cdr.skip(count, size);
        }
        let are_named = field.count == Count::Any && names.len() == count && count <= MOST_ELEMENTS;
        for at in 0..count {
            let name = names.get(at).copied().filter(|_| are_named);
            let element = match &mut part {
                Some(part) => part.element_of(name, at, self.room),
                None => None,
            };
            self.value(field.kind, element, names)?;
        }
        Some(())
    }

    fn value(&mut self, kind: Type, shape: Option<&mut Shape>, names: &[&'m str]) -> Option<()> {
        let cdr = &mut self.cdr;
        let (kind, value) = match kind {
            Type::Message(number) => return self.message(number, shape, names),
            Type::Text => {
                cdr.text()?;
                if let Some(shape) = shape {
                    shape.text(self.room);
                }
                return Some(());
            }
            Type::Bool => (
                Kind::Flag,
                Value::Number(f64::from(u8::from(cdr.u8()? != 0))),
            ),
            Type::I8 => number(f64::from(cdr.i8()?)),
            Type::U8 => number(f64::from(cdr.u8()?)),
            Type::I16 => number(f64::from(cdr.i16()?)),
            Type::U16 => number(f64::from(cdr.u16()?)),
            Type::I32 => number(f64::from(cdr.i32()?)),
            Type::U32 => number(f64::from(cdr.u32()?)),
            Type::I64 => number(cdr.i64()? as f64),
            Type::U64 => number(cdr.u64()? as f64),
            Type::F32 => number(f64::from(cdr.f32()?)),
            Type::F64 => number(cdr.f64()?),
            Type::Time => {
                let seconds = if self.schema.is_ros1 {
                    i128::from(cdr.u32()?)
                } else {
                    i128::from(cdr.i32()?)
                };
                let since = seconds * 1_000_000_000 + i128::from(cdr.u32()?);
                (Kind::Time, Value::Nanoseconds(since))
            }
            Type::Duration => {
                let seconds = f64::from(cdr.i32()?);
                let rest = if self.schema.is_ros1 {
                    f64::from(cdr.i32()?)
                } else {
                    f64::from(cdr.u32()?)
                };
                number(seconds + rest / 1e9)
            }
        };
        if let Some(shape) = shape {
            shape.value(kind, value, self.room, self.give);
        }
        Some(())
    }
}

fn number(number: f64) -> (Kind, Value) {
    (Kind::Number, Value::Number(number))
}
