//! Laws outside the catalogue, hidden in motors of the bench of which the truth is known.

use super::discover::keep_simplest;
use super::equation::{Equation, dot, orthonormal, take_out};
use super::term::{Load, Speed, Term};
use super::*;
use crate::diagnose::Budget;
use crate::fit::Options;
use crate::{Silent, identify_data};
use servoid_engine::problem::{Candidate, Data};
use servoid_io::excitation;
use servoid_io::record::Record;
use servoid_io::recording::Recording;
use servoid_plant::{Bench, Hidden, Machine, Outside, OutsideLaw, Run};
use shared::effects::Kind;
use shared::excite::COMMISSIONING;
use std::sync::atomic::AtomicBool;
use testing::length::{cases, has_its_turn};

/// A recording with the true motion behind it.
struct Known {
    run: Run,
    data: Data,
}

fn known(law: Option<&OutsideLaw>, machine: &Machine, seed: u64) -> Known {
    known_beside(&[], law, machine, seed)
}

fn known_beside(
    effects: &[Hidden],
    law: Option<&OutsideLaw>,
    machine: &Machine,
    seed: u64,
) -> Known {
    let mut bench = Bench::new(*machine);
    bench.effects = effects.to_vec();
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

fn given(truth: &OutsideLaw, machine: &Machine, run: &Run) -> Given {
    let given = truth.along(machine, run).into_iter();
    given.map(|given| (given.torque, given.voltage)).collect()
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
    let mut target = given(truth, machine, &known.run).seen(&equation);
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
    let laws = propose(&one.data, &other.data, &candidate);
    let candidate = super::refined::refined(&one.data, &candidate, &[]);
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
                let judge =
                    super::judge::Judge::new(&one.data, &one.data, &candidate, &[]).unwrap();
                let base = judge.try_terms(&[]).unwrap();
                println!(
                    "    {:?} then {:?}",
                    candidate.machine,
                    super::refined::refined(&one.data, &candidate, &[]).machine
                );
                println!(
                    "    base {:.4} crossed {:.4} noise {:.4}",
                    base.fitted.sqrt(),
                    base.crossed.sqrt(),
                    judge.fitted_noise.sqrt()
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

/// Share of laws whose curve must be found within a tenth.
const FOUND: f64 = 0.7;

/// The nearest of the proposals is near the truth, whatever the form.
#[test]
fn hidden_laws_are_proposed() {
    let machine = Machine::gearmotor();
    let seeds = cases(3, 1);
    let forms = cases(Outside::ALL.len(), 2);
    let (mut near, mut all) = (0, 0);
    for form in Outside::ALL.iter().take(forms) {
        for seed in 0..seeds {
            let laws = proposed(form, &machine, seed);
            let best = laws
                .iter()
                .map(|(off, _)| *off)
                .fold(f64::INFINITY, f64::min);
            println!("{} {seed}: {best:.3}", form.name);
            all += 1;
            near += usize::from(best <= 0.1);
        }
    }
    assert!(near as f64 >= FOUND * all as f64, "{near} of {all}");
}

/// Most motors have dry friction, which is most of what the linear motor lacks: laws that only look like it must not stand before the one
/// that is beside it.
#[test]
fn laws_are_proposed_beside_the_friction_that_motors_have() {
    let machine = Machine::gearmotor();
    let friction = Hidden::typical("coulomb", &machine).expect("an effect");
    let names = ["cubic_drag", "current_square", "viscous_by_angle"];
    for name in names.into_iter().take(cases(names.len(), 1)) {
        let form = Outside::find(name).expect("a form");
        let truth = form.draw(&machine, 2);
        let [one, other] = [2, 1002].map(|seed| {
            known_beside(
                std::slice::from_ref(&friction),
                Some(&truth),
                &machine,
                seed,
            )
        });
        let candidate = super::discover::beside_usual(fitted(&one.data));
        let laws = propose(&one.data, &other.data, &candidate);
        let simple = laws.iter().filter(|law| law.terms.len() == 1);
        let off = simple
            .map(|law| {
                // The current that it sees is that of the motor beside it.
                let motor = super::refined::refined(&one.data, &candidate, &law.terms);
                departure(law, &truth, &machine, &other, &motor)
            })
            .fold(f64::INFINITY, f64::min);
        assert!(off < 0.1, "{name}: {off} off, of {laws:?}");
    }
}

/// Where the catalogue explains all, no law is looked for.
#[test]
fn where_nothing_is_missing_no_law_is_looked_for() {
    let machine = Machine::gearmotor();
    let stop = AtomicBool::new(false);
    let options = Options {
        discover: true,
        ..Options::default()
    };
    for seed in 0..cases(30, 2) {
        let [one, other] = [seed, seed + 1000].map(|seed| known(None, &machine, seed));
        let budget = Budget::usual(&stop);
        let (found, laws) = search_with_laws(&one.data, &other.data, &options, &budget, &|| ())
            .expect("a diagnosis");
        assert!(found.steps.is_empty() && laws.is_none(), "{seed}: {laws:?}");
    }
}

/// A law of one term that explains all leaves out others but one that explains the rest of it; one that leaves more than another does not.
#[test]
fn the_simplest_law_that_explains_all_is_kept() {
    let law = |terms: usize, explained: f64, left: f64| Law {
        terms: vec![Term::torque(Speed::Sign, Load::Size); terms],
        explained,
        left,
        resembles: None,
    };
    let exact = law(1, 0.995, 0.01);
    let part = law(1, 0.6, 0.8);
    let both = law(2, 0.996, 0.009);
    let the_rest = law(2, 0.9995, 0.002);
    let of_a_poor_model = law(1, 1.0, 0.05);
    let kept = |laws: &[&Law]| {
        let mut kept: Vec<Law> = laws.iter().map(|&law| law.clone()).collect();
        keep_simplest(&mut kept);
        kept.iter().map(|law| law.left).collect::<Vec<_>>()
    };
    assert_eq!(kept(&[&exact, &part, &both]), [0.01]);
    assert_eq!(kept(&[&exact, &part, &the_rest]), [0.01, 0.002]);
    assert_eq!(kept(&[&part, &the_rest]), [0.8, 0.002]);
    let close = law(1, 0.98, 0.01);
    assert_eq!(
        kept(&[&close, &both, &of_a_poor_model]),
        [0.01, 0.009, 0.05]
    );
}

/// A law beside its own curve stays in the band, and beside another's leaves it.
#[test]
fn a_curve_without_a_form_tells_a_right_law_from_a_wrong_one() {
    let machine = Machine::gearmotor();
    let form = Outside::find("saturating_drag").expect("a form");
    let truth = form.draw(&machine, 3);
    let one = known(Some(&truth), &machine, 3);
    let text =
        "right: torque = -c*w/(ws + abs(w)); c = 0.3 in [0, 5] V; ws = 100 in [1, 1000] rad/s";
    let right = servoid_formula::define(text).expect("a law");
    for (kind, leaves) in [(right, false), (Kind::Coulomb, true)] {
        let options = Options {
            effects: vec![kind],
            ..Options::default()
        };
        let fit = identify_data(&one.data, None, &options, &Silent::default()).expect("a fit");
        let curves = Curve::of_each(&one.data, &fit.candidate, &[kind]);
        let curve = curves[0].as_ref().expect("a curve");
        assert_eq!(curve.carrier, Carrier::Speed);
        assert_eq!(
            curve.leaves().is_some(),
            leaves,
            "{}: {:?}",
            kind.name(),
            curve.points
        );
    }
}

/// What may be left beside the truth: a part of what is missing, and times what the encoder's cells leave of a perfect model.
const LEFT: f64 = 0.03;
const CELLS: f64 = 1.5;

/// What the exact linear motor misses along the measured motion is the hidden law, but for what a linear motor may take of either.
#[test]
fn what_the_equation_misses_is_the_truth() {
    let machine = Machine::gearmotor();
    for (number, form) in Outside::ALL.iter().enumerate() {
        if !has_its_turn(number, 4) {
            continue;
        }
        let truth = form.draw(&machine, 10);
        let one = known(Some(&truth), &machine, 10);
        let mut exact = fitted(&one.data);
        exact.machine.kb = machine.kb_v_s_rad;
        exact.machine.damping = machine.winding_volts(machine.viscous_n_m_s);
        exact.machine.inertia = machine.winding_volts(machine.inertia_kg_m2);
        exact.machine.electrical = machine.inductance_h / machine.resistance_ohm;
        let equation = Equation::new(&one.data, &exact).expect("motion");
        let mut missing = equation.missing.clone();
        let mut left = given(&truth, &machine, &one.run).seen(&equation);
        left.iter_mut()
            .zip(&missing)
            .for_each(|(given, missing)| *given -= missing);
        let basis = orthonormal(equation.linear());
        take_out(&basis, &mut left);
        take_out(&basis, &mut missing);
        let rms = |of: &[f64]| (dot(of, of) / of.len() as f64).sqrt();
        let noise = equation.perfect(&exact).expect("counts").sqrt();
        let (left, missing) = (rms(&left), rms(&missing));
        println!(
            "{}: {left:.4} of {missing:.4} V, {noise:.4} by cells",
            form.name
        );
        assert!(
            left < LEFT * missing + CELLS * noise,
            "{}: {left} of {missing}",
            form.name
        );
    }
}
