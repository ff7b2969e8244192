//! Drawn motors of half a watt to half a kilowatt, with 12 to 65,536 counts a revolution, bare and with a robot's mass, on benches with
//! ordinary faults (dead time, a supply that gives way, cogging, a current sensor that is off, an encoder that glitches): the guard lets
//! them commission, none is harmed, and none is called a success beyond its limit.

mod drawing;

use drawing::{Drawn, commissioning, draw, ran};
use firmware::app::{Memory, Recording};
use firmware::phase::Fault;
use firmware::plant::Motor;
use firmware::trials::{bench::Bench, host::Host};
use shared::wire::*;
use std::cell::RefCell;

/// Limit of the verification, counts: one, or a 4,096th of a revolution.
fn limit_counts(motor: &Motor) -> f32 {
    (motor.counts_per_rev / 4096.0).max(1.0)
}

/// What became of it.
#[derive(Debug)]
struct Became {
    outcome: Result<Report, Box<Failure>>,
    /// Largest current, as a part of its limit.
    peak: f32,
    /// RMS of the verification in counts.
    verified: f32,
}

fn commission<const SENSES: bool>(drawn: &Drawn, seed: u64) -> Became {
    let motor = &drawn.motor;
    let mut bench = Bench::new(motor.clone());
    (bench.offset_ma, bench.glitches) = (drawn.offset_ma, drawn.glitches);
    let bench = RefCell::new(bench);
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<2000>::new());
    let mut host = Host::<f32, 2000, SENSES>::new(&bench, &mut memory, &mut recording);
    let stall_ma = (motor.supply / motor.resistance * 1000.0) as u32;
    let limit = drawn.limit.unwrap_or(1.0);
    let current_ma = (stall_ma as f32 * limit) as u32;
    let common = commissioning(motor, seed, 800);
    let job = Job {
        verify_within: (limit_counts(motor) * 100.0) as u32,
        limits: Limits {
            current_ma: if drawn.limit.is_some() { current_ma } else { 0 },
            // Without a sensor the user has to say what the resistance is.
            stall_ma: if SENSES || drawn.limit.is_none() {
                0
            } else {
                stall_ma
            },
            ..common.limits
        },
        ..common
    };
    let outcome = ran(&mut host, job);
    let report = match &outcome {
        Ok(report) => Some(report),
        Err(failure) => failure.report.as_ref(),
    };
    let verified = report.and_then(|report| report.verified);
    Became {
        peak: bench.borrow().peak_ma as f32 / current_ma.max(1) as f32,
        verified: verified.map_or(f32::NAN, |verified| verified.mean_square.sqrt()),
        outcome,
    }
}

#[test]
fn drawn_motors_commission_and_none_is_harmed() {
    let motors = testing::length::cases(400, 60);
    let (mut stopped, mut verified) = (0, [0, 0]);
    for seed in 0..motors {
        let drawn = draw(seed);
        for senses in [true, false] {
            let became = if senses {
                commission::<true>(&drawn, seed)
            } else {
                commission::<false>(&drawn, seed)
            };
            if drawn.limit.is_some() {
                assert!(became.peak <= 1.2, "seed {seed}: {became:?} {drawn:?}");
            }
            match &became.outcome {
                Ok(_) => {
                    let limit = limit_counts(&drawn.motor) + 0.01;
                    assert!(
                        became.verified <= limit,
                        "seed {seed}: {became:?} {drawn:?}"
                    );
                    verified[usize::from(senses)] += 1;
                }
                Err(failure) if failure.fault == Fault::NotVerified => {}
                Err(failure) => {
                    println!("seed {seed}, senses {senses}: {failure:?} {drawn:?}");
                    stopped += 1;
                }
            }
        }
    }
    let all = 2 * motors;
    println!(
        "{stopped} of {all} runs were stopped; of {motors} motors each, verified within their limit: {} with sensors of current \
         and supply, {} without; all others say that they are not",
        verified[1], verified[0]
    );
    assert!(stopped * 100 <= all * 2, "{stopped} of {all}");
}
