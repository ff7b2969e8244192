//! The count of an absolute encoder: its angles, unwrapped; while they are bad, the last good one.

use super::Readings;
use crate::board::generic::Position;
use shared::encoder::Unwrapped;

/// Angles of one kind of encoder.
pub trait Angle {
    /// The angle now; nothing if there is no good one.
    fn angle(&mut self) -> Option<u32>;

    /// How long it is late, µs.
    fn latency_us(&self) -> u32 {
        0
    }
}

/// An encoder of `BITS` bits, as a count.
#[derive(Debug)]
pub struct Absolute<A, const BITS: u32> {
    encoder: A,
    count: Unwrapped<BITS>,
    readings: Readings,
}

impl<A, const BITS: u32> Absolute<A, BITS> {
    /// The count of an encoder.
    pub(super) fn of(encoder: A) -> Self {
        Absolute {
            encoder,
            count: Unwrapped::default(),
            readings: Readings::default(),
        }
    }

    /// Bad readings so far.
    pub fn bad(&self) -> u32 {
        self.readings.bad()
    }
}

impl<A: Angle, const BITS: u32> Position for Absolute<A, BITS> {
    fn count(&mut self) -> i32 {
        let angle = self.encoder.angle();
        self.readings.count(angle.is_some());
        match angle {
            Some(angle) => self.count.read(angle),
            None => self.count.count(),
        }
    }

    fn failed(&self) -> bool {
        self.readings.failed()
    }

    fn latency_us(&self) -> u32 {
        self.encoder.latency_us()
    }
}
