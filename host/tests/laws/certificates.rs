//! A recording without noise has a certificate: one motor reproduces every reading, and the true one is within its bounds.

use servoid_identify::certificate::Certificate;
use servoid_identify::fit::Options;
use servoid_identify::{Silent, identify, truth};
use servoid_io::recording::Recording;
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use shared::motor::Response;
use testing::length::cases;

/// Effects that a fit finds from regression, and whose run is not chaotic. Not a sag of the supply: the bench feeds it back on the
/// winding's current at once, the model from part to part of a sample, which moves the electrical time constant by 5e-5 of it.
const EFFECTS: [&str; 7] = [
    "coulomb",
    "asym_viscous",
    "offset_voltage",
    "load_torque",
    "windage",
    "torque_sat",
    "unbalance",
];

fn certificate(recording: &Recording, effects: &[&str]) -> Certificate {
    let options = Options {
        effects: effects
            .iter()
            .filter_map(|name| Kind::by_name(name))
            .collect(),
        certificate: true,
        ..Options::default()
    };
    let fit = identify(recording, &options, &Silent::default()).unwrap();
    fit.certificate.unwrap()
}

fn holds(certificate: &Certificate, name: &str, value: f64) {
    let bounds = certificate.bounds.iter().find(|bounds| bounds.name == name);
    let Some(bounds) = bounds else { return };
    let inside =
        bounds.low.is_none_or(|low| low <= value) && bounds.high.is_none_or(|high| value <= high);
    assert!(inside, "{name}: {value} is true, not within {bounds:?}");
}

#[test]
fn one_motor_reproduces_every_reading_and_the_true_one_is_within_the_bounds() {
    let machine = showcase::machine();
    let Response { gain, a1, a2 } = truth::physical(&machine).machine().response();
    for seed in 1..=cases(4, 1) {
        for name in EFFECTS.into_iter().take(cases(EFFECTS.len(), 3)) {
            let hidden = Hidden::typical(name, &machine).unwrap();
            let recording = showcase::record(std::slice::from_ref(&hidden), seed, "bench").unwrap();
            let found = certificate(&recording, &[name]);
            println!("seed {seed}, {name}: {found:?}");
            assert!(found.is_feasible(), "seed {seed}, {name}: {found:?}");
            assert_eq!(found.reproduced, found.readings, "seed {seed}, {name}");
            assert!(found.contradiction.is_empty());
            for (parameter, value) in [
                ("gain", gain),
                ("a1", a1),
                ("electrical_time_constant", a2 / a1),
            ] {
                holds(&found, parameter, value);
            }
            let kind = Kind::by_name(name).unwrap();
            let counts_per_rev = recording.counts_per_rev as u32;
            for (parameter, value) in kind
                .parameters()
                .iter()
                .zip(hidden.truth(&machine, counts_per_rev))
            {
                holds(&found, &format!("{name}.{}", parameter.name), value);
            }
        }
    }
}

#[test]
fn a_model_that_lacks_an_effect_is_refuted_by_a_few_readings() {
    for name in EFFECTS {
        let hidden = Hidden::typical(name, &showcase::machine()).unwrap();
        let recording = showcase::record(std::slice::from_ref(&hidden), 1, "bench").unwrap();
        let found = certificate(&recording, &[]);
        assert!(
            !found.is_feasible() && found.bounds.is_empty(),
            "{name}: {found:?}"
        );
        let few = found.contradiction.len();
        // Three unknowns, the start angle and the room.
        assert!((1..=5).contains(&few), "{name}: {found:?}");
    }
}
