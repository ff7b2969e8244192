//! A plant in lock step: the board sends its duty, the plant answers with its state one period later.
//!
//! ```text
//! board → plant   a5  duty (i16)                    check
//! plant → board   5a  count (i32)  current (i16)    check
//! ```
//!
//! Little-endian, the check is the sum of the bytes between. An open bridge is the duty that no drive has, see
//! [`OPEN`]. There is no clock: a period lasts until the plant answers, so nothing is ever late.

use shared::trace::OPEN;

/// Bytes from the board to the plant.
pub const ASKED: usize = 4;
/// Bytes from the plant to the board.
pub const ANSWERED: usize = 8;

/// The plant's answer.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Reading {
    /// Encoder reading, counts.
    pub count: i32,
    /// mA.
    pub current_ma: i16,
}

/// The board's request.
pub fn ask(duty: Option<i16>) -> [u8; ASKED] {
    let [low, high] = duty.unwrap_or(OPEN).to_le_bytes();
    [0xa5, low, high, low.wrapping_add(high)]
}

/// Parses the plant's answer byte by byte and skips invalid bytes.
#[derive(Debug, Default)]
pub struct Answer {
    bytes: [u8; ANSWERED],
    len: usize,
}

impl Answer {
    /// Takes a byte; gives the reading that it completes.
    pub fn push(&mut self, byte: u8) -> Option<Reading> {
        if self.len == 0 && byte != 0x5a {
            return None;
        }
        self.bytes[self.len] = byte;
        self.len += 1;
        if self.len < ANSWERED {
            return None;
        }
        self.len = 0;
        let [_, a, b, c, d, low, high, check] = self.bytes;
        let sum = [a, b, c, d, low, high]
            .iter()
            .fold(0u8, |sum, byte| sum.wrapping_add(*byte));
        (sum == check).then(|| Reading {
            count: i32::from_le_bytes([a, b, c, d]),
            current_ma: i16::from_le_bytes([low, high]),
        })
    }
}
