//! What the structured messages of a channel are made of, and which column each part of them is.

use crate::batch::Value;
use crate::log::{Column, Kind};

/// Elements of a list that become columns; a longer one is an image or a cloud and no series of numbers.
pub(crate) const MOST_ELEMENTS: usize = 256;
/// Columns of a table.
pub(crate) const MOST_COLUMNS: usize = 4096;
/// Bytes of the name of a part.
const MOST_NAME: usize = 256;

/// Who takes the values of a message, each with its column.
pub(crate) type Give<'g> = &'g mut dyn FnMut(usize, Value);

/// A part of a message.
#[derive(Clone, Debug, Default)]
pub(crate) enum Shape {
    /// Nothing was seen of it.
    #[default]
    Unknown,
    /// One value.
    Leaf {
        /// What it is.
        kind: Kind,
        /// Its column, once columns are numbered.
        column: usize,
    },
    /// Parts with names: `a.b`.
    Parts(Vec<(String, Shape)>),
    /// A list: `a[0]`.
    List(Vec<Shape>),
    /// A list whose elements have names of their own: `a[elbow]`.
    Named(Vec<(String, Shape)>),
}

/// How much a shape may still grow: files are foreign, and a name in each of a million messages is no column.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Room(usize);

impl Default for Room {
    fn default() -> Self {
        Room(MOST_COLUMNS)
    }
}

impl Room {
    /// No growth: messages are read by what is known of them.
    pub(crate) fn none() -> Self {
        Room(0)
    }

    /// Whether another part fits, which takes its room.
    pub(crate) fn take(&mut self) -> bool {
        let fits = self.0 > 0;
        self.0 = self.0.saturating_sub(1);
        fits
    }

    /// Whether there is any.
    pub(crate) fn is_left(self) -> bool {
        self.0 > 0
    }
}

impl Shape {
    /// A value whose column is not numbered yet.
    pub(crate) fn leaf(kind: Kind) -> Self {
        Shape::Leaf {
            kind,
            column: usize::MAX,
        }
    }

    /// Becomes `kind` if nothing is known of it, and gives the value if that is what it is.
    pub(crate) fn value(&mut self, kind: Kind, value: Value, room: &mut Room, give: Give<'_>) {
        if matches!(self, Shape::Unknown) && room.take() {
            *self = Shape::leaf(kind);
        }
        match self {
            Shape::Leaf {
                kind: known,
                column,
            } if *known == kind => give(*column, value),
            // A number that was written without its fraction, or a flag as 0 and 1, is the same quantity.
            Shape::Leaf {
                kind: Kind::Number | Kind::Flag,
                column,
            } if matches!(kind, Kind::Number | Kind::Flag) => give(*column, value),
            _ => {}
        }
    }

    /// Becomes a text if nothing is known of it.
    pub(crate) fn text(&mut self, room: &mut Room) {
        if matches!(self, Shape::Unknown) && room.take() {
            *self = Shape::leaf(Kind::Text);
        }
    }

    /// The part of that name, which is expected at that place.
    pub(crate) fn part(&mut self, name: &str, at: usize, room: &mut Room) -> Option<&mut Shape> {
        if matches!(self, Shape::Unknown) && room.is_left() {
            *self = Shape::Parts(Vec::new());
        }
        match self {
            Shape::Parts(parts) => entry(parts, name, at, room),
            _ => None,
        }
    }

    /// The element of a list, by its name if it has one and the list is not known as one without names.
    pub(crate) fn element_of(
        &mut self,
        name: Option<&str>,
        at: usize,
        room: &mut Room,
    ) -> Option<&mut Shape> {
        let Some(name) = name else {
            return self.element(at, room);
        };
        if matches!(self, Shape::Unknown) && room.is_left() {
            *self = Shape::Named(Vec::new());
        }
        match self {
            Shape::Named(parts) => entry(parts, name, at, room),
            _ => self.element(at, room),
        }
    }

    /// The element at that place.
    pub(crate) fn element(&mut self, at: usize, room: &mut Room) -> Option<&mut Shape> {
        if matches!(self, Shape::Unknown) && room.is_left() {
            *self = Shape::List(Vec::new());
        }
        let Shape::List(list) = self else {
            return None;
        };
        if at == list.len() && at < MOST_ELEMENTS && room.take() {
            list.push(Shape::Unknown);
        }
        list.get_mut(at)
    }

    /// Numbers the columns and adds them; `name` is that of the shape itself.
    pub(crate) fn number(&mut self, name: &str, columns: &mut Vec<Column>) {
        match self {
            Shape::Unknown => {}
            Shape::Leaf { kind, column } => {
                *column = columns.len();
                columns.push(Column {
                    name: name.to_owned(),
                    kind: *kind,
                    unit: None,
                });
            }
            Shape::Parts(parts) => {
                for (part, shape) in parts {
                    let dot = if name.is_empty() { "" } else { "." };
                    shape.number(&format!("{name}{dot}{part}"), columns);
                }
            }
            Shape::List(list) => {
                for (at, shape) in list.iter_mut().enumerate() {
                    shape.number(&format!("{name}[{at}]"), columns);
                }
            }
            Shape::Named(parts) => {
                for (part, shape) in parts {
                    shape.number(&format!("{name}[{part}]"), columns);
                }
            }
        }
    }
}

/// The part called `name`, made if there is room; `at` is tried before all others.
fn entry<'p>(
    parts: &'p mut Vec<(String, Shape)>,
    name: &str,
    at: usize,
    room: &mut Room,
) -> Option<&'p mut Shape> {
    let is_called = |(part, _): &(String, Shape)| part == name;
    let guess = parts.get(at).filter(|part| is_called(part)).map(|_| at);
    let at = match guess.or_else(|| parts.iter().position(is_called)) {
        Some(at) => at,
        None if name.len() <= MOST_NAME && room.take() => {
            parts.push((name.to_owned(), Shape::Unknown));
            parts.len() - 1
        }
        None => return None,
    };
    parts.get_mut(at).map(|(_, shape)| shape)
}
