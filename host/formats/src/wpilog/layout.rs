//! What the content of an entry is made of: one number, several, or the numbers of a packed structure.

use super::number::Number;
use crate::batch::Value;
use crate::bytes::Bytes;
use crate::log::{Column, Kind};
use crate::shape::{MOST_COLUMNS, MOST_ELEMENTS};
use std::collections::HashMap;

/// How deep structures may lie within each other.
const DEEPEST: usize = 16;
/// Bytes of a structure.
const MOST_BYTES: usize = 1 << 16;
/// Bytes of text that are read for one structure.
const MOST_TEXT: usize = 1 << 22;

/// A number and where it is.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Leaf {
    /// Its name in the structure; empty where there is none.
    name: String,
    offset: usize,
    number: Number,
}

/// The content of an entry.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Layout {
    leaves: Vec<Leaf>,
    /// Bytes of one element.
    size: usize,
    /// There may be any number of elements.
    is_list: bool,
}

impl Layout {
    /// The layout of the type that an entry says; `None` for what is no numbers.
    pub(super) fn of(kind: &str, schemas: &HashMap<String, String>) -> Option<Self> {
        let (kind, is_list) = match kind.strip_suffix("[]") {
            Some(kind) => (kind, true),
            None => (kind, false),
        };
        let mut layout = Layout {
            is_list,
            ..Layout::default()
        };
        if let Some(name) = kind.strip_prefix("struct:") {
            let mut reader = Reader {
                schemas,
                left: MOST_TEXT,
                layout,
            };
            reader.structure(name, "", 0)?;
            let layout = reader.layout;
            return (layout.size > 0).then_some(layout);
        }
        let number = match kind {
            "boolean" => Number::Bool,
            "int64" => Number::I64,
            "float" => Number::F32,
            "double" => Number::F64,
            _ => return None,
        };
        layout.add("", number)?;
        Some(layout)
    }

    /// Bytes of a record that are read at most; the elements after them are no columns.
    pub(super) fn most_bytes(&self) -> u64 {
        let elements = if self.is_list { MOST_ELEMENTS } else { 1 };
        self.size.saturating_mul(elements) as u64
    }

    /// How many elements a record of that many bytes has; `None` if it cannot have that many bytes.
    pub(super) fn elements(&self, bytes: u64) -> Option<u64> {
        let size = self.size as u64;
        let elements = bytes.checked_div(size)?;
        let fits = bytes.is_multiple_of(size) && (self.is_list || elements == 1);
        fits.then_some(elements)
    }

    /// How many elements have room in that many bytes; one where there is always one.
    pub(super) fn elements_within(&self, bytes: u64) -> u64 {
        if self.is_list {
            bytes.checked_div(self.size as u64).unwrap_or(0)
        } else {
            1
        }
    }

    /// Adds the columns of a record that has as many elements at most.
    pub(super) fn columns(&self, elements: u64, unit: Option<&String>, out: &mut Vec<Column>) {
        let elements = usize::try_from(elements).unwrap_or(usize::MAX);
        if elements > MOST_ELEMENTS || elements.saturating_mul(self.leaves.len()) > MOST_COLUMNS {
            out.push(text());
            return;
        }
        for at in 0..elements {
            for leaf in &self.leaves {
                let name = match (self.is_list, leaf.name.as_str()) {
                    (false, "") => "value".to_owned(),
                    (false, name) => name.to_owned(),
                    (true, "") => format!("value[{at}]"),
                    (true, name) => format!("value[{at}].{name}"),
                };
                out.push(Column {
                    name,
                    kind: leaf.number.kind(),
                    unit: unit.cloned(),
                });
            }
        }
    }

    /// Gives the values of a record, each with its place among the columns.
    pub(super) fn values(&self, content: &[u8], give: &mut dyn FnMut(usize, Value)) {
        let elements = content.chunks_exact(self.size.max(1));
        for (at, element) in elements.enumerate() {
            for (leaf, found) in self.leaves.iter().enumerate() {
                let Some(rest) = element.get(found.offset..) else {
                    continue;
                };
                if let Some(number) = found.number.read(&mut Bytes::new(rest)) {
                    give(at * self.leaves.len() + leaf, Value::Number(number));
                }
            }
        }
    }

