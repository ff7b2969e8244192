//! Laws of the score over synthetic motors that torque noise drives.

use super::foretold::foretold;
use super::gains::{Filter, Plant};
use super::innovations::{Innovations, Prior};
use super::noise::{Noise, estimate};
use super::readings::Readings;
use super::repeatability::repeatability_counts;
use super::settings::FORETOLD;
use super::spread::standard_errors;
use crate::diagnose::candidate::descent::{Settings, descend};
use crate::diagnose::context::Budget;
use crate::fit::base_for;
use crate::noisy_motor::{self, candidate, machine};
use servoid_engine::problem::{
    Data, ELECTRICAL_TIME_CONSTANT, Horizon, StartAngle, Structure, errors, rms_counts,
};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use std::sync::atomic::AtomicBool;

const SEEDS: std::ops::RangeInclusive<u64> = 1..=30;

/// The motor with torque noise of an intensity in counts²/s³ and a ripple, V; another seed is another command.
fn recording(seconds: f64, noise: f64, ripple_v: f64, seed: u64) -> Data {
    noisy_motor::Run {
        seconds,
        noise,
        ripple_v,
        command_seed: seed,
        period: noisy_motor::ONCE,
        noise_seed: seed,
    }
    .recorded()
}

fn plant() -> Plant {
    Plant::of(&machine())
}

fn estimated(readings: &Readings<'_>) -> Noise {
    let stop = AtomicBool::new(false);
    let method = Method::default();
    estimate(readings, plant(), &candidate(), method, &[], &stop)[0]
}

fn free_errors(data: &Data, horizon: &Horizon) -> Vec<f64> {
    let (start, cost) = (StartAngle::Free, Cost::Squared);
    errors(data, &candidate(), Method::default(), horizon, start, cost).expect("a run")
}

/// Without torque noise all that an observer learns is where the run began: its gains are those of a running mean.
#[test]
fn without_torque_noise_innovations_are_the_errors_of_a_free_run() {
    let data = recording(1.0, 0.0, 0.0, 1);
    let readings = Readings::every(&data, 0.012);
    let noise = Noise {
        torque: 0.0,
        reading: readings.floor,
    };
    let filter = Filter::new(&readings, plant(), &[noise]);
    for (k, correction) in filter.corrections.iter().enumerate() {
        let mean = 1.0 / (k as f64 + 2.0);
        assert!(
            (correction.angle - mean).abs() < 1e-12,
            "{k}: {correction:?}"
        );
        assert_eq!(correction.speed, 0.0);
    }
}

/// Over thirty seeds, at three intensities of which the least is near the encoder's own error.
#[test]
fn the_noise_of_one_recording_tells_how_far_a_right_model_strays() {
    for noise in [1e6, 1e8, 1e10] {
        let (mut found, mut strayed) = (0.0, 0.0);
        for seed in SEEDS {
            let data = recording(6.0, noise, 0.0, seed);
            let readings = Readings::every(&data, 0.012);
            let estimated = estimated(&readings);
            let ratio = estimated.torque / noise;
            assert!((0.4..2.5).contains(&ratio), "seed {seed}, {noise}: {ratio}");
            found += libm::log(ratio);
            let left = rms_counts(&data, &free_errors(&data, &Horizon::windows(&data, 0.5)));
            strayed += libm::log(left / repeatability_counts(&estimated, plant(), 0.5));
        }
        let seeds = SEEDS.count() as f64;
        let (found, strayed) = (libm::exp(found / seeds), libm::exp(strayed / seeds));
        println!(
            "{noise}: intensity {found:.3} of the true one, strays {strayed:.3} of what is foretold"
        );
        assert!((0.8..1.25).contains(&found), "{noise}: {found}");
        assert!((0.75..1.3).contains(&strayed), "{noise}: {strayed}");
    }
}

#[test]
fn a_ripple_is_foretold_and_noise_is_not() {
    let mut wrong = 0;
    for seed in SEEDS {
        let share = |ripple_v: f64| {
            let data = recording(16.0, 1e9, ripple_v, seed);
            let readings = Readings::every(&data, 0.012);
            let filter = Filter::new(&readings, plant(), &[estimated(&readings)]);
            let all = free_errors(&data, &Horizon::Corrected(filter.corrections.clone()));
            let errors = readings.errors(&all);
            foretold(&readings, &filter, &errors).expect("a thousand readings")
        };
        let (white, ripple) = (share(0.0), share(0.5));
        assert!(ripple.share > FORETOLD, "seed {seed}: {ripple:?}");
        assert_eq!(ripple.from, Some("angle"), "seed {seed}");
        wrong += usize::from(white.share > FORETOLD);
    }
    assert!(wrong <= 1, "{wrong} of {} are no noise", SEEDS.count());
}

/// Over thirty seeds: what gain and time constant are off by, in their standard errors.
#[test]
fn standard_errors_are_as_large_as_the_errors() {
    let truth = machine().response();
    let (mut held, mut squares, mut tried) = (0, 0.0, 0);
    for seed in SEEDS {
        let data = recording(6.0, 1e9, 0.0, seed);
        let readings = Readings::every(&data, 0.012);
        let filter = Filter::new(&readings, plant(), &[estimated(&readings)]);
        let base = base_for(&data, &[], true);
        let structure = Structure::around(&data, base, &[], &machine(), false)
            .with_fixed(ELECTRICAL_TIME_CONSTANT, 0.0);
        let about = Prior { about: machine() };
        let method = Method::default();
        let innovations = Innovations::new(&readings, &filter, about, structure.clone(), method);
        let start = structure.coordinates(&structure.values_of(&machine(), &[], 0.0));
        let stop = AtomicBool::new(false);
        let budget = Budget::usual(&stop);
        let found = descend(&innovations, &start, Settings::THOROUGH, &budget).expect("a fit");
        let values = structure.values(&found.x);
        let errors = standard_errors(&innovations, &structure, &found.x, 1.0);
        for (name, truth) in [("gain", truth.gain), ("a1", truth.a1)] {
            let mut unknowns = structure.unknowns.iter();
            let place = unknowns.position(|unknown| unknown.name == name);
            let off = (values[place.expect("an unknown")] - truth) / errors[name];
            println!("seed {seed}: {name} is off by {off:.2} standard errors");
            held += usize::from(off.abs() < 2.0);
            squares += off * off;
            tried += 1;
        }
    }
    let square = squares / f64::from(tried);
    println!("{held} of {tried} within two, mean square {square:.2}");
    assert!(held >= 53, "{held} of {tried}");
    assert!((0.5..1.6).contains(&square), "{square}");
}
