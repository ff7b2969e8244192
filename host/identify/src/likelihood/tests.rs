//! Laws on simulated recordings. The simulator shares nothing with the filter: fine steps of the equation of motion.

use super::{Coordinate, Maximum, Observed, Settings, Terms, fit, rank};
use crate::fit::{self as free_run, Options};
use servoid_engine::problem::Data;
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::effects::Kind;
use shared::rng;
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

const COUNTS_PER_REV: f64 = 4096.0;
const FINE_S: f64 = 2.5e-5;
const SAMPLE_S: f64 = 1e-3;

/// A motor, SI.
#[derive(Clone, Copy, Debug)]
struct Motor {
    inertia: f64,
    damping: f64,
    coulomb: f64,
    offset: f64,
    delay: f64,
    noise: f64,
}

const NUMBERS: [Coordinate; 5] = [
    Coordinate::Inertia,
    Coordinate::Damping,
    Coordinate::Coulomb,
    Coordinate::Offset,
    Coordinate::Delay(0),
];

impl Motor {
    fn truth(&self) -> [f64; 5] {
        [
            self.inertia,
            self.damping,
            self.coulomb,
            self.offset,
            self.delay,
        ]
    }

    /// A drawn one; its delay is a whole number of fine steps.
    fn drawn(uniform: &mut dyn FnMut() -> f64, noise: f64) -> Motor {
        Motor {
            inertia: 5e-4 + 5e-4 * uniform(),
            damping: 0.04 + 0.02 * uniform(),
            coulomb: 0.3 + 0.6 * uniform(),
            offset: 0.3 * uniform() - 0.15,
            delay: ((1e-3 + 4e-3 * uniform()) / FINE_S).round() * FINE_S,
            noise,
        }
    }

    /// Steps of random size and length, ±12 V.
    fn recorded(&self, seconds: f64, uniform: &mut dyn FnMut() -> f64) -> Recording {
        let samples = (seconds / SAMPLE_S) as usize;
        let mut command = vec![0.0; samples];
        let mut at = 50;
        while at < samples {
            let length = ((0.03 + 0.3 * uniform()) / SAMPLE_S) as usize;
            let level =
                12.0 * [-1.0, 1.0, 0.5, -0.5, 0.0, 0.25, -0.25][(7.0 * uniform()) as usize % 7];
            let level = level * (0.6 + 0.4 * uniform());
            let end = (at + length).min(samples);
            command[at..end].fill(level);
            at = end;
        }
        let parts = (SAMPLE_S / FINE_S).round() as usize;
        let late = (self.delay / FINE_S).round() as usize;
        let (mut angle, mut speed) = (0.37 * TAU / COUNTS_PER_REV, 0.0f64);
        let decay = libm::exp(-FINE_S * self.damping / self.inertia);
        let mut counts = Vec::with_capacity(samples);
        for k in 0..samples {
            counts.push((angle * COUNTS_PER_REV / TAU).floor());
            for part in 0..parts {
                let fine = k * parts + part;
                let volts = if fine >= late {
                    command[(fine - late) / parts]
                } else {
                    0.0
                };
                // Box and Muller's normal number.
                let normal =
                    (-2.0 * libm::log(uniform().max(1e-300))).sqrt() * libm::cos(TAU * uniform());
                let drive = volts + self.offset + self.noise * normal / FINE_S.sqrt();
                let friction = if speed != 0.0 {
                    self.coulomb * speed.signum()
                } else {
                    drive.clamp(-self.coulomb, self.coulomb)
                };
                let end = (drive - friction) / self.damping;
                let next = end + (speed - end) * decay;
                let next = if next * speed < 0.0 { 0.0 } else { next };
                angle += 0.5 * FINE_S * (speed + next);
                speed = next;
            }
        }
        Recording {
            source: "simulated".to_owned(),
            time_s: (0..samples).map(|k| k as f64 * SAMPLE_S).collect(),
            command,
            counts,
            measured: Series::NONE,
            enabled: None,
            counts_per_rev: COUNTS_PER_REV,
            quantised: true,
            supply_v: Some(12.0),
            drive: Drive::Voltage,
            position: None,
        }
    }
}

fn likely(data: &Data) -> Maximum {
    let observed = Observed::new(data).expect("a motor that moves");
    let stop = AtomicBool::new(false);
    fit(&[&observed], Terms::USUAL, &Settings::default(), &stop).expect("a fit")
}

fn values(m: &Maximum) -> [f64; 5] {
    NUMBERS.map(|c| c.get(&m.parameters))
}

/// The same numbers by free runs of 0.5 s.
fn windowed(data: &Data) -> [f64; 5] {
    let options = Options {
        effects: vec![Kind::Coulomb, Kind::OffsetVoltage, Kind::Delay],
        window_s: Some(0.5),
        budget: 2000,
        ..Options::default()
    };
    let problem = free_run::problem(data, &options).expect("a start");
    let solver = servoid_engine::solve::by_name("lm").expect("a method");
    let stop = AtomicBool::new(false);
    let found = free_run::search(&problem, solver.as_ref(), &options, &stop, &mut |_, _| {});
    let model = problem.structure.candidate_at(&found.x);
    let effect = |kind| {
        let (_, values) = model
            .effects
            .iter()
            .find(|(own, _)| *own == kind)
            .expect("an effect");
        values[0]
    };
    [
        model.machine.inertia,
        model.machine.kb + model.machine.damping,
        effect(Kind::Coulomb),
        effect(Kind::OffsetVoltage),
        effect(Kind::Delay),
    ]
}

