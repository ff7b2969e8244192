//! MT6701 by MagnTek: 14 bits over SSI, which an SPI that only reads can do (up to 15 MHz).
//!
//! A frame has 24 bits: the angle, four bits of status, and a CRC of both by x⁶ + x + 1 (data sheet rev. 1.8, section "SSI"). Set the SPI's
//! mode by that section's timing: the clock idles high.

use super::{Absolute, Angle};
use embedded_hal::spi::SpiDevice;

/// The encoder.
#[derive(Debug)]
pub struct Mt6701<S> {
    spi: S,
}

impl<S: SpiDevice> Mt6701<S> {
    /// The count of the one on an SPI device.
    pub fn on(spi: S) -> Absolute<Self, 14> {
        Absolute::of(Mt6701 { spi })
    }
}

/// The angle of a frame whose CRC is right and whose magnet is neither lost nor too weak or strong.
fn decoded([high, middle, low]: [u8; 3]) -> Option<u32> {
    let frame = u32::from_be_bytes([0, high, middle, low]);
    let (data, check) = (frame >> 6, frame & 0x3f);
    let status = data & 0xf;
    let lost = status & 0b1000 != 0;
    let field = status & 0b0011;
    (crc(data) == check && !lost && field == 0).then_some(data >> 4)
}

/// CRC of 18 bits by x⁶ + x + 1, the highest bit first.
fn crc(data: u32) -> u32 {
    (0..18).rev().fold(0, |crc, bit| {
        let carry = (crc >> 5) ^ (data >> bit) & 1;
        (crc << 1 & 0x3f) ^ (0b00_0011 * carry)
    })
}

impl<S: SpiDevice> Angle for Mt6701<S> {
    fn angle(&mut self) -> Option<u32> {
        let mut bytes = [0; 3];
        self.spi.read(&mut bytes).ok()?;
        decoded(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::generic::Position;
    use embedded_hal_mock::eh1::spi::{Mock, Transaction};

    fn frame(angle: u32, status: u32) -> [u8; 3] {
        let data = angle << 4 | status;
        let [_, bytes @ ..] = (data << 6 | crc(data)).to_be_bytes();
        bytes
    }

    #[test]
    fn every_angle_is_read_and_any_one_or_two_wrong_bits_are_noticed() {
        for angle in 0..16_384 {
            assert_eq!(decoded(frame(angle, 0)), Some(angle));
        }
        for angle in (0..16_384).step_by(97) {
            let bytes = frame(angle, 0);
            let whole = u32::from_be_bytes([0, bytes[0], bytes[1], bytes[2]]);
            for a in 0..24 {
                for b in 0..=a {
                    let [_, wrong @ ..] =
                        (whole ^ (1 << a) ^ if a == b { 0 } else { 1 << b }).to_be_bytes();
                    assert_eq!(decoded(wrong), None, "{angle}, bits {a} and {b}");
                }
            }
        }
    }

    #[test]
    fn a_magnet_that_is_lost_is_no_angle_and_five_of_them_are_a_failure() {
        for status in [0b1000, 0b0001, 0b0010] {
            assert_eq!(decoded(frame(100, status)), None);
        }
        // The button is no fault.
        assert_eq!(decoded(frame(100, 0b0100)), Some(100));
        let script: Vec<_> = (0..6)
            .flat_map(|k| {
                [
                    Transaction::transaction_start(),
                    Transaction::read_vec(frame(7, if k == 0 { 0 } else { 0b1000 }).to_vec()),
                    Transaction::transaction_end(),
                ]
            })
            .collect();
        let mut spi = Mock::new(&script);
        let mut encoder = Mt6701::on(spi.clone());
        for k in 0..6 {
            assert_eq!(encoder.count(), 7);
            assert_eq!(encoder.failed(), k == 5);
        }
        spi.done();
    }
}
