//! How near a fit comes to the truth, which only the bench knows.

use std::ops::RangeInclusive;

use servoid_plant::{Machine, PRESETS};
use testing::length::has_its_turn;

use crate::contract::{is_fit, number, parameter};
use crate::desk::Desk;

/// Largest error of gain and mechanical time constant, relative.
const RELATIVE: f64 = 5e-4;
/// The floor of the encoder is 0.2887 counts: more is a wrong model, much less is a wrong sum.
const RMS_COUNTS: RangeInclusive<f64> = 0.26..=0.30;
/// Standard errors that an estimate may be off by before they are called too small.
const STANDARD_ERRORS: f64 = 6.0;

/// How the fitted recording is made, and how the held-out one.
const RECORDINGS: &[(&str, &str)] = &[
    ("--seed 1", "--seed 2"),
    ("--seed 3", "--seed 4"),
    ("--seed 1 --jitter 1e-4", "--seed 2 --jitter 1e-4"),
    ("--seed 1", "--seed 2 --sample 2e-3"),
    ("--seed 1 --excite commissioning-coast", "--seed 2"),
];

/// Gain K/D and mechanical time constant (R·J + L·f)/D of a machine, with D = Kt·Kb + R·f.
fn truth(machine: &Machine) -> [(&'static str, f64); 2] {
    let m = machine;
    let total = m.kt_n_m_a * m.kb_v_s_rad + m.resistance_ohm * m.viscous_n_m_s;
    let a1 = (m.resistance_ohm * m.inertia_kg_m2 + m.inductance_h * m.viscous_n_m_s) / total;
    [("gain", m.kt_n_m_a / total), ("a1", a1)]
}

#[test]
fn every_machine_is_identified_down_to_the_quantiser() {
    for (m, name) in PRESETS.iter().enumerate() {
        let machine = Machine::preset(name).expect("a preset");
        for (r, (fitted, held_out)) in RECORDINGS.iter().enumerate() {
            if !has_its_turn(m + r, PRESETS.len()) {
                continue;
            }
            let desk = Desk::new();
            desk.done(&format!("simulate --machine {name} {fitted} --out rec.csv"));
            desk.done(&format!(
                "simulate --machine {name} {held_out} --out other.csv"
            ));
            let fit = desk.json("fit rec.csv --validate other.csv");
            let case = format!("{name}, {fitted}, {held_out}: {fit:#}");
            is_fit(&fit);
            for error in ["rms_counts", "validate_rms_counts"] {
                assert!(
                    RMS_COUNTS.contains(&number(&fit, error)),
                    "{error} of {case}"
                );
            }
            for (what, truth) in truth(&machine) {
                let found = parameter(&fit, what);
                let (value, std) = (number(found, "value"), number(found, "std"));
                assert!(
                    (value / truth - 1.0).abs() <= RELATIVE,
                    "{what} is {truth} in {case}"
                );
                assert!(
                    (value - truth).abs() <= STANDARD_ERRORS * std,
                    "{what} is {truth} in {case}"
                );
                assert_eq!(found["identifiable"], true, "{what} of {case}");
            }
        }
    }
}
