//! Drawn motors of half a watt to half a kilowatt, with 12 to 65,536 counts a revolution, bare and with a robot's mass, on benches with
//! ordinary faults (dead time, a supply that gives way, cogging, a current sensor that is off, an encoder that glitches): the guard lets
//! them commission, none is harmed, and numbers that are called good are off by no more than is stated.

mod drawing;

use drawing::{Drawn, commissioning, draw, off, ran};
use shared::fit::{Grade, Settings};
use shared::wire::*;

/// What became of it.
#[derive(Debug)]
struct Became {
    outcome: Result<Report, Box<Failure>>,
    /// Largest current, as a part of its limit.
    peak: f32,
}

fn commission<const SENSES: bool>(drawn: &Drawn, seed: u64) -> Became {
    let motor = &drawn.motor;
    let bench = drawn.bench();
    let stall_ma = (motor.supply / motor.resistance * 1000.0) as u32;
    let limit = drawn.limit.unwrap_or(1.0);
    let current_ma = (stall_ma as f32 * limit) as u32;
    let common = commissioning(motor, seed, 4_000);
    let job = Job {
        fit: Settings {
            supply: !SENSES,
            ..common.fit
        },
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
    let outcome = ran::<SENSES>(&bench, job);
    Became {
        peak: bench.borrow().peak_ma as f32 / current_ma.max(1) as f32,
        outcome,
    }
}

#[test]
fn drawn_motors_commission_and_none_is_harmed() {
    let motors = testing::length::cases(400, 60);
    // With and without sensors: of each grade, and those of a good one whose numbers are farther off than stated.
    let (mut grades, mut beyond) = ([[0; 3]; 2], 0);
    let mut stopped = 0;
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
            let Ok(report) = &became.outcome else {
                println!("seed {seed}, senses {senses}: {became:?} {drawn:?}");
                stopped += 1;
                continue;
            };
            let outcome = report.outcome.as_ref().expect("a fit");
            let verdict = report.verdict.expect("a verdict");
            grades[usize::from(senses)][verdict.grade as usize] += 1;
            let stated = [verdict.gain, verdict.time_constant, verdict.acceleration];
            let off = off(outcome, &drawn.motor);
            if verdict.grade > Grade::No
                && off.iter().zip(stated).any(|(off, stated)| *off > stated)
            {
                println!("seed {seed}, senses {senses}: {verdict:?}, off by {off:?}");
                beyond += 1;
            }
        }
    }
    let all = 2 * motors;
    println!(
        "{stopped} of {all} runs were stopped; of {motors} motors each, good for nothing, for gains and for all: {:?} with sensors of \
         current and supply, {:?} without; {beyond} good ones are off by more than stated",
        grades[1], grades[0]
    );
    assert!(stopped * 100 <= all * 2, "{stopped} of {all}");
    for (senses, most) in [(1, 10), (0, 15)] {
        let [no, control, floor] = grades[senses];
        assert!(no * 100 <= motors * most, "{grades:?}");
        assert!(beyond * 50 <= control + floor, "{beyond} of {grades:?}");
    }
}
