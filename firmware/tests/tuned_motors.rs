//! Drawn motors make servos of themselves: a step is answered as it is simulated with the fitted motor, within the limits.

mod drawing;

use drawing::{draw, ran, tuning};
use shared::wire::*;

#[test]
fn a_step_is_answered_as_it_was_predicted() {
    let motors = testing::length::cases(400, 60);
    let (mut tuned, mut alike) = (0u64, 0u64);
    for seed in 0..motors {
        let drawn = draw(seed);
        let report = match ran::<true>(&drawn.bench(), tuning(&drawn.motor, seed)) {
            Ok(report) => report,
            Err(failure) => {
                println!("seed {seed}: {failure:?} {drawn:?}");
                continue;
            }
        };
        let grade = report.verdict.map(|verdict| verdict.grade);
        let Some(Tuned {
            gains,
            step,
            predicted,
            measured,
            ..
        }) = report.tuned
        else {
            println!("seed {seed}: {grade:?} no step");
            continue;
        };
        tuned += 1;
        let measured = measured.expect("the step was driven");
        let settles = (measured.settling as f32 / predicted.settling as f32 - 1.0).abs() < 0.15;
        let shoots = (measured.overshoot - predicted.overshoot).abs() < 0.15;
        if settles && shoots && measured.overshoot < 0.5 {
            alike += 1;
            continue;
        }
        println!(
            "seed {seed}, {} counts, {grade:?}, a step of {step} by {gains:?}: predicted {predicted:?}, measured {measured:?}",
            drawn.motor.counts_per_rev
        );
    }
    println!("{tuned} of {motors} tuned; {alike} answered as predicted");
    assert!(tuned * 10 >= motors * 9, "{tuned} of {motors}");
    assert!(alike * 20 >= tuned * 19, "{alike} of {tuned}");
}
