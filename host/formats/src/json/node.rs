//! A document of JSON as a tree whose lists are columns already.

use super::cells::{Apart, Cell};
use super::frame::{Filling, Frame, NAME, Room};
use crate::error::FormatFault;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// A value of a document.
#[derive(Clone, Debug)]
pub(crate) enum Node {
    /// A number, with its text.
    Number(f64, String),
    /// True or false.
    Flag(bool),
    /// A text.
    Text(String),
    /// `null`.
    Nothing,
    /// A list.
    List(Frame),
    /// An object.
    Object(Vec<(String, Node)>),
}

impl Node {
    /// The value under a key of an object.
    pub(crate) fn get(&self, key: &str) -> Option<&Node> {
        let Node::Object(members) = self else {
            return None;
        };
        members
            .iter()
            .find_map(|(name, node)| (name == key).then_some(node))
    }

    /// A single value as a text; `None` for a list, an object and `null`.
    pub(crate) fn text(&self) -> Option<&str> {
        match self {
            Node::Number(_, text) | Node::Text(text) => Some(text),
            Node::Flag(true) => Some("true"),
            Node::Flag(false) => Some("false"),
            Node::Nothing | Node::List(_) | Node::Object(_) => None,
        }
    }

    fn cell(&self) -> Option<Cell<'_>> {
        Some(match self {
            Node::Number(number, _) => Cell::Number(*number),
            Node::Flag(flag) => Cell::Flag(*flag),
            Node::Text(text) => Cell::text(text),
            Node::Nothing => Cell::Missing,
            Node::List(_) | Node::Object(_) => return None,
        })
    }
}

/// Reads a value as a node.
pub(crate) struct Reading<'r> {
    /// What room is left.
    pub(crate) room: &'r mut Room,
}

impl<'de> DeserializeSeed<'de> for Reading<'_> {
    type Value = Node;

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<Node, D::Error> {
        from.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Reading<'_> {
    type Value = Node;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a value")
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Node, E> {
        Ok(Node::Flag(value))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Node, E> {
        Ok(Node::Number(value as f64, value.to_string()))
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Node, E> {
        Ok(Node::Number(value as f64, value.to_string()))
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Node, E> {
        Ok(Node::Number(value, value.to_string()))
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Node, E> {
        Ok(Node::Text(value.to_owned()))
    }

    fn visit_unit<E: Error>(self) -> Result<Node, E> {
        Ok(Node::Nothing)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Node, A::Error> {
        let mut frame = Frame::default();
        let mut path = String::new();
        loop {
            let mut filling = Filling {
                frame: &mut frame,
                room: &mut *self.room,
            };
            let apart = Apart {
                path: &mut path,
                sink: &mut filling,
            };
            if list.next_element_seed(apart)?.is_none() {
                return Ok(Node::List(frame));
            }
            frame.rows += 1;
        }
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Node, A::Error> {
        let mut members = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            let reading = Reading {
                room: &mut *self.room,
            };
            members.push((key, map.next_value_seed(reading)?));
            self.room
                .take(NAME)
                .map_err(|fault| self.room.refuse(fault))?;
        }
        match numbered(&members, self.room).map_err(|fault| self.room.refuse(fault))? {
            Some(frame) => Ok(Node::List(frame)),
            None => Ok(Node::Object(members)),
        }
    }
}

/// An object whose keys count from 0 is a list: so pandas writes a column.
fn numbered(members: &[(String, Node)], room: &mut Room) -> Result<Option<Frame>, FormatFault> {
    let is_list = members.len() > 1
        && members
            .iter()
            .zip(0_usize..)
            .all(|((key, node), at)| node.cell().is_some() && *key == at.to_string());
    if !is_list {
        return Ok(None);
    }
    let mut frame = Frame::default();
    for cell in members.iter().filter_map(|(_, node)| node.cell()) {
        frame.put("", cell, room)?;
        frame.rows += 1;
    }
    Ok(Some(frame))
}
