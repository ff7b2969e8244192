//! Laws outside the catalogue, hidden in motors of the bench of which the truth is known.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::*;
use crate::fit::Options;
use crate::{Silent, identify_data};
use servoid_engine::problem::{Candidate, Data};
use servoid_io::excitation;
use servoid_io::record::Record;
use servoid_io::recording::Recording;
use servoid_plant::effects::At;
use servoid_plant::{Bench, Machine, Outside, OutsideLaw, Run};
use shared::excite::COMMISSIONING;

/// A recording with the true motion behind it.
struct Known {
    run: Run,
    data: Data,
}

fn known(law: Option<&OutsideLaw>, machine: &Machine, seed: u64) -> Known {
    let mut bench = Bench::new(*machine);
    bench.counts_per_rev = 4096;
    bench.seed = seed;
    bench.outside = law.cloned();
    let drive = excitation::drive(&COMMISSIONING, 1e-3, seed, machine.supply_v);
    let recording: Recording = bench.record(&drive, "bench", false).expect("a recording");
    let data = Data::new(&recording).expect("data");
    let run = bench.run(&drive).expect("a run");
    Known { run, data }
}

fn fitted(data: &Data) -> Candidate {
    let options = Options::default();
    let fit = identify_data(data, None, &options, &Silent::default()).expect("a fit");
    fit.candidate
}

/// RMS of the difference of a law from the truth as a part of the truth, along the motion of a recording, without what the
/// model's own parameters can take.
fn departure(
    law: &Law,
    truth: &OutsideLaw,
    machine: &Machine,
    known: &Known,
    candidate: &Candidate,
) -> f64 {
    let equation = Equation::new(&known.data, candidate).expect("motion");
    let run = &known.run;
    let mut memory = 0.0;
    let volts: Vec<f64> = (0..run.counts.len())
        .map(|k| {
            let n = (k + 1).min(run.counts.len() - 1);
            let speed = 0.5 * (run.speed_rad_s[k] + run.speed_rad_s[n]);
            let at = At {
                angle: 0.5 * (run.angle_rad[k] + run.angle_rad[n]),
                speed,
                current: equation.motion.current[k] / machine.resistance_ohm,
                memory,
            };
            memory = truth.remembered(memory, speed, 1e-3);
            truth.volts(machine, &at)
        })
        .collect();
    let mut target = equation.torque(&volts);
    let mut proposed = vec![0.0; target.len()];
    for term in &law.terms {
        for (column, by) in equation.columns(term).iter().zip(&term.amplitudes) {
            for (sum, x) in proposed.iter_mut().zip(column) {
                *sum += by * x;
            }
        }
    }
    let basis = orthonormal(&equation.own);
    take_out(&basis, &mut target);
    take_out(&basis, &mut proposed);
    let off: Vec<f64> = target.iter().zip(&proposed).map(|(a, b)| a - b).collect();
    (dot(&off, &off) / dot(&target, &target)).sqrt()
}

/// The volts of a law beside those of a perfect model, and the laws that are proposed with their departures.
fn proposed(form: &'static Outside, machine: &Machine, seed: u64) -> Vec<(f64, Law)> {
    let truth = form.draw(machine, seed);
    let one = known(Some(&truth), machine, seed);
    let other = known(Some(&truth), machine, seed + 1000);
    let candidate = fitted(&one.data);
    let laws = propose(&one.data, &other.data, &candidate, 5);
    let candidate = super::refined::refined(&one.data, &candidate);
    let judged = laws.into_iter();
    judged
        .map(|law| (departure(&law, &truth, machine, &other, &candidate), law))
        .collect()
}

#[test]
#[ignore = "the table of all forms, for the eye"]
fn table() {
    let only = std::env::var("FORM").ok();
    let from: u64 = std::env::var("FROM")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(0);
    let seeds: u64 = std::env::var("SEEDS")
        .ok()
        .and_then(|s| s.parse().ok())
        .unwrap_or(2);
    let machine = std::env::var("MACHINE").unwrap_or_else(|_| "gearmotor".to_owned());
    let machine = Machine::preset(&machine).expect("a preset");
    for form in Outside::ALL
        .iter()
        .filter(|f| only.as_ref().is_none_or(|o| o == f.name))
    {
        for seed in from..from + seeds {
            let start = std::time::Instant::now();
            let truth = form.draw(&machine, seed);
            let laws = proposed(form, &machine, seed);
            println!("{truth:?}  {:.1} s", start.elapsed().as_secs_f64());
            {
                let one = known(Some(&truth), &machine, seed);
                let candidate = fitted(&one.data);
                let judge = super::judge::Judge::new(&one.data, &one.data, &candidate).unwrap();
                let base = judge.try_terms(&[]).unwrap();
                println!(
                    "    {:?} then {:?}",
                    candidate.machine,
                    super::refined::refined(&one.data, &candidate).machine
                );
                println!(
                    "    base {:.4} crossed {:.4} noise {:.4}",
                    base.fitted.sqrt(),
                    base.crossed.sqrt(),
                    judge.fitted.noise.sqrt()
                );
            }
            for (off, law) in laws.iter().take(3) {
                println!(
                    "    {off:.3} explained {:.3}  {}",
                    law.explained,
                    law.formula("found")
                );
            }
        }
    }
}
