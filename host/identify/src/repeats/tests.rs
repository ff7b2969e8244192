//! Laws of repeats over synthetic motors that torque noise drives.

use super::{LackOfFit, Repeats};
use crate::noisy_motor::{ONCE, Run, candidate};
use servoid_engine::problem::Data;
use servoid_engine::simulation::Method;

const SEEDS: std::ops::RangeInclusive<u64> = 1..=30;
const WINDOW_S: f64 = 0.5;

/// `count` runs of one command.
fn runs(count: u64, noise: f64, ripple_v: f64, seed: u64) -> Vec<Data> {
    let run = |repeat| Run {
        seconds: 6.0,
        noise,
        ripple_v,
        command_seed: seed,
        period: ONCE,
        noise_seed: 1000 * seed + repeat,
    };
    (0..count).map(|repeat| run(repeat).recorded()).collect()
}

fn lack_of_fit(runs: &[Data]) -> LackOfFit {
    let sets: Vec<&Data> = runs.iter().collect();
    let repeats = Repeats::among(&sets).expect("repeats");
    let found = repeats.lack_of_fit(&candidate(), Method::default(), WINDOW_S);
    found.expect("a run")
}

#[test]
fn a_right_model_misses_repeats_by_what_they_differ_by() {
    for count in [2, 4] {
        let (mut ratio, mut rejected) = (0.0, 0);
        for seed in SEEDS {
            let found = lack_of_fit(&runs(count, 1e9, 0.0, seed));
            assert_eq!(found.runs, count as usize);
            ratio += libm::log(found.ratio());
            rejected += usize::from(found.p_value < 0.05);
        }
        let ratio = libm::exp(ratio / SEEDS.count() as f64);
        println!("{count} runs: ratio {ratio:.3}, {rejected} rejected at 0.05");
        assert!((0.95..1.05).contains(&ratio), "{count} runs: {ratio}");
        // Five in a hundred are expected; six of thirty come by chance once in 300 times.
        assert!(rejected < 6, "{count} runs: {rejected} of 30 rejected");
    }
}

/// Each run starts at the same angle, so that the ripple is common to all.
#[test]
fn what_a_model_lacks_is_common_to_all_repeats() {
    for seed in SEEDS {
        let right = lack_of_fit(&runs(4, 1e7, 0.0, seed));
        let lacking = lack_of_fit(&runs(4, 1e7, 1.0, seed));
        assert!(!lacking.is_repeatability(), "seed {seed}: {lacking:?}");
        assert!(lacking.p_value < 0.05, "seed {seed}: {lacking:?}");
        let squares = lacking.noise_counts.powi(2) + lacking.systematic_counts.powi(2);
        let whole = lacking.model_counts.powi(2);
        assert!(
            (squares / whole - 1.0).abs() < 1e-9,
            "seed {seed}: {lacking:?}"
        );
        assert!(
            right.explained_share(&lacking) > 0.9,
            "seed {seed}: {right:?}"
        );
    }
}

#[test]
fn only_recordings_of_one_command_are_repeats() {
    for seed in SEEDS {
        let mut sets = runs(2, 1e8, 0.0, seed);
        sets.extend(runs(1, 1e8, 0.0, seed + 100));
        let all: Vec<&Data> = sets.iter().collect();
        let repeats = Repeats::among(&all).expect("two of one command");
        assert_eq!(repeats.runs(), 2, "seed {seed}");
        assert!(Repeats::among(&all[1..]).is_none(), "seed {seed}");
        let parting = &repeats.partings(WINDOW_S)[0];
        assert!(parting.in_windows > 1.0 && parting.over_run > parting.in_windows);
    }
}

#[test]
fn a_recording_that_was_cut_at_its_start_is_still_a_repeat() {
    let all = runs(2, 1e8, 0.0, 1);
    let whole = lack_of_fit(&all);
    let second = Run {
        seconds: 6.0,
        noise: 1e8,
        ripple_v: 0.0,
        command_seed: 1,
        period: ONCE,
        noise_seed: 1001,
    }
    .recording();
    let cut = Data::new(&second.samples(100..second.len())).expect("a recording");
    let found = lack_of_fit(&[all[0].clone(), cut]);
    let ratio = found.noise_counts / whole.noise_counts;
    assert!((0.8..1.25).contains(&ratio), "{found:?} beside {whole:?}");
}

#[test]
fn the_periods_of_one_recording_tell_what_repeats_tell() {
    let (mut ratio, mut noise) = (0.0, 0.0);
    for seed in SEEDS {
        let periodic = Run {
            seconds: 12.5,
            noise: 1e9,
            ripple_v: 0.0,
            command_seed: seed,
            period: 24,
            noise_seed: seed,
        };
        let found = lack_of_fit(&[periodic.recorded()]);
        // Of 4.08 s, behind a rest.
        assert_eq!(found.runs, 3, "seed {seed}: {found:?}");
        ratio += libm::log(found.ratio());
        noise += libm::log(found.noise_counts / lack_of_fit(&runs(3, 1e9, 0.0, seed)).noise_counts);
    }
    let mean = |sum: f64| libm::exp(sum / SEEDS.count() as f64);
    let (ratio, noise) = (mean(ratio), mean(noise));
    println!("ratio {ratio:.3}, noise {noise:.3} of that of three recordings");
    assert!((0.95..1.05).contains(&ratio), "{ratio}");
    assert!((0.9..1.1).contains(&noise), "{noise}");
}

#[test]
fn a_command_that_never_comes_again_has_no_periods() {
    for seed in SEEDS {
        let [once] = &runs(1, 1e8, 0.0, seed)[..] else {
            unreachable!("one run");
        };
        assert!(Repeats::among(&[once]).is_none(), "seed {seed}");
        let mut slow = once.clone();
        // A ramp, a chirp, and a constant.
        let laws: [fn(f64) -> f64; 3] = [|t| t, |t| libm::sin(t * t), |_| 6.0];
        for law in laws {
            slow.command = slow.time_s.iter().map(|&t| law(t)).collect();
            assert!(Repeats::among(&[&slow]).is_none(), "seed {seed}");
        }
    }
}
