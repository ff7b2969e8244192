//! AS5600 by ams OSRAM: 12 bits over I²C. Slow: it is late by its filter and by the bus, see [`SampledLate`](super::SampledLate).

use super::{Absolute, Angle};
use embedded_hal::i2c::I2c;

const ADDRESS: u8 = 0x36;
/// STATUS, followed by both bytes of RAW ANGLE (data sheet v1-06, register map).
const STATUS: u8 = 0x0b;
/// The magnet is detected, too weak, too strong.
const DETECTED: u8 = 1 << 5;
const WEAK: u8 = 1 << 4;
const STRONG: u8 = 1 << 3;

/// Time that its filter takes for a step at its fastest setting, µs (data sheet, slow filter 11): what the angle is late by, about, before
/// the bus has begun.
pub const FILTER_US: u32 = 286;
/// Bits of one reading on the bus.
const BITS: u32 = 7 * 9;

/// The encoder.
#[derive(Debug)]
pub struct As5600<I> {
    bus: I,
    bus_hz: u32,
}

impl<I: I2c> As5600<I> {
    /// The count of the one on a bus of this speed, Hz.
    pub fn on(bus: I, bus_hz: u32) -> Absolute<Self, 12> {
        Absolute::of(As5600 { bus, bus_hz })
    }
}

impl<I: I2c> Angle for As5600<I> {
    fn angle(&mut self) -> Option<u32> {
        let mut bytes = [0; 3];
        self.bus.write_read(ADDRESS, &[STATUS], &mut bytes).ok()?;
        let [status, high, low] = bytes;
        let good = status & (DETECTED | WEAK | STRONG) == DETECTED;
        good.then_some((u32::from(high) << 8 | u32::from(low)) & 0xfff)
    }

    /// The filter. The angle is taken when the bus asks for it, in the first half of the reading.
    fn latency_us(&self) -> u32 {
        FILTER_US.saturating_sub(BITS * 500_000 / self.bus_hz.max(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::generic::Position;
    use embedded_hal_mock::eh1::i2c::{Mock, Transaction};

    #[test]
    fn an_angle_counts_if_the_magnet_is_there() {
        let reads = |status: u8, angle: u16| {
            let [high, low] = angle.to_be_bytes();
            Transaction::write_read(ADDRESS, vec![STATUS], vec![status, high, low])
        };
        let mut bus = Mock::new(&[
            reads(DETECTED, 10),
            reads(DETECTED, 4_090),
            reads(0, 77),
            reads(DETECTED | WEAK, 77),
            reads(DETECTED | STRONG, 77),
            reads(DETECTED, 4_000),
        ]);
        let mut encoder = As5600::on(bus.clone(), 1_000_000);
        for count in [10, -6, -6, -6, -6, -96] {
            assert_eq!(encoder.count(), count);
        }
        assert_eq!(encoder.bad(), 3);
        assert_eq!(encoder.latency_us(), 286 - 31);
        bus.done();
    }
}