fn rms(errors: &[f64]) -> f64 {
    (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt()
}

#[test]
fn a_clean_recording_gives_the_truth_and_no_process_noise() {
    for seed in 1..=4 {
        println!("seed {seed}");
        let mut rng = rng::seeded(seed);
        let mut uniform = || -> f64 { rng::uniform(&mut rng) };
        let motor = Motor::drawn(&mut uniform, 0.0);
        let data = Data::taken(motor.recorded(8.0, &mut uniform)).expect("a recording");
        let found = likely(&data);
        println!("{motor:?}\n{:?}", found.parameters);
        assert!(found.parameters.process_noise < 1e-3, "{found:?}");
        for ((c, found_value), truth) in NUMBERS.into_iter().zip(values(&found)).zip(motor.truth())
        {
            let error = (found_value - truth).abs();
            // The simulator's own step is half a fine step late.
            let own = if c.is_delay() {
                FINE_S
            } else {
                2e-3 * truth.abs()
            };
            let allowed = 4.0 * found.std(c).expect("an error") + own;
            assert!(error < allowed, "{c:?}: {found_value} for {truth}");
        }
    }
}

#[test]
fn intervals_cover_the_truth_under_torque_noise_and_free_runs_err_several_times_more() {
    const SEEDS: u64 = 40;
    let (mut covered, mut likelihood, mut windows) =
        ([0; 5], [const { Vec::new() }; 5], [const { Vec::new() }; 5]);
    let mut noise = Vec::new();
    for seed in 1..=SEEDS {
        let mut rng = rng::seeded(100 + seed);
        let mut uniform = || -> f64 { rng::uniform(&mut rng) };
        let motor = Motor::drawn(&mut uniform, 0.015);
        let data = Data::taken(motor.recorded(8.0, &mut uniform)).expect("a recording");
        let found = likely(&data);
        let by_windows = windowed(&data);
        for (k, truth) in motor.truth().into_iter().enumerate() {
            let interval = found.interval(NUMBERS[k]).expect("an interval");
            covered[k] += usize::from((interval[0]..=interval[1]).contains(&truth));
            likelihood[k].push(values(&found)[k] - truth);
            windows[k].push(by_windows[k] - truth);
        }
        noise.push(libm::log(found.parameters.process_noise / motor.noise));
    }
    println!("seeds 101 to {}: covered {covered:?}", 100 + SEEDS);
    for k in 0..5 {
        let (own, others) = (rms(&likelihood[k]), rms(&windows[k]));
        println!(
            "{:?}: RMS error {own:.3e}, by windows {others:.3e}",
            NUMBERS[k]
        );
    }
    let share = |count: usize| count as f64 / SEEDS as f64;
    for k in 0..5 {
        assert!(
            share(covered[k]) >= 0.85,
            "{:?}: {}",
            NUMBERS[k],
            covered[k]
        );
    }
    for k in [0, 4] {
        assert!(
            3.0 * rms(&likelihood[k]) < rms(&windows[k]),
            "{:?}",
            NUMBERS[k]
        );
    }
}

#[test]
fn bic_prefers_the_terms_that_the_motor_has() {
    let stop = AtomicBool::new(false);
    for seed in 1..=4 {
        println!("seed {}", 200 + seed);
        let mut rng = rng::seeded(200 + seed);
        let mut uniform = || -> f64 { rng::uniform(&mut rng) };
        let motor = Motor {
            offset: 0.0,
            ..Motor::drawn(&mut uniform, 0.02)
        };
        let data = Data::taken(motor.recorded(6.0, &mut uniform)).expect("a recording");
        let observed = Observed::new(&data).expect("a motor that moves");
        let ranked = rank(
            &[&observed],
            &Terms::combinations(),
            &Settings::default(),
            &stop,
        );
        let best = (ranked.iter())
            .filter(|r| r.bic().is_some())
            .min_by(|a, b| a.bic().unwrap_or(0.0).total_cmp(&b.bic().unwrap_or(0.0)))
            .expect("a fit");
        for r in &ranked {
            println!("{:?} {:?}", r.terms, r.bic());
        }
        assert!(best.terms.coulomb && best.terms.delay, "{:?}", best.terms);
        assert_eq!(ranked.len(), 8);
    }
}

#[test]
fn recordings_of_one_motor_share_it_and_keep_their_delays() {
    let seed = 300;
    println!("seed {seed}");
    let mut rng = rng::seeded(seed);
    let mut uniform = || -> f64 { rng::uniform(&mut rng) };
    let motor = Motor::drawn(&mut uniform, 0.02);
    let delays = [1e-3, 4e-3];
    let data = delays.map(|delay| {
        let motor = Motor { delay, ..motor };
        Data::taken(motor.recorded(6.0, &mut uniform)).expect("a recording")
    });
    let observed = data
        .each_ref()
        .map(|data| Observed::new(data).expect("a motor that moves"));
    let all: Vec<&Observed> = observed.iter().collect();
    let stop = AtomicBool::new(false);
    let found = fit(&all, Terms::USUAL, &Settings::default(), &stop).expect("a fit");
    let alone = likely(&data[0]);
    for (k, delay) in delays.into_iter().enumerate() {
        let error = (found.parameters.delays[k] - delay).abs();
        assert!(error < 2e-4, "{:?}", found.parameters);
    }
    let std = |m: &Maximum| m.std(Coordinate::Inertia).expect("an error");
    assert!(std(&found) < std(&alone));
    assert!((found.parameters.inertia - motor.inertia).abs() < 4.0 * std(&found));
}