    fn add(&mut self, name: &str, number: Number) -> Option<()> {
        let leaf = Leaf {
            name: name.to_owned(),
            offset: self.size,
            number,
        };
        self.leaves.push(leaf);
        self.grow(number.size())
    }

    fn grow(&mut self, bytes: usize) -> Option<()> {
        self.size = self.size.checked_add(bytes)?;
        (self.size <= MOST_BYTES && self.leaves.len() <= MOST_COLUMNS).then_some(())
    }
}

/// Reads what structures are made of.
struct Reader<'s> {
    schemas: &'s HashMap<String, String>,
    /// Bytes of text that may still be read: a structure is read as often as it is in another.
    left: usize,
    layout: Layout,
}

impl Reader<'_> {
    /// Adds the members of a structure; `None` if one of them is not known, or is a field of bits.
    fn structure(&mut self, name: &str, within: &str, depth: usize) -> Option<()> {
        let schema = self.schemas.get(name).filter(|_| depth < DEEPEST)?;
        self.left = self.left.checked_sub(schema.len())?;
        for declaration in schema.split(';') {
            // What the values of an enumeration mean.
            let declaration = declaration.rsplit('}').next()?.trim();
            if declaration.is_empty() {
                continue;
            }
            let (kind, member) = declaration.split_once(char::is_whitespace)?;
            let (member, count) = match member.split_once('[') {
                Some((member, count)) => {
                    let count = count.trim_end().strip_suffix(']')?.trim();
                    (member.trim(), Some(count.parse::<usize>().ok()?))
                }
                None => (member.trim(), None),
            };
            if member.is_empty() || member.contains(':') {
                return None;
            }
            if kind == "char" {
                self.layout.grow(count.unwrap_or(1))?;
                continue;
            }
            let dot = if within.is_empty() { "" } else { "." };
            for at in 0..count.unwrap_or(1) {
                let index = count.map_or(String::new(), |_| format!("[{at}]"));
                let name = format!("{within}{dot}{member}{index}");
                match Number::named(kind) {
                    Some(number) => self.layout.add(&name, number)?,
                    None => {
                        let before = self.layout.size;
                        self.structure(kind, &name, depth + 1)?;
                        // Nothing, however often, would take for ever.
                        if self.layout.size == before {
                            return None;
                        }
                    }
                }
            }
        }
        Some(())
    }
}

/// The column of what is no numbers.
pub(super) fn text() -> Column {
    Column {
        name: "value".to_owned(),
        kind: Kind::Text,
        unit: None,
    }
}

#[cfg(test)]
mod tests {
    use super::Layout;
    use crate::batch::Value;
    use std::collections::HashMap;

    fn layout(schema: &str) -> Option<Layout> {
        let schemas = [
            ("Outer", schema),
            ("Inner", "int16 i; int8 x"),
            ("Self", "Self a"),
        ];
        let owned = schemas.map(|(name, schema)| (name.to_owned(), schema.to_owned()));
        Layout::of("struct:Outer", &HashMap::from(owned))
    }

    #[test]
    fn members_lie_one_after_the_other_without_gaps() {
        let layout = layout("char c; Inner s;; enum {a=1, b=2} int8 val; bool b [2] ;");
        let mut values = Vec::new();
        let mut columns = Vec::new();
        if let Some(layout) = layout {
            layout.columns(1, None, &mut columns);
            layout.values(&[65, 0xfe, 0xff, 7, 2, 0, 1], &mut |_, value| {
                values.push(value)
            });
        }
        let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        assert_eq!(names, ["s.i", "s.x", "val", "b[0]", "b[1]"]);
        assert_eq!(values, [-2.0, 7.0, 2.0, 0.0, 1.0].map(Value::Number));
    }

    #[test]
    fn what_is_not_known_is_refused() {
        for schema in [
            "Missing m",
            "Self s",
            "int8 a:4",
            "double d[1000000000]",
            "",
        ] {
            assert_eq!(layout(schema), None, "{schema}");
        }
    }
}
