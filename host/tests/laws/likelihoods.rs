//! The likelihood of the cells, and profiles: tighter than least squares where the noise is small, a meter of misfit, and the same
//! interval as the standard error where the model is straight.

use servoid_identify::fit::{Fit, LEAST_NOISE, Options, RISE_95};
use servoid_identify::{Silent, identify, truth};
use servoid_io::record::Record;
use servoid_io::recording::Recording;
use servoid_io::{excitation, showcase};
use servoid_plant::{Bench, Hidden};
use shared::cost::Cost;
use shared::effects::Kind;
use testing::length::cases;

const INTERVAL: Cost = Cost::Interval { noise_counts: 0.1 };

fn recorded(hidden: Option<Hidden>, noise_counts: f64, seed: u64) -> Recording {
    let mut bench = Bench::new(showcase::machine());
    bench.counts_per_rev = showcase::COUNTS_PER_REV;
    bench.effects = hidden.into_iter().collect();
    bench.angle_noise_counts = noise_counts;
    bench.seed = seed;
    let plan = excitation::named("commissioning").unwrap();
    let drive = excitation::drive(&plan, bench.sample_s, seed, bench.machine.supply_v);
    bench.record(&drive, "bench", false).unwrap()
}

fn fitted(recording: &Recording, cost: Cost, effects: &[Kind], profile: bool) -> Fit {
    let options = Options {
        effects: effects.to_vec(),
        cost,
        profile,
        ..Options::default()
    };
    identify(recording, &options, &Silent::default()).unwrap()
}

fn std(fit: &Fit, name: &str) -> f64 {
    let parameter = fit.parameters.iter().find(|p| p.name == name);
    parameter.and_then(|p| p.std).unwrap()
}

#[test]
fn where_the_noise_is_small_the_cells_tell_far_more_than_squares() {
    let machine = truth::physical(&showcase::machine()).machine();
    let response = machine.response();
    let wanted = [
        ("gain", response.gain),
        ("a1", response.a1),
        ("electrical_time_constant", response.a2 / response.a1),
    ];
    // How much tighter, at least, and how far off in standard errors on average over all seeds and parameters.
    for (noise, tighter) in [(0.0, 5.0), (0.01, 2.0), (0.1, 1.0)] {
        let mut squares = Vec::new();
        for seed in 1..=cases(30, 4) {
            let recording = recorded(None, noise, seed);
            let least_squares = fitted(&recording, Cost::Squared, &[], false);
            let likely = fitted(&recording, INTERVAL, &[], false);
            let found = likely.reading_noise.unwrap();
            if noise == 0.0 {
                assert!(found.counts <= 4.0 * LEAST_NOISE, "seed {seed}: {found:?}");
            } else {
                let off = (found.counts - noise) / found.std.unwrap();
                assert!(off.abs() < 5.0, "seed {seed}, noise {noise}: {found:?}");
            }
            for (name, truth) in wanted {
                let (before, after) = (std(&least_squares, name), std(&likely, name));
                assert!(
                    after * tighter < before,
                    "seed {seed}, noise {noise}, {name}: {before:e}, then {after:e}"
                );
                let parameter = likely.parameters.iter().find(|p| p.name == name).unwrap();
                squares.push(((parameter.value - truth) / after).powi(2));
            }
        }
        let sd = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        println!("noise {noise}: errors have {sd:.2} standard errors");
        assert!(sd < 1.3, "noise {noise}: {sd}");
    }
}

#[test]
fn what_a_residual_hides_is_noise_before_the_counter() {
    let machine = showcase::machine();
    for (name, part) in [
        ("windage", 0.02),
        ("coulomb", 0.003),
        ("supply_sag", 0.02),
        ("dead_zone", 0.01),
    ] {
        let hidden = Hidden::typical(name, &machine).unwrap();
        let hidden = hidden.scaled(part).unwrap();
        let recording = recorded(Some(hidden), 0.0, 3);
        let fit = fitted(&recording, INTERVAL, &[], false);
        let noise = fit.reading_noise.unwrap();
        println!("{name}: {} counts RMS, noise {noise:?}", fit.rms_counts);
        assert!(noise.counts > 4.0 * LEAST_NOISE, "{name}: {noise:?}");
    }
}

#[test]
fn a_profile_is_the_parabola_of_the_standard_error_where_the_model_is_straight() {
    for seed in 1..=cases(4, 1) {
        let recording = recorded(None, 0.0, seed);
        let fit = fitted(&recording, Cost::Squared, &[], true);
        assert_eq!(fit.profiles.len(), 3);
        for profile in &fit.profiles {
            let std = profile.std.unwrap();
            for (end, sign) in profile.interval.iter().zip([-1.0, 1.0]) {
                let distance = sign * (end.unwrap() - profile.best) / std;
                assert!(
                    (distance - RISE_95.sqrt()).abs() < 0.1,
                    "seed {seed}: {profile:?}"
                );
            }
            assert!(profile.points.windows(2).all(|pair| pair[0].0 < pair[1].0));
        }
    }
}

/// Friction that is none can be no less than none: the profile ends there, and says how large it may be.
#[test]
fn a_profile_ends_where_a_parameter_does() {
    let recording = recorded(None, 0.0, 1);
    let fit = fitted(&recording, Cost::Squared, &[Kind::Coulomb], true);
    let friction = fit
        .profiles
        .iter()
        .find(|p| p.name == "coulomb.torque")
        .unwrap();
    println!("{friction:?}");
    let [low, high] = friction.interval;
    assert!(low.is_none_or(|low| low >= 0.0) && high.is_some_and(|high| high < 1e-3));
    assert!(
        friction
            .points
            .iter()
            .all(|(value, deviance)| *value >= 0.0 && *deviance >= 0.0)
    );
}
