//! Frames: where a message begins and ends, and whether it came through whole.

use crc::{CRC_32_ISO_HDLC, Crc};
use postcard::ser_flavors::crc::CrcModifier;
use postcard::ser_flavors::{Cobs, Slice};
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Longest frame, with its zero byte.
pub const LONGEST_FRAME: usize = 320;

static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// The frame of a message, ended by a zero byte; `None` if the buffer is too short.
pub fn encode<'a, T: Serialize>(message: &T, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
    let cobs = Cobs::try_new(Slice::new(buffer)).ok()?;
    let framed = postcard::serialize_with_flavor(message, CrcModifier::new(cobs, CRC.digest()));
    framed.ok().map(|frame| &*frame)
}

/// Puts bytes together to frames.
#[derive(Clone, Debug)]
pub struct Deframer {
    buffer: [u8; LONGEST_FRAME],
    len: usize,
    /// The frame under way is too long: skip to its end.
    skipping: bool,
    dropped: u32,
}

impl Default for Deframer {
    fn default() -> Self {
        Self::new()
    }
}

impl Deframer {
    /// At the start of a frame.
    pub const fn new() -> Self {
        Deframer {
            buffer: [0; LONGEST_FRAME],
            len: 0,
            skipping: false,
            dropped: 0,
        }
    }

    /// Takes a byte; gives the message that it completes.
    pub fn push<T: DeserializeOwned>(&mut self, byte: u8) -> Option<T> {
        if byte != 0 {
            match self.buffer.get_mut(self.len) {
                Some(slot) if !self.skipping => {
                    *slot = byte;
                    self.len += 1;
                }
                _ => self.skipping = true,
            }
            return None;
        }
        let len = core::mem::take(&mut self.len);
        let whole = !core::mem::take(&mut self.skipping);
        if len == 0 && whole {
            // Zeros in a row: a sender that clears the line first.
            return None;
        }
        let message = whole.then(|| decode(self.buffer.get_mut(..len)?)).flatten();
        if message.is_none() {
            self.dropped = self.dropped.saturating_add(1);
        }
        message
    }

    /// Frames that did not decode.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }
}

fn decode<T: DeserializeOwned>(frame: &mut [u8]) -> Option<T> {
    let len = cobs::decode_in_place(frame).ok()?;
    postcard::from_bytes_crc32(frame.get(..len)?, CRC.digest()).ok()
}
