//! MCAP: each channel is a table with the time at which its messages were logged and what they hold.
//!
//! What a message is made of is seen in the first messages of its channel. Rows come in the order of the file.

mod channels;
mod chunk;
mod decoder;
mod json;
mod protobuf;
mod records;
mod ros;

pub(crate) use records::MAGIC;

use crate::batch::{Batch, Value, asked, place};
use crate::detect::Format;
use crate::error::FormatError;
use crate::log::{Log, Rows, Table};
use crate::shape::Room;
use channels::{Channel, Message, channels};
use decoder::{Decoder, unsupported};
use records::{Records, op};
use std::ops::ControlFlow;
use std::path::Path;

/// An MCAP file.
pub(crate) struct Mcap {
    records: Records,
    channels: Vec<Channel>,
    tables: Vec<Table>,
}

impl Mcap {
    pub(crate) fn open(path: &Path) -> Result<Self, FormatError> {
        let mut records = Records::open(path)?;
        let (channels, tables) = channels(&mut records)?;
        Ok(Mcap {
            records,
            channels,
            tables,
        })
    }
}

impl Log for Mcap {
    fn format(&self) -> Format {
        Format::Mcap
    }

    fn tables(&self) -> &[Table] {
        &self.tables
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let source = self.records.source().to_owned();
        if let Some(Decoder::Unknown { what }) = self.channels.get(table).map(|c| &*c.decoder)
            && columns.contains(&1)
        {
            let topic = self
                .tables
                .get(table)
                .map_or("", |table| table.name.as_str());
            return Err(FormatError::new(&source, topic, unsupported(what)));
        }
        let found = asked(&source, &self.tables, table, columns)?;
        let Some(channel) = self.channels.get_mut(table) else {
            return Ok(());
        };
        if columns.is_empty() {
            return Ok(());
        }
        let has_content = columns.iter().any(|column| *column != 0);
        let mut batch = Batch::new(found.columns.len(), columns, each);
        let mut room = Room::none();
        let outcome = self.records.data(&mut |opcode, body| {
            let message = (opcode == op::MESSAGE).then(|| Message::of(body)).flatten();
            if let Some(first) = &message {
                batch.counts_from(0, i128::from(first.log_time));
            }
            let Some(message) = message.filter(|message| message.channel == channel.id) else {
                return Ok(ControlFlow::Continue(()));
            };
            batch.set(0, Value::Nanoseconds(i128::from(message.log_time)));
            if has_content {
                let give = &mut |column, value| batch.set(column, value);
                let shape = &mut channel.shape;
                let decoded = channel
                    .decoder
                    .decode(message.content, shape, &mut room, give);
                decoded.map_err(|fault| {
                    let moment = format!("the message of {} ns", message.log_time);
                    FormatError::new(&source, place(&found.name, &moment), fault)
                })?;
            }
            Ok(batch.end_row())
        });
        let _ = batch.flush();
        outcome
    }
}
