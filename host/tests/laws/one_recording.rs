//! Diagnoses of one recording, whose end is held out: it begins in the middle of the motion.

use servoid_identify::fit::Options;
use servoid_identify::{Silent, diagnose};
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use testing::length::cases;

/// Missing counts are named, and leave more than the encoder's own error.
const LEAVES_MORE: &str = "missed_counts";

#[test]
fn an_effect_of_typical_size_is_named_whatever_the_held_out_end_begins_with() {
    let mut missed = Vec::new();
    for seed in 1..=cases(2, 1) {
        for effect in Kind::ALL
            .iter()
            .map(|kind| kind.name())
            .filter(|name| *name != LEAVES_MORE)
        {
            let hidden = Hidden::typical(effect, &showcase::machine()).unwrap();
            let recording = showcase::record(std::slice::from_ref(&hidden), seed, "bench").unwrap();
            let found =
                diagnose(&recording, None, &Options::default(), &Silent::default()).unwrap();
            let steps = &found.diagnosis.steps;
            let named: Vec<&str> = steps.iter().map(|step| step.added.name()).collect();
            if named != [effect] {
                missed.push(format!("seed {seed}: {effect} is called {named:?}"));
            }
        }
    }
    assert!(missed.is_empty(), "{missed:#?}");
}
