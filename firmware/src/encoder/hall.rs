//! Three Hall lines: six states an electrical revolution, which is a coarse encoder.
//!
//! The lines are looked at once a period. More than one state in a period cannot be told from fewer the other way, so that a motor of `p`
//! pole pairs may turn no faster than `1000 / (6 p)` revolutions a second at a millisecond.

use super::Readings;
use crate::board::generic::Position;
use embedded_hal::digital::InputPin;

/// The place of a state of the lines C, B, A in an electrical revolution; 000 and 111 are none.
const PLACES: [Option<u8>; 8] = [
    None,
    Some(0),
    Some(2),
    Some(1),
    Some(4),
    Some(5),
    Some(3),
    None,
];

/// The lines.
#[derive(Debug)]
pub struct Hall<A, B, C> {
    a: A,
    b: B,
    c: C,
    place: Option<u8>,
    count: i32,
    readings: Readings,
}

impl<A: InputPin, B: InputPin, C: InputPin> Hall<A, B, C> {
    /// On three pins.
    pub fn new(a: A, b: B, c: C) -> Self {
        Hall {
            a,
            b,
            c,
            place: None,
            count: 0,
            readings: Readings::default(),
        }
    }

    fn state(&mut self) -> Option<u8> {
        let a = self.a.is_high().ok()?;
        let b = self.b.is_high().ok()?;
        let c = self.c.is_high().ok()?;
        let state = usize::from(a) | usize::from(b) << 1 | usize::from(c) << 2;
        PLACES.get(state).copied().flatten()
    }
}

impl<A: InputPin, B: InputPin, C: InputPin> Position for Hall<A, B, C> {
    fn count(&mut self) -> i32 {
        let Some(place) = self.state() else {
            self.readings.count(false);
            return self.count;
        };
        let ahead = (6 + place - self.place.unwrap_or(place)) % 6;
        let step = match ahead {
            0..=2 => i32::from(ahead),
            // Half a revolution: which way is unknown.
            3 => 0,
            _ => i32::from(ahead) - 6,
        };
        self.readings.count(ahead != 3);
        self.place = Some(place);
        self.count = self.count.wrapping_add(step);
        self.count
    }

    fn failed(&self) -> bool {
        self.readings.failed()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_hal_mock::eh1::digital::{Mock, State, Transaction};

    /// The lines' states in the order in which a shaft that turns forward shows them.
    const TURN: [u8; 6] = [0b001, 0b011, 0b010, 0b110, 0b100, 0b101];

    fn counts(states: &[u8]) -> (Vec<i32>, bool) {
        let pin = |line: u8| {
            let levels = states.iter().map(|state| {
                let high = state >> line & 1 == 1;
                Transaction::get(if high { State::High } else { State::Low })
            });
            Mock::new(&levels.collect::<Vec<_>>())
        };
        let mut hall = Hall::new(pin(0), pin(1), pin(2));
        let counts = states.iter().map(|_| hall.count()).collect();
        let failed = hall.failed();
        hall.a.done();
        hall.b.done();
        hall.c.done();
        (counts, failed)
    }

    #[test]
    fn states_count_both_ways_and_what_cannot_be_is_held() {
        let forward: Vec<u8> = TURN.iter().copied().cycle().take(20).collect();
        assert_eq!(counts(&forward).0, (0..20).collect::<Vec<_>>());
        let backward: Vec<u8> = TURN.iter().rev().copied().cycle().take(20).collect();
        assert_eq!(counts(&backward).0, (0..20).map(|k| -k).collect::<Vec<_>>());
        assert_eq!(
            counts(&[0b001, 0b000, 0b111, 0b011]),
            (vec![0, 0, 0, 1], false)
        );
        assert!(counts(&[0b001, 0, 0, 0, 0, 0]).1);
    }
}
