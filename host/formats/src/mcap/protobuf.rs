//! Messages of protobuf, decoded by the descriptors that the file holds.

use crate::batch::Value;
use crate::guard::guarded;
use crate::log::Kind;
use crate::shape::{Give, MOST_ELEMENTS, Room, Shape};
use prost_reflect::{
    DescriptorPool, DynamicMessage, MessageDescriptor, ReflectMessage, Value as Proto,
};

/// The message with that name.
pub(super) fn descriptor(name: &str, descriptors: &[u8]) -> Result<MessageDescriptor, String> {
    let pool = guarded(|| DescriptorPool::decode(descriptors).map_err(|error| error.to_string()));
    let pool = pool.unwrap_or_else(|| Err("its descriptors contradict each other".to_owned()))?;
    let found = pool.get_message_by_name(name);
    found.ok_or_else(|| format!("{name} is not among its descriptors"))
}

/// Gives the values of a message.
pub(super) fn decode(
    descriptor: &MessageDescriptor,
    message: &[u8],
    shape: &mut Shape,
    room: &mut Room,
    give: Give<'_>,
) -> Result<(), String> {
    let message = guarded(|| DynamicMessage::decode(descriptor.clone(), message));
    let message = message.ok_or("it is no such message")?;
    parts(
        &message.map_err(|error| error.to_string())?,
        shape,
        room,
        give,
    );
    Ok(())
}

fn parts(message: &DynamicMessage, shape: &mut Shape, room: &mut Room, give: Give<'_>) {
    for (at, field) in message.descriptor().fields().enumerate() {
        // What has no presence of its own is 0 where it is not written.
        if field.supports_presence() && !message.has_field(&field) {
            continue;
        }
        if let Some(shape) = shape.part(field.name(), at, room) {
            value(&message.get_field(&field), shape, room, give);
        }
    }
}

fn value(proto: &Proto, shape: &mut Shape, room: &mut Room, give: Give<'_>) {
    let number = match proto {
        Proto::Bool(flag) => {
            let flag = Value::Number(f64::from(u8::from(*flag)));
            return shape.value(Kind::Flag, flag, room, give);
        }
        Proto::String(_) | Proto::Bytes(_) | Proto::Map(_) => return shape.text(room),
        Proto::List(list) if list.len() > MOST_ELEMENTS => return shape.text(room),
        Proto::List(list) => {
            for (at, proto) in list.iter().enumerate() {
                if let Some(shape) = shape.element(at, room) {
                    value(proto, shape, room, give);
                }
            }
            return;
        }
        Proto::Message(message) => match time(message) {
            Some((Kind::Time, since)) => {
                return shape.value(Kind::Time, Value::Nanoseconds(since), room, give);
            }
            Some((_, since)) => since as f64 / 1e9,
            None => return parts(message, shape, room, give),
        },
        Proto::I32(number) | Proto::EnumNumber(number) => f64::from(*number),
        Proto::U32(number) => f64::from(*number),
        Proto::I64(number) => *number as f64,
        Proto::U64(number) => *number as f64,
        Proto::F32(number) => f64::from(*number),
        Proto::F64(number) => *number,
    };
    shape.value(Kind::Number, Value::Number(number), room, give);
}

/// Nanoseconds of a time or of a span.
fn time(message: &DynamicMessage) -> Option<(Kind, i128)> {
    let descriptor = message.descriptor();
    let kind = match descriptor.full_name() {
        "google.protobuf.Timestamp" => Kind::Time,
        "google.protobuf.Duration" => Kind::Number,
        _ => return None,
    };
    let part = |name| match message.get_field_by_name(name)?.as_ref() {
        Proto::I64(number) => Some(i128::from(*number)),
        Proto::I32(number) => Some(i128::from(*number)),
        _ => None,
    };
    Some((kind, part("seconds")? * 1_000_000_000 + part("nanos")?))
}
