//! f32 and fixed point stay within one encoder count of f64 over ten seconds, for motors of all
//! sizes, linear and with effects.

mod motors;

use motors::{BENCHES, Bench, INTERVAL, furthest, run};
use shared::effects::Kind;
use shared::excite::{COMMISSIONING, COMMISSIONING_COAST, Experiment, Shape, commands};
use shared::scalar::Fixed;

const SUBSTEPS: u16 = 2;

#[test]
fn every_format_stays_within_one_count_of_f64_over_ten_seconds() {
    let step = [Experiment {
        shape: Shape::Step,
        seconds: 10.0,
        amplitude: 1.0,
    }];
    for (name, experiments) in [
        ("step", &step[..]),
        ("commissioning", &COMMISSIONING[..]),
        ("coasting", &COMMISSIONING_COAST[..]),
    ] {
        let drive: Vec<_> = commands::<f64>(experiments, INTERVAL, 1)
            .take(10_000)
            .collect();
        for bench in &BENCHES {
            let plan = bench.plan(&[], SUBSTEPS);
            let exact = run::<f64>(&plan, &drive);
            let single = furthest(&exact, &run::<f32>(&plan, &drive));
            let fixed = furthest(&exact, &run::<Fixed>(&plan, &drive));
            let travel = exact.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            println!(
                "{name:13} {:34} {travel:9.0} counts: f32 {single:.4}, fixed {fixed:.5}",
                bench.name
            );
            assert!(
                single < 1.0,
                "{name}, {}: f32 is {single} counts off",
                bench.name
            );
            assert!(
                fixed < 1.0,
                "{name}, {}: fixed point is {fixed} counts off",
                bench.name
            );
        }
    }
}

#[test]
fn every_effect_in_every_format_stays_within_one_count_of_f64() {
    let drive: Vec<_> = commands::<f64>(&COMMISSIONING, INTERVAL, 1).collect();
    for bench in &BENCHES {
        for (kind, values) in Kind::ALL.iter().flat_map(|&kind| in_all_forms(kind, bench)) {
            let plan = bench.plan(&[(kind, &values)], SUBSTEPS);
            let exact = run::<f64>(&plan, &drive);
            let single = furthest(&exact, &run::<f32>(&plan, &drive));
            let fixed = furthest(&exact, &run::<Fixed>(&plan, &drive));
            println!(
                "{:34} {:14}: f32 {single:.4}, fixed {fixed:.5} {values:?}",
                bench.name,
                kind.name()
            );
            assert!(
                fixed < 1.0,
                "{} with {}: fixed point {fixed} off",
                bench.name,
                kind.name()
            );
            assert!(
                single < 1.0,
                "{} with {}: f32 {single} off",
                bench.name,
                kind.name()
            );
        }
    }
}

/// Typical values of an effect in SI for a bench, in the textbook's form and at both ends of its blends.
fn in_all_forms(kind: Kind, bench: &Bench) -> Vec<(Kind, Vec<f64>)> {
    let mut all = vec![(kind, bench.typical(kind))];
    for (index, parameter) in kind.parameters().iter().enumerate() {
        if parameter.form.is_some() {
            for end in [parameter.range.0, parameter.range.1] {
                // Not at the typical size: a form that jumps would jump at a command of the mix, on either side of it by the
                // format's last digit.
                let mut values: Vec<f64> = bench.typical(kind).iter().map(|x| 1.003 * x).collect();
                values[index] = end;
                all.push((kind, values));
            }
        }
    }
    all
}
