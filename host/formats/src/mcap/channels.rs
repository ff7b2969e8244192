//! The channels of a file, and how their messages are decoded.

use super::decoder::{Decoder, Definition};
use super::records::{Records, op};
use crate::bytes::Bytes;
use crate::error::FormatError;
use crate::log::{Column, Kind, Table};
use crate::shape::{Room, Shape};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::ops::ControlFlow;
use std::sync::Arc;

/// Messages of a channel that are looked at to see what they are made of.
const SAMPLES: u64 = 16;

/// One channel.
pub(super) struct Channel {
    pub(super) id: u16,
    topic: String,
    pub(super) decoder: Arc<Decoder>,
    pub(super) shape: Shape,
    room: Room,
    /// Messages that were seen.
    seen: u64,
}

/// A message of a channel.
pub(super) struct Message<'m> {
    pub(super) channel: u16,
    /// Nanoseconds.
    pub(super) log_time: u64,
    pub(super) content: &'m [u8],
}

impl<'m> Message<'m> {
    pub(super) fn of(record: &'m [u8]) -> Option<Self> {
        let mut bytes = Bytes::new(record);
        let (channel, _sequence) = (bytes.u16()?, bytes.u32()?);
        let (log_time, _publish_time) = (bytes.u64()?, bytes.u64()?);
        Some(Message {
            channel,
            log_time,
            content: bytes.rest(),
        })
    }
}

/// What is known of the channels of a file.
#[derive(Default)]
struct Index {
    definitions: HashMap<u16, Definition>,
    /// The decoder of each encoding and schema.
    decoders: HashMap<(String, u16), Arc<Decoder>>,
    channels: Vec<Channel>,
    numbers: HashMap<u16, usize>,
    /// Messages that the file says there are.
    said: HashMap<u16, u64>,
}

/// Finds the channels of a file, each with its table: by the summary and the first messages of each where there is a summary,
/// else by all messages. A file that is damaged has the channels that were found before.
pub(super) fn channels(records: &mut Records) -> Result<(Vec<Channel>, Vec<Table>), FormatError> {
    let mut index = Index::default();
    // A summary that cannot be read says nothing that the data do not say too.
    let summary = records.summary(&mut |opcode, body| {
        index.learn(opcode, body);
        Ok(ControlFlow::Continue(()))
    });
    let has_counts = summary.is_ok() && !index.said.is_empty();
    let waited_for = index.said.values().map(|said| said.min(&SAMPLES));
    let mut missing: u64 = waited_for.sum();
    let data = records.data(&mut |opcode, body| {
        if opcode == op::MESSAGE {
            if index.sample(body) {
                missing = missing.saturating_sub(1);
            }
        } else {
            index.learn(opcode, body);
        }
        Ok(if has_counts && missing == 0 {
            ControlFlow::Break(())
        } else {
            ControlFlow::Continue(())
        })
    });
    if let (Err(error), true) = (data, index.channels.is_empty()) {
        return Err(error);
    }
    let mut channels = index.channels;
    let tables = channels.iter_mut().map(|channel| {
        let counted = Some(channel.seen);
        let said = || index.said.get(&channel.id).copied();
        let rows = if has_counts { said() } else { counted };
        channel.table(rows)
    });
    let tables = tables.collect();
    Ok((channels, tables))
}

impl Index {
    /// Learns what a record says of schemas, channels or counts.
    fn learn(&mut self, opcode: u8, body: &[u8]) -> Option<()> {
        let mut bytes = Bytes::new(body);
        match opcode {
            op::SCHEMA => {
                let id = bytes.u16()?;
                let (name, encoding) = (bytes.text()?, bytes.text()?);
                let length = usize::try_from(bytes.u32()?).ok()?;
                let text = bytes.take(length)?;
                self.definitions.entry(id).or_insert_with(|| Definition {
                    name,
                    encoding,
                    text: text.to_vec(),
                });
            }
            op::CHANNEL => {
                let (id, schema) = (bytes.u16()?, bytes.u16()?);
                let (topic, encoding) = (bytes.text()?, bytes.text()?);
                if let Entry::Vacant(number) = self.numbers.entry(id) {
                    number.insert(self.channels.len());
                    let decoder = self.decoders.entry((encoding, schema));
                    let decoder = decoder.or_insert_with_key(|(encoding, schema)| {
                        Arc::new(Decoder::of(encoding, self.definitions.get(schema)))
                    });
                    self.channels.push(Channel {
                        id,
                        topic,
                        decoder: decoder.clone(),
                        shape: Shape::Unknown,
                        room: Room::default(),
                        seen: 0,
                    });
                }
            }
            op::STATISTICS => {
                // Eight counts and times, of 42 bytes together, come before those of the channels.
                bytes.take(42)?;
                let length = usize::try_from(bytes.u32()?).ok()?;
                let mut counts = Bytes::new(bytes.take(length)?);
                while let (Some(id), Some(count)) = (counts.u16(), counts.u64()) {
                    self.said.insert(id, count);
                }
            }
            _ => {}
        }
        Some(())
    }

    /// Looks at a message; whether it is one of those that were waited for.
    fn sample(&mut self, record: &[u8]) -> bool {
        let found = Message::of(record).and_then(|message| {
            let number = self.numbers.get(&message.channel)?;
            Some((message, self.channels.get_mut(*number)?))
        });
        let Some((message, channel)) = found else {
            return false;
        };
        channel.seen = channel.seen.saturating_add(1);
        if channel.seen > SAMPLES {
            return false;
        }
        let (shape, room) = (&mut channel.shape, &mut channel.room);
        // A message that cannot be decoded is an error when it is read.
        let _ = (channel.decoder).decode(message.content, shape, room, &mut |_, _| {});
        self.said.contains_key(&channel.id)
    }
}

impl Channel {
    fn table(&mut self, rows: Option<u64>) -> Table {
        let mut columns = vec![Column {
            name: "log_time".to_owned(),
            kind: Kind::Time,
            unit: None,
        }];
        if let Decoder::Unknown { .. } = *self.decoder {
            columns.push(Column {
                name: "message".to_owned(),
                kind: Kind::Text,
                unit: None,
            });
        }
        let name = if let Shape::Parts(_) = self.shape {
            ""
        } else {
            "value"
        };
        self.shape.number(name, &mut columns);
        Table {
            name: self.topic.clone(),
            rows,
            columns,
        }
    }
}
