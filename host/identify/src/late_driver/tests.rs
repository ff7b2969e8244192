//! Laws over recordings of the bench.

use super::LateDriver;
use crate::check::edges_after_rest;
use servoid_io::recording::Recording;
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;

const SEEDS: std::ops::Range<u64> = 1..31;

fn with(effect: &str, seed: u64) -> Option<Recording> {
    let hidden = Hidden::typical(effect, &showcase::machine()).ok()?;
    showcase::record(&[hidden], seed, "bench").ok()
}

/// The same log, begun `seconds` before the driver woke, while its first command stood there already.
fn late(recording: &Recording, seconds: f64) -> Recording {
    let interval = recording.median_interval_s();
    let asleep = (seconds / interval).round() as usize;
    let mut late = recording.clone();
    let start = recording.time_s[0];
    let before = |k: usize| start + (k as f64 - asleep as f64) * interval;
    late.time_s.splice(0..0, (0..asleep).map(before));
    let first = recording.command[0];
    late.command.splice(0..0, vec![first; asleep]);
    late.counts.splice(0..0, vec![recording.counts[0]; asleep]);
    late
}

#[test]
fn a_driver_that_woke_late_is_cut_off_where_it_woke() {
    let (mut tried, mut found) = (0, 0);
    for seed in SEEDS {
        let whole = with("coulomb", seed).expect("a recording");
        let Some(edge) = edges_after_rest(&whole).next() else {
            continue;
        };
        let recording = whole.samples(edge..whole.len());
        tried += 1;
        let slept_s = 0.04 + 0.003 * seed as f64;
        if let Some(woken) = LateDriver::of(&late(&recording, slept_s)) {
            let off = woken.after_s - slept_s;
            assert!(off.abs() < 0.01, "seed {seed}: {off} s beside {slept_s} s");
            found += 1;
        }
    }
    assert!(tried > 5 && found * 10 >= tried * 8, "{found} of {tried}");
}

#[test]
fn no_effect_passes_for_a_driver_that_woke_late() {
    for (kind, seed) in Kind::ALL.iter().zip(SEEDS) {
        let Some(recording) = with(kind.name(), seed) else {
            continue;
        };
        let found = LateDriver::of(&recording);
        assert_eq!(found, None, "{} of seed {seed}", kind.name());
    }
}
