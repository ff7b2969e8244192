//! What messages of ROS are made of.

/// The type of a field or of its elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    Bool,
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    Text,
    /// Seconds and nanoseconds since 1970.
    Time,
    /// Seconds and nanoseconds.
    Duration,
    /// The message with that number.
    Message(usize),
}

impl Type {
    /// Bytes of a number; `None` for what is no number.
    pub(super) fn size(self) -> Option<usize> {
        match self {
            Type::Bool | Type::I8 | Type::U8 => Some(1),
            Type::I16 | Type::U16 => Some(2),
            Type::I32 | Type::U32 | Type::F32 => Some(4),
            Type::I64 | Type::U64 | Type::F64 => Some(8),
            Type::Text | Type::Time | Type::Duration | Type::Message(_) => None,
        }
    }
}

/// How many there are of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Count {
    One,
    Fixed(usize),
    /// As many as the message says.
    Any,
}

/// A field of a message.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) kind: Type,
    pub(super) count: Count,
}

/// A definition with all that it refers to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Schema {
    /// The fields of each message; the first is that of the channel.
    pub(super) messages: Vec<Vec<Field>>,
    /// The messages are of ROS 1.
    pub(super) is_ros1: bool,
}
