//! AS5047P and AS5047D by ams OSRAM: 14 bits over SPI (mode 1, up to 10 MHz).
//!
//! A frame has 16 bits: an even parity bit, an error flag, 14 bits of data. The answer to a command comes with the next frame (data sheet
//! AS5047P v1-11, section "SPI Interface"), so that an angle is as old as the frame before: one control period, unless two frames are sent
//! for each, as here. Its dynamic angle error compensation is on in ANGLECOM.

use super::{Absolute, Angle};
use embedded_hal::spi::SpiDevice;

/// Reads ANGLECOM (0x3fff): read bit, and a parity bit that makes the number of ones even.
const ANGLE: u16 = 0xffff;
/// Reads ERRFL (0x0001), which clears the error flag.
const ERRORS: u16 = 0x4001;
const FLAG: u16 = 1 << 14;
const DATA: u16 = FLAG - 1;

/// The encoder.
#[derive(Debug)]
pub struct As5047<S> {
    spi: S,
}

impl<S: SpiDevice> As5047<S> {
    /// The count of the one on an SPI device.
    pub fn on(spi: S) -> Absolute<Self, 14> {
        Absolute::of(As5047 { spi })
    }

    fn frame(&mut self, command: u16) -> Option<u16> {
        let mut bytes = command.to_be_bytes();
        self.spi.transfer_in_place(&mut bytes).ok()?;
        let answer = u16::from_be_bytes(bytes);
        answer.count_ones().is_multiple_of(2).then_some(answer)
    }
}

impl<S: SpiDevice> Angle for As5047<S> {
    fn angle(&mut self) -> Option<u32> {
        self.frame(ANGLE)?;
        let answer = self.frame(ANGLE)?;
        if answer & FLAG != 0 {
            self.frame(ERRORS);
            return None;
        }
        Some((answer & DATA).into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::generic::Position;
    use embedded_hal_mock::eh1::spi::{Mock, Transaction};

    fn exchange(command: u16, answer: u16) -> [Transaction<u8>; 3] {
        [
            Transaction::transaction_start(),
            Transaction::transfer_in_place(
                command.to_be_bytes().to_vec(),
                answer.to_be_bytes().to_vec(),
            ),
            Transaction::transaction_end(),
        ]
    }

    fn with_parity(data: u16) -> u16 {
        data | (u16::from(!data.count_ones().is_multiple_of(2)) << 15)
    }

    #[test]
    fn commands_have_even_parity() {
        for command in [ANGLE, ERRORS] {
            assert!(command.count_ones().is_multiple_of(2));
        }
    }

    #[test]
    fn good_angles_count_and_bad_ones_hold_the_last() {
        let mut script = Vec::new();
        let mut expected = Vec::new();
        let mut reads = |answer: u16, clears: bool, count: i32| {
            script.extend(exchange(ANGLE, with_parity(0)));
            script.extend(exchange(ANGLE, answer));
            if clears {
                script.extend(exchange(ERRORS, with_parity(0)));
            }
            expected.push(count);
        };
        reads(with_parity(100), false, 100);
        reads(with_parity(16_383), false, -1);
        // One bit is wrong: the parity tells.
        reads(with_parity(500) ^ 1, false, -1);
        // The encoder says that the frame before was wrong.
        reads(with_parity(600 | FLAG), true, -1);
        reads(with_parity(16_000), false, -384);
        let mut spi = Mock::new(&script);
        let mut encoder = As5047::on(spi.clone());
        for count in expected {
            assert_eq!(encoder.count(), count);
            assert!(!encoder.failed());
        }
        assert_eq!(encoder.bad(), 2);
        spi.done();
    }
}
