//! Whether a recording holds anything to fit.

use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::spike::spike;
use crate::recording::Recording;

/// Least travel of a recording to be fitted, counts. The quantisation of a reading is 1/√12 count, so that
/// a gain from less travel would err by more than 3 %.
pub const MIN_TRAVEL_COUNTS: f64 = 10.0;

impl Recording {
    /// Refuses a recording without a response, or whose reading is broken: no command, no motion, a reading that
    /// stands alone, or a counter that ran over.
    ///
    /// # Errors
    /// [`ReadFault::NoCommand`], [`ReadFault::NeverMoved`], [`ReadFault::TooLittleTravel`] (less than
    /// [`MIN_TRAVEL_COUNTS`]), [`ReadFault::Spike`], [`ReadFault::CounterRanOver`] or [`ReadFault::Wraps`], with the recording's
    /// source.
    pub fn check_excited(&self) -> Result<(), ReadError> {
        excitation_fault(self).map_or(Ok(()), |fault| {
            Err(ReadError::new(Place::file(&self.source), fault))
        })
    }
}

fn excitation_fault(recording: &Recording) -> Option<ReadFault> {
    let driven = |k: usize| recording.enabled.as_ref().is_none_or(|enabled| enabled[k]);
    if (0..recording.len()).all(|k| recording.command[k] == 0.0 || !driven(k)) {
        return Some(ReadFault::NoCommand);
    }
    let least = recording
        .counts
        .iter()
        .copied()
        .fold(f64::INFINITY, f64::min);
    let most = recording
        .counts
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    let travel = most - least;
    if travel == 0.0 {
        return Some(ReadFault::NeverMoved { counts: least });
    }
    if travel < MIN_TRAVEL_COUNTS {
        return Some(ReadFault::TooLittleTravel {
            travel,
            needed: MIN_TRAVEL_COUNTS,
        });
    }
    spike(recording)
        .or_else(|| {
            [16, 32]
                .into_iter()
                .find_map(|bits| ran_over(recording, travel, bits))
        })
        .or_else(|| wraps(recording, travel))
}

/// An angle that starts anew every revolution, or every 2^k counts: see [`wraps_every`].
fn wraps(recording: &Recording, travel: f64) -> Option<ReadFault> {
    let powers = (8..=32).map(|bits| 2f64.powi(bits));
    std::iter::once(recording.counts_per_rev)
        .chain(powers)
        // Angles printed with few digits may end a little outside the turn.
        .filter(|turn| travel <= 1.001 * turn && travel > 0.8 * turn)
        .find_map(|turn| wraps_every(recording, turn))
}

/// At least two jumps of nearly a whole `turn`, each among small steps that go the other way, as the motion
/// itself does when the reading wraps. A real jump would be among steps the same way, and a glitch would
/// jump back at once.
fn wraps_every(recording: &Recording, turn: f64) -> Option<ReadFault> {
    let wrap = |readings: &[f64]| {
        let [before, jump, after] = [0, 1, 2].map(|k| readings[k + 1] - readings[k]);
        let small = |step: f64| step.abs() < turn / 4.0;
        let short_by = turn - jump.abs();
        let turns_on = (before + after) * jump < 0.0 || short_by <= 2.0;
        small(before) && small(after) && small(short_by) && jump.abs() > 0.75 * turn && turns_on
    };
    let mut found = (recording.counts.windows(4).enumerate()).filter(|(_, four)| wrap(four));
    let (first, four) = found.next()?;
    found.next()?;
    Some(ReadFault::Wraps {
        time_s: recording.time_s[first + 2],
        from: four[1],
        to: four[2],
        turn,
    })
}

/// A counter of `bits` that ran over: all readings lie in one turn of it, and a jump shrinks to less than a
/// quarter when a turn is added. Real motion that fast would leave the turn at once.
fn ran_over(recording: &Recording, travel: f64, bits: u32) -> Option<ReadFault> {
    let turn = 2f64.powi(bits as i32);
    if !recording.quantised || travel >= turn {
        return None;
    }
    let pairs = recording.counts.windows(2).zip(&recording.time_s[1..]);
    pairs
        .map(|(pair, time)| (pair[0], pair[1], *time))
        .find_map(|(from, to, time_s)| {
            let jump = (to - from).abs();
            (turn - jump < jump / 4.0).then_some(ReadFault::CounterRanOver {
                time_s,
                from,
                to,
                bits,
            })
        })
}
