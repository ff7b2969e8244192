//! Drawn motors behind bridges that switch, edge by edge: what dead time takes is fitted, so that gain, time constant and friction are right.

mod drawing;

use drawing::{Drawn, commissioning, draw, ran, truth};
use firmware::phase::Fault;
use firmware::plant::{CARRIERS, Motor};
use firmware::trials::bench::Bench;
use shared::fit::Settings;
use shared::wire::*;
use std::cell::RefCell;

/// The motor of a seed, with dead time as its only fault: so many seconds at each edge of a carrier of 20 kHz.
fn with_dead_time(seed: u64, seconds: f32) -> Motor {
    let Drawn { motor, .. } = draw(seed);
    Motor {
        supply_resistance: 0.0,
        cogging: 0.0,
        dead_time: 2.0 * seconds * 1000.0 * CARRIERS as f32,
        ..motor
    }
}

/// Errors of gain, first-order coefficient and Coulomb friction, as parts of them, and the RMS of the verification.
#[derive(Debug)]
struct Found {
    off: [f32; 3],
    verified: f32,
}

/// Commissions a motor whose board takes its dead time for `told` times what it is.
fn commission(motor: &Motor, seed: u64, told: f32) -> Option<Found> {
    let bench = RefCell::new(Bench::new(motor.clone()));
    let common = commissioning(motor, seed, 4_000);
    let job = Job {
        fit: Settings {
            dead_time: (told * motor.dead_time * 32_768.0) as u16,
            ..common.fit
        },
        ..common
    };
    let report = match ran::<false>(&bench, job) {
        Ok(report) => Some(report),
        Err(failure) => {
            assert_eq!(failure.fault, Fault::NotVerified, "{failure:?}");
            failure.report
        }
    };
    let report = report?;
    let estimates: Vec<f32> = report
        .outcome
        .as_ref()?
        .estimates
        .iter()
        .map(|own| own.value)
        .collect();
    let [gain, first_order, _] = truth(motor).map(|[low, _]| low);
    let coulomb = motor.coulomb * motor.resistance / (motor.constant * motor.supply);
    let truth = [gain, first_order, coulomb];
    let off = |k: usize, place: usize| (estimates[place] / truth[k] - 1.0).abs();
    Some(Found {
        off: [off(0, 0), off(1, 1), off(2, 3)],
        verified: report
            .verified
            .map_or(f32::NAN, |own| own.mean_square.sqrt()),
    })
}

fn median(mut values: Vec<f32>) -> f32 {
    values.sort_unstable_by(f32::total_cmp);
    values[values.len() / 2]
}

#[test]
fn dead_time_is_told_from_friction_and_inertia() {
    let motors = testing::length::cases(100, 24);
    // Boards whose timer is told too little, as gates and transistors add their own.
    let told = 0.8;
    for (dead_ns, most) in [
        (0.0f32, [0.05, 0.3, 1.0]),
        (100.0, [0.05, 0.3, 1.0]),
        (500.0, [0.1, 0.3, 2.0]),
        (1000.0, [0.3, 1.0, 4.0]),
    ] {
        let found: Vec<Found> = (0..motors)
            .filter_map(|seed| commission(&with_dead_time(seed, dead_ns * 1e-9), seed, told))
            .collect();
        assert_eq!(found.len() as u64, motors, "all report a fit");
        let near = found.iter().filter(|own| own.verified < 1.0).count();
        let of = |k: usize| 100.0 * median(found.iter().map(|own| own.off[k]).collect());
        let off = [of(0), of(1), of(2)];
        println!(
            "{dead_ns} ns: {near} of {motors} within a count; gain, time constant and friction off by {off:.3?} %"
        );
        for (off, most) in off.into_iter().zip(most) {
            assert!(off < most, "{dead_ns} ns: {off} % of {most} %");
        }
    }
}
