//! Diagnoses of drawn motors whose hidden effect once led the search astray.

use host::diagnose::{Effort, diagnose};
use host::fit::Options;
use host::prove::{Case, Excite, HowMany, SetUp};
use shared::effects::Kind;
use std::sync::atomic::AtomicBool;

const SEED: u64 = 20_261_121;
const CASES: u64 = 8;
/// The encoder's floor with room for a recording whose readings dwell in one part of their cells, counts RMS.
const NOISE: f64 = 0.33;

/// A load that drives the motor far away bends the linear fit by orders of magnitude; beside it the motor is as
/// plain as without.
#[test]
fn a_strong_constant_load_is_named_and_nothing_else() {
    let set_up = SetUp {
        seed: SEED,
        hidden: HowMany::One,
        excite: Excite::Commissioning,
        effects: vec!["load_torque".to_owned()],
    };
    let stop = AtomicBool::new(false);
    for number in 0..CASES {
        let case = Case::record(&set_up, number).unwrap();
        let diagnosis = diagnose(
            &case.fitted,
            &case.held_out,
            &Options::default(),
            &Effort::usual(&stop),
            &|| (),
        )
        .unwrap();
        let what = format!("seed {SEED}, case {number}: {:?}", case.drawn);
        if diagnosis.base.free().fitted < 1.0 {
            continue;
        }
        let [step] = &diagnosis.steps[..] else {
            panic!("{} effects named, {what}", diagnosis.steps.len());
        };
        // A motor with hardly any inductance cannot tell a load from an offset.
        let set: Vec<Kind> = std::iter::once(step.added)
            .chain(step.indistinguishable_from.iter().copied())
            .collect();
        assert!(set.contains(&Kind::LoadTorque), "{set:?}, {what}");
        let errors = diagnosis.last.free();
        assert!(
            errors.fitted < NOISE && errors.held_out < NOISE,
            "{errors:?}, {what}"
        );
    }
}
