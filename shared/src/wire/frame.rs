//! Frames: where a message begins and ends, and whether it came through whole.

use cobs::{DecodeResult, DecoderState};
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};
use heapless::Vec;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// Longest frame, with its zero byte.
pub const LONGEST_FRAME: usize = 320;

/// Bytes of the check at the end of a message.
const CHECK: usize = 4;

/// The check of a frame, and of what a device keeps. Without a table, which would take a kilobyte of a microcontroller's flash.
pub static CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The frame of a message, ended by a zero byte; `None` if the buffer is too short.
pub fn encode<'a, T: Serialize>(message: &T, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
    let mut plain = [0; LONGEST_FRAME];
    let len = postcard::to_slice(message, &mut plain).ok()?.len();
    let check = CRC.checksum(plain.get(..len)?).to_le_bytes();
    plain.get_mut(len..len + CHECK)?.copy_from_slice(&check);
    let len = cobs::try_encode(plain.get(..len + CHECK)?, buffer).ok()?;
    *buffer.get_mut(len)? = 0;
    buffer.get(..=len)
}

/// Puts bytes together to frames.
#[derive(Debug)]
pub struct Deframer {
    state: DecoderState,
    /// The frame so far, without COBS.
    plain: Vec<u8, LONGEST_FRAME>,
    /// The frame is too long: skip to its end.
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
            state: DecoderState::Idle,
            plain: Vec::new(),
            skipping: false,
            dropped: 0,
        }
    }

    /// Takes a byte; gives the message that it completes.
    pub fn push<T: DeserializeOwned>(&mut self, byte: u8) -> Option<T> {
        let ended = match self.state.feed(byte) {
            // Zeros between frames: a sender that clears the line first.
            Ok(DecodeResult::NoData | DecodeResult::DataStart) => return None,
            Ok(DecodeResult::DataContinue(byte)) => {
                self.skipping |= self.plain.push(byte).is_err();
                return None;
            }
            Ok(DecodeResult::DataComplete) => !self.skipping,
            // A zero too early.
            Err(_) => false,
        };
        let message = ended.then(|| decode(&self.plain)).flatten();
        self.plain.clear();
        self.skipping = false;
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

// Out of line: once for all callers.
#[inline(never)]
fn decode<T: DeserializeOwned>(frame: &[u8]) -> Option<T> {
    let (plain, check) = frame.split_last_chunk::<CHECK>()?;
    let whole = CRC.checksum(plain) == u32::from_le_bytes(*check);
    whole.then(|| postcard::from_bytes(plain).ok()).flatten()
}
