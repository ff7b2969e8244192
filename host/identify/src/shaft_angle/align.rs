//! Recordings in terms of the first one's angle of the shaft.

use super::found::Reference;
use super::settings::MOST_SAMPLES;
use servoid_engine::problem::Data;
use servoid_io::recording::Recording;
use std::f64::consts::TAU;

/// Counts to be added to the readings of each of the `others` for them to be in terms of the angle of the `first`; zero where nothing shows that they are
/// not.
pub fn turns(first: &Recording, others: &[&Recording]) -> Vec<f64> {
    let nothing = || vec![0.0; others.len()];
    if others.is_empty() {
        return nothing();
    }
    let begin = |recording: &Recording| {
        Data::taken(recording.samples(0..recording.len().min(MOST_SAMPLES)))
    };
    let lowered = others.iter().map(|other| begin(other));
    // What cannot be lowered is refused where it is fitted, with the reason.
    let (Ok(data), Ok(lowered)) = (begin(first), lowered.collect::<Result<Vec<_>, _>>()) else {
        return nothing();
    };
    let Some(reference) = Reference::of(&data) else {
        return nothing();
    };
    let ahead = reference.ahead(&lowered).into_iter().zip(others);
    ahead
        .map(|(ahead, other)| ahead.map_or(0.0, |ahead| ahead / TAU * other.counts_per_rev))
        .collect()
}

/// Adds them; returns a remark on each recording that is turned.
pub fn align_shaft_angles(fitted: &mut [Recording], held_out: &mut [Recording]) -> Vec<String> {
    let Some((first, others)) = fitted.split_first_mut() else {
        return Vec::new();
    };
    let mut others: Vec<&mut Recording> = others.iter_mut().chain(held_out).collect();
    let turns = turns(
        first,
        &others.iter().map(|other| &**other).collect::<Vec<_>>(),
    );
    let turned = others
        .iter_mut()
        .zip(turns)
        .filter(|(_, turn)| *turn != 0.0);
    turned
        .map(|(other, turn)| {
            other.turn(turn);
            format!(
                "{}: torques that repeat with the shaft's angle stand {:.2} degrees from where {} has them, as of an encoder that was zeroed in \
                 between: {turn:+.2} counts are added to its readings",
                other.source,
                360.0 * turn / other.counts_per_rev,
                first.source,
            )
        })
        .collect()
}
