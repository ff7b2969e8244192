//! Fits take steps that are short enough for their standard errors.

use servoid_identify::fit::{Fit, Options};
use servoid_identify::{Silent, identify};
use servoid_io::recording::Recording;
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use testing::length::cases;

/// Effects whose torque changes within a sample, of those that a fit finds from regression.
const EFFECTS: [&str; 4] = ["unbalance", "stribeck", "windage", "torque_sat"];
/// Two fits may differ by so many standard errors: each moves by 0.3 of them at most when its steps are halved once more.
const APART: f64 = 0.7;

fn fit(recording: &Recording, effect: &str, substeps: u16) -> Fit {
    let mut options = Options {
        effects: vec![Kind::by_name(effect).unwrap()],
        ..Options::default()
    };
    options.method.substeps = substeps;
    identify(recording, &options, &Silent::default()).unwrap()
}

#[test]
fn the_steps_that_a_fit_begins_with_do_not_change_its_parameters() {
    for seed in 1..=cases(2, 1) {
        for effect in EFFECTS.into_iter().take(cases(EFFECTS.len(), 2)) {
            let hidden = Hidden::typical(effect, &showcase::machine()).unwrap();
            let recording = showcase::record(std::slice::from_ref(&hidden), seed, "bench").unwrap();
            let (coarse, fine) = (fit(&recording, effect, 1), fit(&recording, effect, 16));
            for one in &coarse.parameters {
                let same = fine.parameters.iter().find(|other| other.name == one.name);
                let Some(other) = same else { continue };
                if let (Some(coarse), Some(fine)) = (one.std, other.std) {
                    let apart = (one.value - other.value).abs();
                    assert!(
                        apart <= APART * coarse.max(fine),
                        "seed {seed}, {effect}: {one:?}, {other:?}"
                    );
                }
            }
        }
    }
}
