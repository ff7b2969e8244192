//! Drawn motors make servos of themselves: a step is answered as the fitted motor foresees it, within the limits.

mod drawing;

use drawing::{Drawn, commissioning, draw, ran};
use firmware::app::{Memory, Recording};
use firmware::trials::{bench::Bench, host::Host};
use shared::fit::Settings;
use shared::wire::*;
use std::cell::RefCell;

fn tune(drawn: &Drawn, seed: u64) -> Result<Report, Box<Failure>> {
    let motor = &drawn.motor;
    let mut bench = Bench::new(motor.clone());
    (bench.offset_ma, bench.glitches) = (drawn.offset_ma, drawn.glitches);
    let bench = RefCell::new(bench);
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<2000>::new());
    let mut host = Host::<f32, 2000, true>::new(&bench, &mut memory, &mut recording);
    let common = commissioning(motor, seed, 4_000);
    let job = Job {
        kind: Kind::Tune,
        fit: Settings {
            supply: false,
            ..common.fit
        },
        ..common
    };
    ran(&mut host, job)
}

#[test]
fn a_step_is_answered_as_it_was_foreseen() {
    let motors = testing::length::cases(400, 60);
    let (mut tuned, mut alike) = (0, 0);
    for seed in 0..motors {
        let drawn = draw(seed);
        let report = match tune(&drawn, seed) {
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
            foreseen,
            seen,
        }) = report.tuned
        else {
            println!("seed {seed}: {grade:?} no step");
            continue;
        };
        tuned += 1;
        let seen = seen.expect("the step was driven");
        let settles = (seen.settling as f32 / foreseen.settling as f32 - 1.0).abs() < 0.15;
        let shoots = (seen.overshoot - foreseen.overshoot).abs() < 0.15;
        let good = settles && shoots && seen.overshoot < 0.5;
        alike += u32::from(good);
        println!(
            "seed {seed} {} counts {grade:?} step {step} wx {:.4} foreseen {foreseen:?} seen {seen:?} {}",
            drawn.motor.counts_per_rev,
            gains.position,
            if good { "" } else { "OTHER" }
        );
    }
    println!("{tuned} of {motors} tuned; {alike} answered as foreseen");
    assert!(alike * 20 >= tuned * 19, "{alike} of {tuned}");
}
