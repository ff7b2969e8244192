//! The limits, against recordings of motors that hide nothing and of motors that hide something.

use super::*;
use crate::fit::{self, Options, scores};
use servoid_engine::solve::levenberg_marquardt::LevenbergMarquardt;
use servoid_io::excitation;
use servoid_io::record::Record;
use servoid_plant::{Bench, Hidden, Machine};
use shared::excite::{Experiment, Shape};
use std::sync::atomic::AtomicBool;

const SEEDS: u64 = 96;

/// What the linear motor leaves of a recording of four seconds.
fn left(
    preset: &str,
    hide: Option<&str>,
    shape: Shape,
    counts: u32,
    seed: u64,
) -> Option<Whiteness> {
    let machine = Machine::preset(preset).expect("a preset");
    let mut bench = Bench::new(machine);
    bench.counts_per_rev = counts;
    bench.sample_s = 1e-3;
    bench.seed = seed;
    let hidden = hide.map(|name| Hidden::typical(name, &machine).expect("an effect"));
    bench.effects = hidden.into_iter().collect();
    let plan = [Experiment {
        shape,
        seconds: 4.0,
        amplitude: 0.3 + 0.7 * (seed % 10) as f64 / 10.0,
    }];
    let drive = excitation::drive(&plan, 1e-3, seed, machine.supply_v);
    let data = Data::new(&bench.record(&drive, "bench", false).ok()?).ok()?;
    let options = Options::default();
    let problem = fit::problem(&data, &options).ok()?;
    let stop = AtomicBool::new(false);
    let solver = LevenbergMarquardt::default();
    let found = fit::search(&problem, &solver, &options, &stop, &mut |_, _| {});
    let candidate = problem.structure.candidate_at(&found.x);
    let errors = scores::whole(&data, &candidate, options.method).ok()?;
    whiteness(&data, &errors)
}

fn shape(name: &str) -> Shape {
    let mut all = Shape::ALL.iter();
    all.find(|(known, _)| *known == name).expect("a shape").1
}

#[test]
fn a_motor_that_hides_nothing_stays_within_the_limits() {
    let (mut auto, mut input) = (Vec::new(), Vec::new());
    for seed in 0..SEEDS {
        let preset = servoid_plant::PRESETS[seed as usize % servoid_plant::PRESETS.len()];
        let shapes = [
            "steps",
            "telegraph",
            "staircase",
            "reversals",
            "triangle",
            "chirp",
        ];
        let name = shapes[seed as usize / 2 % shapes.len()];
        let counts = [500, 2000, 8000][seed as usize % 3];
        if let Some(found) = left(preset, None, shape(name), counts, seed) {
            println!("{seed} {preset} {name} {counts}: {found:?}");
            auto.push(found.autocorrelation);
            input.push(found.input);
        }
    }
    let mut within = true;
    for (what, all, limit) in [
        ("autocorrelation", &mut auto, AUTOCORRELATION_LIMIT),
        ("input", &mut input, INPUT_LIMIT),
    ] {
        all.sort_by(f64::total_cmp);
        let of = |part: f64| all[((all.len() - 1) as f64 * part) as usize];
        println!(
            "{what}: {} recordings, median {}, 90 % {}, most {}",
            all.len(),
            of(0.5),
            of(0.9),
            of(1.0)
        );
        within &= all.len() >= 30 && of(1.0) < limit;
    }
    assert!(within, "a limit is passed by a motor that hides nothing");
}

#[test]
fn a_motor_that_hides_something_does_not() {
    for (seed, name) in ["coulomb", "cogging", "delay", "windage", "brush_drop"]
        .iter()
        .enumerate()
    {
        let found =
            left("gearmotor", Some(name), shape("steps"), 2000, seed as u64).expect("motion");
        println!("{name}: {found:?}");
        assert!(!found.is_white(), "{name}: {found:?}");
    }
}
