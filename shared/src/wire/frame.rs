//! Frames: where a message begins and ends, and whether it came through whole.

use super::codec::{Coded, Reader, Writer};
use crc::{CRC_32_ISO_HDLC, Crc, NoTable};

/// Longest frame, with its zero byte.
pub const LONGEST_FRAME: usize = 320;

/// Bytes of the check at the end of a message.
const CHECK: usize = 4;

/// Without a table, which would take a kilobyte of a microcontroller's flash.
static CRC: Crc<u32, NoTable> = Crc::<u32, NoTable>::new(&CRC_32_ISO_HDLC);

/// The frame of a message, ended by a zero byte; `None` if the buffer is too short.
pub fn encode<'a, T: Coded>(message: &T, buffer: &'a mut [u8]) -> Option<&'a [u8]> {
    let mut plain = [0; LONGEST_FRAME];
    let mut to = Writer::new(&mut plain);
    message.put(&mut to);
    let len = to.finish()?;
    let check = CRC.checksum(plain.get(..len)?).to_le_bytes();
    plain.get_mut(len..len + CHECK)?.copy_from_slice(&check);
    let len = stuff(plain.get(..len + CHECK)?, buffer)?;
    buffer.get(..len)
}

/// Puts a message into a frame without zeros but for its end (COBS; Cheshire and Baker, 1999): before each block stands its
/// length. Gives the length of the frame.
fn stuff(plain: &[u8], frame: &mut [u8]) -> Option<usize> {
    let (mut block, mut to) = (0, 1);
    let mut rest = plain.iter();
    while let Some(&byte) = rest.next() {
        if byte != 0 {
            *frame.get_mut(to)? = byte;
            to += 1;
        }
        // A full block stands for no zero, and nothing need follow it.
        let full = to - block == 0xff && !rest.as_slice().is_empty();
        if byte == 0 || full {
            *frame.get_mut(block)? = (to - block) as u8;
            block = to;
            to += 1;
        }
    }
    *frame.get_mut(block)? = (to - block) as u8;
    *frame.get_mut(to)? = 0;
    Some(to + 1)
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
    pub fn push<T: Coded>(&mut self, byte: u8) -> Option<T> {
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

/// Takes COBS off a frame in place; gives the length that is left. The crate `cobs` does the same by indices of which no
/// compiler can tell that they stay within the frame; from here, bytes of a line lead to no panic, which the linker confirms
/// (`scripts/proof`).
fn unstuff(frame: &mut [u8]) -> Option<usize> {
    let (mut from, mut to) = (0, 0);
    while from < frame.len() {
        let code = *frame.get(from)?;
        from += 1;
        for _ in 1..code {
            *frame.get_mut(to)? = *frame.get(from)?;
            from += 1;
            to += 1;
        }
        match code {
            0 => return None,
            0xff => {}
            // Every other block ends in a zero, but the last.
            _ if from < frame.len() => {
                *frame.get_mut(to)? = 0;
                to += 1;
            }
            _ => {}
        }
    }
    Some(to)
}

// Out of line: once for all callers.
#[inline(never)]
fn decode<T: Coded>(frame: &mut [u8]) -> Option<T> {
    let len = unstuff(frame)?;
    let (plain, check) = frame.get(..len)?.split_last_chunk::<CHECK>()?;
    let whole = CRC.checksum(plain) == u32::from_le_bytes(*check);
    if !whole {
        return None;
    }
    let mut from = Reader::new(plain);
    let message = T::take(&mut from);
    from.finish(message)
}

#[cfg(test)]
mod tests {
    use super::{stuff, unstuff};
    use crate::rng::{self, Rng};

    #[test]
    fn frames_are_put_on_and_come_off_as_by_the_crate() {
        let mut rng = rng::seeded(11);
        for _ in 0..20_000 {
            let mut plain = [0; 700];
            let len = 1 + rng::below(&mut rng, 699) as usize;
            let zeros = rng::below(&mut rng, 300) + 1;
            for byte in &mut plain[..len] {
                *byte = if rng::below(&mut rng, zeros) == 0 {
                    0
                } else {
                    rng.next_u32() as u8
                };
            }
            let (mut frame, mut ours) = ([0; 720], [0; 720]);
            let stuffed = cobs::encode(&plain[..len], &mut frame);
            assert_eq!(stuff(&plain[..len], &mut ours), Some(stuffed + 1));
            assert_eq!(ours[..stuffed], frame[..stuffed]);
            let left = unstuff(&mut frame[..stuffed]);
            assert_eq!(left.map(|left| &frame[..left]), Some(&plain[..len]));
            // Random bytes without a zero are no frame, or the same one.
            let plain = plain.map(|byte| byte.max(1));
            let (mut noise, mut other) = (plain, plain);
            let theirs = cobs::decode_in_place(&mut other[..len]).ok();
            let ours = unstuff(&mut noise[..len]);
            let theirs = theirs.map(|left| &other[..left]);
            assert_eq!(ours.map(|left| &noise[..left]), theirs);
        }
    }
}
