//! Makes good the latency of an encoder: what answers with the angle of a while ago is asked as much later.
//!
//! The reading then is of the instant at which the duty acts, as [`Board::count`](crate::board::Board::count) promises, and the model needs
//! to know of no latency. The wait comes out of the control period; a latency too long for that stays, in part, and is reported.

use crate::board::generic::Position;
use embedded_hal::delay::DelayNs;

/// An encoder that is asked late.
#[derive(Debug)]
pub struct SampledLate<P, D> {
    encoder: P,
    delay: D,
    most_us: u32,
}

impl<P: Position, D: DelayNs> SampledLate<P, D> {
    /// Asks `encoder` as much later as it is late, at most `most_us`: what the control period can spare.
    pub fn new(encoder: P, delay: D, most_us: u32) -> Self {
        SampledLate {
            encoder,
            delay,
            most_us,
        }
    }

    fn wait_us(&self) -> u32 {
        self.encoder.latency_us().min(self.most_us)
    }
}

impl<P: Position, D: DelayNs> Position for SampledLate<P, D> {
    fn count(&mut self) -> i32 {
        let wait = self.wait_us();
        if wait > 0 {
            self.delay.delay_us(wait);
        }
        self.encoder.count()
    }

    fn failed(&self) -> bool {
        self.encoder.failed()
    }

    /// What the wait leaves of it.
    fn latency_us(&self) -> u32 {
        self.encoder.latency_us() - self.wait_us()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::Cell;
    use std::rc::Rc;

    /// Time, µs, that passes by waiting only.
    #[derive(Clone, Default)]
    struct Clock(Rc<Cell<u32>>);

    impl DelayNs for Clock {
        fn delay_ns(&mut self, ns: u32) {
            self.0.set(self.0.get() + ns / 1_000);
        }
    }

    /// A shaft at a count a microsecond, read `late` µs after.
    struct Shaft {
        clock: Clock,
        late: u32,
    }

    impl Position for Shaft {
        fn count(&mut self) -> i32 {
            self.clock.0.get() as i32 - self.late as i32
        }

        fn latency_us(&self) -> u32 {
            self.late
        }
    }

    #[test]
    fn a_reading_is_of_the_instant_at_which_it_was_asked_for() {
        for late in [0, 1, 255, 286, 400, 2_200] {
            let clock = Clock::default();
            clock.0.set(10_000);
            let shaft = Shaft {
                clock: clock.clone(),
                late,
            };
            let mut encoder = SampledLate::new(shaft, clock, 400);
            let left = encoder.latency_us();
            assert_eq!(left, late.saturating_sub(400));
            assert_eq!(encoder.count(), 10_000 - left as i32);
        }
    }
}
