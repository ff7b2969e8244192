//! The periods of one recording whose command comes again and again.

use super::settings::{ANOTHER_PERIOD, FEW_VALUES, ONE_PERIOD, SHORTEST_S};
use servoid_engine::problem::Data;
use std::ops::Range;

/// The whole periods among the samples of `range`, one after the other; fewer than two where its command never comes again.
///
/// The period is the least lag at which the command is itself again, after a lag at which it was not (A. de Cheveigné, H. Kawahara, *YIN, a
/// fundamental frequency estimator for speech and music*, 2002, there for sounds); as many of them are taken together as last for the
/// shortest run. Rests before and behind belong to none; the last period ends with the command, so that what is left over lies at the start,
/// where a motor is still cold and a driver may sleep.
pub(super) fn periods(data: &Data, range: &Range<usize>, interval_s: f64) -> Vec<Range<usize>> {
    let command = data.asked(range);
    let moves = |&u: &f64| u != 0.0;
    let (Some(first), Some(last)) = (
        command.iter().position(moves),
        command.iter().rposition(moves),
    ) else {
        return Vec::new();
    };
    let Some(period) = period_of(&command[first..=last]) else {
        return Vec::new();
    };
    let together = (SHORTEST_S / (period as f64 * interval_s)).ceil().max(1.0);
    let length = period * together as usize;
    let count = (last + 1 - first) / length;
    let begin = range.start + last + 1 - count * length;
    (0..count)
        .map(|k| begin + k * length..begin + (k + 1) * length)
        .collect()
}

/// Samples after which a command is itself again.
fn period_of(command: &[f64]) -> Option<usize> {
    let mean = command.iter().sum::<f64>() / command.len() as f64;
    let squares: f64 = command.iter().map(|u| (u - mean).powi(2)).sum();
    let spread = squares / command.len() as f64;
    if spread <= 0.0 {
        return None;
    }
    // The RMS difference at a lag over every so manyeth value, as a part of what unrelated values would have; infinite beyond `most`.
    let every_difference = |lag: usize, most: f64, every: usize| {
        let pairs = command.iter().zip(&command[lag..]).step_by(every);
        let unrelated = 2.0 * spread * pairs.len() as f64;
        let enough = unrelated * most * most;
        let mut sum = 0.0;
        for (u, v) in pairs {
            sum += (u - v).powi(2);
            if sum > enough {
                return f64::INFINITY;
            }
        }
        (sum / unrelated).sqrt()
    };
    // Most lags are told by a few values.
    let few = command.len().div_ceil(FEW_VALUES);
    let difference = |lag: usize, most: f64| {
        let first = every_difference(lag, 2.0 * most, few);
        if first.is_infinite() {
            return first;
        }
        every_difference(lag, most, 1)
    };
    let longest = command.len() / 2;
    let doubled = std::iter::successors(Some(1), |lag| Some(2 * lag));
    let other = doubled
        .take_while(|&lag| lag <= longest)
        .find(|&lag| difference(lag, ANOTHER_PERIOD).is_infinite())?;
    let again = (other..=longest).find(|&lag| difference(lag, ONE_PERIOD).is_finite())?;
    // Beside it the command may be nearer still.
    let nearest = (again..=longest)
        .map(|lag| (difference(lag, ONE_PERIOD), lag))
        .take_while(|(apart, _)| apart.is_finite())
        .min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.map(|(_, lag)| lag)
}
