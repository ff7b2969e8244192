//! Gearboxes: dry friction on both sides of the play is found, and how it is shared.

use servoid_identify::fit::Options;
use servoid_identify::{Silent, diagnose};
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use testing::length::cases;

/// The encoder's floor with room for a recording whose readings dwell in one part of their cells, counts RMS.
const NOISE: f64 = 0.33;
/// Error of a share that is found.
const SHARE_OFF: f64 = 0.02;
/// Shares of the friction that the load has.
const SHARES: [f64; 3] = [0.4, 0.7, 0.2];

#[test]
fn friction_on_both_sides_of_a_gap_is_named_with_its_share() {
    let machine = showcase::machine();
    let torque = 0.03 * machine.stall_torque_n_m();
    for (seed, share) in (1..).step_by(2).zip(SHARES).take(cases(3, 1)) {
        let mut own = Hidden::typical("coulomb", &machine).expect("in the catalogue");
        own.set("torque", (1.0 - share) * torque)
            .expect("in its range");
        let mut gap = Hidden::typical("backlash", &machine).expect("in the catalogue");
        gap.set("friction", share * torque).expect("in its range");
        let record = |seed: u64| {
            showcase::record(&[own.clone(), gap.clone()], seed, "gearbox").expect("the bench runs")
        };
        let (fitted, other) = (record(seed), record(seed + 1));
        let found = diagnose(
            &fitted,
            Some(&other),
            &Options::default(),
            &Silent::default(),
        )
        .expect("a diagnosis");
        let steps = &found.diagnosis.steps;
        let mut named: Vec<&str> = steps.iter().map(|step| step.added.name()).collect();
        named.sort_unstable();
        let last = &found.diagnosis.last;
        let values = last.values_of(Kind::Backlash);
        println!("seed {seed}: {named:?}, {:?}, {values:?}", last.free());
        assert_eq!(named, ["backlash", "coulomb"], "seed {seed}");
        assert!(last.free().fitted < NOISE, "seed {seed}");
        let off = values.last().expect("the share") - share;
        assert!(
            off.abs() < SHARE_OFF,
            "seed {seed}: {share} is found as {values:?}"
        );
    }
}
