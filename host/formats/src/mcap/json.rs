//! Messages of JSON.

use crate::batch::Value;
use crate::log::Kind;
use crate::shape::{Give, MOST_ELEMENTS, Room, Shape};
use serde_json::Value as Json;

/// Gives the values of a message.
pub(super) fn decode(
    message: &[u8],
    shape: &mut Shape,
    room: &mut Room,
    give: Give<'_>,
) -> Result<(), String> {
    let json: Json = serde_json::from_slice(message).map_err(|error| error.to_string())?;
    value(&json, shape, room, give);
    Ok(())
}

fn value(json: &Json, shape: &mut Shape, room: &mut Room, give: Give<'_>) {
    match json {
        Json::Null => {}
        Json::String(_) => shape.text(room),
        Json::Bool(flag) => {
            let flag = Value::Number(f64::from(u8::from(*flag)));
            shape.value(Kind::Flag, flag, room, give);
        }
        Json::Number(number) => {
            let number = Value::Number(number.as_f64().unwrap_or(f64::NAN));
            shape.value(Kind::Number, number, room, give);
        }
        Json::Array(list) if list.len() > MOST_ELEMENTS => shape.text(room),
        Json::Array(list) => {
            for (at, json) in list.iter().enumerate() {
                if let Some(shape) = shape.element(at, room) {
                    value(json, shape, room, give);
                }
            }
        }
        Json::Object(parts) => {
            if let Some(time) = time(json) {
                return shape.value(Kind::Time, Value::Nanoseconds(time), room, give);
            }
            for (at, (name, json)) in parts.iter().enumerate() {
                if let Some(shape) = shape.part(name, at, room) {
                    value(json, shape, room, give);
                }
            }
        }
    }
}

/// Nanoseconds of a time as ROS and Foxglove write it: seconds and nanoseconds, and nothing else.
fn time(json: &Json) -> Option<i128> {
    let parts = json.as_object().filter(|parts| parts.len() == 2)?;
    let rest = parts.get("nsec").or_else(|| parts.get("nanosec"))?;
    let seconds = i128::from(parts.get("sec")?.as_i64()?);
    Some(seconds * 1_000_000_000 + i128::from(rest.as_i64()?))
}
