//! Laws of the losses that are found, against the virtual bench, where the truth is the difference between
//! a counter that loses and one that does not.

use super::found;
use crate::diagnose::context::{Budget, Context};
use crate::diagnose::linear::fit_linear;
use crate::diagnose::models::{Loss, Losses};
use crate::fit::Options;
use servoid_engine::problem::Data;
use servoid_io::record::Record;
use servoid_plant::{Bench, DriveSample, Hidden, Machine, PRESETS};
use shared::effects::Kind;
use shared::excite::{COMMISSIONING, commands};
use std::sync::atomic::AtomicBool;
use testing::length::cases;

const INTERVAL_S: f64 = 1e-3;

/// The machine under the commissioning drive.
fn record(machine: Machine, effects: &[&str], counts_per_rev: u32, seed: u64) -> Option<Data> {
    let mut bench = Bench::new(machine);
    bench.seed = seed;
    bench.counts_per_rev = counts_per_rev;
    bench.sample_s = INTERVAL_S;
    bench.effects = effects
        .iter()
        .map(|spec| Hidden::parse(spec, &machine).unwrap())
        .collect();
    let drive: Vec<DriveSample> = commands::<f64>(&COMMISSIONING, INTERVAL_S, seed)
        .map(|command| DriveSample {
            volts: 0.8 * command.drive * machine.supply_v,
            enabled: command.enabled,
        })
        .collect();
    let recording = bench.record(&drive, "bench", false).ok()?;
    Data::new(&recording).ok()
}

/// What the counter lost: the reading without losses less that with them.
fn truth(lossless: &Data, with_losses: &Data) -> Vec<Loss> {
    let lost = |k: usize| lossless.counts[k] - with_losses.counts[k];
    (1..lossless.len())
        .filter_map(|sample| {
            let counts = lost(sample) - lost(sample - 1);
            (counts != 0.0).then_some(Loss { sample, counts })
        })
        .collect()
}

/// What is found in two recordings of the machine, by the linear motor.
fn losses(data: &Data, held_out: &Data) -> Option<(Losses, f64)> {
    let options = Options::default();
    let stop = AtomicBool::new(false);
    let budget = Budget::usual(&stop);
    let context = Context::new(data, held_out, &options, &budget);
    let (context, base) = fit_linear(context, &options).unwrap();
    if base.free().at_floor() {
        return None;
    }
    let model = found(&context, &base)?;
    Some((model.losses.unwrap(), model.rms_counts))
}

/// Readings within so many samples are the same event.
const NEAR: usize = 1;

#[test]
fn what_is_lost_is_found_and_nothing_else() {
    let (mut hits, mut of, mut false_ones) = (0, 0, 0);
    let mut worst: Vec<(f64, String)> = Vec::new();
    let rounds = cases(8, 2);
    for (index, name) in PRESETS.iter().enumerate() {
        let machine = Machine::preset(name).unwrap();
        for round in 0..rounds {
            let seed = 1000 * index as u64 + round;
            let counts_per_rev = [1000, 2048, 4096, 16384][round as usize % 4];
            let largest = [4, 12, 40][round as usize % 3];
            let effect = format!("missed_counts:largest={largest}");
            let lossless = record(machine, &[], counts_per_rev, seed).unwrap();
            let data = record(machine, &[&effect], counts_per_rev, seed).unwrap();
            let held_out = record(machine, &[&effect], counts_per_rev, seed + 500).unwrap();
            let truth = truth(&lossless, &data);
            let (found, rms) = losses(&data, &held_out).unwrap_or((Losses::default(), f64::NAN));
            let matches =
                |a: &Loss, b: &Loss| a.sample.abs_diff(b.sample) <= NEAR && a.counts == b.counts;
            let hit = truth
                .iter()
                .filter(|t| found.fitted.iter().any(|f| matches(f, t)))
                .count();
            let wrong = found
                .fitted
                .iter()
                .filter(|f| !truth.iter().any(|t| matches(f, t)))
                .count();
            hits += hit;
            of += truth.len();
            false_ones += wrong;
            let says = format!(
                "{name} seed {seed} cpr {counts_per_rev} largest {largest}: {hit} of {}, {wrong} false, rms {rms:.3}",
                truth.len()
            );
            println!("{says}");
            if hit < truth.len() || wrong > 0 {
                for t in truth
                    .iter()
                    .filter(|t| !found.fitted.iter().any(|f| matches(f, t)))
                {
                    println!("   missed {t:?}");
                }
                for f in found
                    .fitted
                    .iter()
                    .filter(|f| !truth.iter().any(|t| matches(f, t)))
                {
                    println!("   false {f:?}");
                }
            }
            worst.push((hit as f64 / truth.len().max(1) as f64, says));
        }
    }
    println!("{hits} of {of}, {false_ones} false");
    assert!(hits as f64 > 0.95 * of as f64, "{hits} of {of}: {worst:?}");
    assert!((false_ones as f64) < 0.02 * of as f64, "{false_ones} false");
}

#[test]
fn other_physics_loses_nothing() {
    let mut wrong = Vec::new();
    let presets = PRESETS.iter().take(cases(PRESETS.len(), 1));
    for (index, name) in presets.enumerate() {
        let machine = Machine::preset(name).unwrap();
        let seed = 77 + index as u64;
        let others = Kind::ALL.iter().filter(|&&kind| !kind.facts().by_chance);
        for kind in others {
            let record = |seed| record(machine, &[kind.name()], 4096, seed);
            let (Some(data), Some(held_out)) = (record(seed), record(seed + 500)) else {
                continue;
            };
            if let Some((losses, rms)) = losses(&data, &held_out) {
                wrong.push(format!("{name} {kind:?} seed {seed} rms {rms}: {losses:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
