//! Laws over recordings of the bench, the second of which reads as an encoder does that was zeroed elsewhere.

use super::align_shaft_angles;
use servoid_io::recording::Recording;
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use std::slice;
use testing::length::cases;

/// The seeds that are tried.
fn seeds() -> std::ops::RangeInclusive<u64> {
    1..=cases(30, 6)
}

fn with(effect: &str, seed: u64) -> Option<Recording> {
    let hidden = Hidden::typical(effect, &showcase::machine()).ok()?;
    showcase::record(&[hidden], seed, "bench").ok()
}

/// What is added to the second of two recordings whose counts are `zeroed` lower than in terms of the first, counts.
fn added(effect: &str, seed: u64, zeroed: f64) -> Option<f64> {
    let (first, mut second) = (with(effect, seed)?, with(effect, seed + 100)?);
    for count in &mut second.counts {
        *count -= zeroed;
    }
    let before = second.counts[0];
    let mut first = [first];
    let remarks = align_shaft_angles(&mut first, slice::from_mut(&mut second));
    let added = second.counts[0] - before;
    assert_eq!(
        remarks.is_empty(),
        added == 0.0,
        "{effect} of seed {seed}: {remarks:?}"
    );
    Some(added)
}

/// Whole counts: the readings stay readings but for the turn.
fn zeroed(seed: u64) -> f64 {
    (137.0 * seed as f64) % 2000.0
}

#[test]
fn a_recording_of_an_encoder_that_was_zeroed_is_turned_back() {
    for (effect, order) in [("cogging", 12.0), ("unbalance", 1.0)] {
        let (mut tried, mut found) = (0, 0);
        for seed in seeds() {
            let Some(added) = added(effect, seed, zeroed(seed)) else {
                continue;
            };
            // One wave of a torque looks like the next.
            let wave = 2000.0 / order;
            let off = (added - zeroed(seed) + 0.5 * wave).rem_euclid(wave) - 0.5 * wave;
            tried += 1;
            // What lies within 8 degrees of a wave is taken as it is.
            let alike = added == 0.0 && 360.0 * off.abs() / wave < 9.0;
            found += u64::from(alike || off.abs() < 0.5);
        }
        assert!(
            tried == *seeds().end() && found + 1 >= tried,
            "{effect}: {found} of {tried}"
        );
    }
}

#[test]
fn a_recording_of_the_same_zero_stays_as_it_is() {
    for effect in ["cogging", "unbalance"] {
        for seed in seeds() {
            let added = added(effect, seed, 0.0).expect("recordings");
            assert_eq!(added, 0.0, "{effect} of seed {seed}");
        }
    }
}

#[test]
fn what_repeats_with_no_angle_turns_nothing() {
    let turned = |kind: &&Kind| ["cogging", "unbalance", "enc_ecc"].contains(&kind.name());
    for kind in Kind::ALL.iter().filter(|kind| !turned(kind)) {
        for seed in 1..=cases(3, 1) {
            let added = added(kind.name(), seed, zeroed(seed));
            assert_eq!(added.unwrap_or(0.0), 0.0, "{} of seed {seed}", kind.name());
        }
    }
}
