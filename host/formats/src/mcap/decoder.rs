//! How the messages of a channel are decoded.

use super::records::damaged;
use super::ros::{self, Schema};
use super::{json, protobuf};
use crate::error::FormatFault;
use crate::shape::{Give, Room, Shape};
use prost_reflect::MessageDescriptor;

/// How the messages of a channel are decoded.
pub(super) enum Decoder {
    Ros(Schema),
    Json,
    Protobuf(MessageDescriptor),
    Unknown { what: String },
}

/// What a schema says.
pub(super) struct Definition {
    pub(super) name: String,
    pub(super) encoding: String,
    pub(super) text: Vec<u8>,
}

impl Decoder {
    /// The decoder of a channel's messages.
    pub(super) fn of(encoding: &str, definition: Option<&Definition>) -> Self {
        let written = definition.map_or("", |definition| definition.encoding.as_str());
        let read = match (encoding, written, definition) {
            ("json", _, _) => Ok(Decoder::Json),
            ("cdr", "ros2msg", Some(definition)) => ros(definition, false),
            ("ros1", "ros1msg", Some(definition)) => ros(definition, true),
            ("protobuf", "protobuf", Some(definition)) => {
                protobuf::descriptor(&definition.name, &definition.text).map(Decoder::Protobuf)
            }
            (_, "", _) => Err(format!(
                "a channel of encoding {encoding:?} without a schema"
            )),
            _ => Err(format!(
                "a channel of encoding {encoding:?} with a schema of {written:?}"
            )),
        };
        read.unwrap_or_else(|what| Decoder::Unknown { what })
    }

    /// Gives the values of a message.
    pub(super) fn decode(
        &self,
        message: &[u8],
        shape: &mut Shape,
        room: &mut Room,
        give: Give<'_>,
    ) -> Result<(), FormatFault> {
        let unlike = |why| damaged(format!("the message is not what its schema says: {why}"));
        match self {
            Decoder::Ros(schema) => ros::decode(schema, message, shape, room, give)
                .ok_or_else(|| unlike("it ends too early, or is no plain CDR".to_owned())),
            Decoder::Json => json::decode(message, shape, room, give).map_err(unlike),
            Decoder::Protobuf(descriptor) => {
                protobuf::decode(descriptor, message, shape, room, give).map_err(unlike)
            }
            Decoder::Unknown { what } => Err(unsupported(what)),
        }
    }
}

/// Messages that cannot be decoded.
pub(super) fn unsupported(what: &str) -> FormatFault {
    FormatFault::Unsupported {
        what: what.to_owned(),
        remedy: "write this topic as CSV or Parquet with the program that made it".to_owned(),
    }
}

fn ros(definition: &Definition, is_ros1: bool) -> Result<Decoder, String> {
    let text = String::from_utf8_lossy(&definition.text);
    Schema::parse(&definition.name, &text, is_ros1).map(Decoder::Ros)
}
