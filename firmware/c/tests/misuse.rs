//! Whatever a firmware does wrong gives a status, and never a panic.

use servoid_c::*;
use shared::rng;
use std::mem::zeroed;
use std::ptr::{null, null_mut};

use rand_core::Rng;

// SAFETY of all calls here: addresses are null or of what they are declared as, arrays have as many elements as is said, and memory begins as
// zeros.

fn room() -> Box<ServoidFit> {
    // SAFETY: it is an array of numbers.
    unsafe { Box::new(zeroed()) }
}

fn verdict() -> ServoidVerdict {
    ServoidVerdict {
        grade: ServoidGrade::No,
        reason: ServoidReason::None,
        gain: 0.0,
        time_constant: 0.0,
        acceleration: 0.0,
        mean_square: 0.0,
    }
}

#[test]
fn null_and_what_comes_too_early_are_told() {
    let (mut fit, settings) = (room(), servoid_usual_settings());
    let fit: *mut ServoidFit = &mut *fit;
    let (mut outcome, mut verdict) = (ServoidOutcome::default(), verdict());
    let samples = [0i16; 8];
    let recording = ServoidRecording {
        duties: samples.as_ptr(),
        steps: samples.as_ptr(),
        periods: 8,
    };
    let hollow = ServoidRecording {
        duties: null(),
        ..recording
    };
    unsafe {
        let mut servo: ServoidServo = zeroed();
        let (null_status, early) = (ServoidStatus::Null, ServoidStatus::TooEarly);
        let nulls = [
            servoid_fit_begin(null_mut(), &recording, &settings),
            servoid_fit_begin(fit, null(), &settings),
            servoid_fit_begin(fit, &hollow, &settings),
            servoid_fit_begin(fit, &recording, null()),
            servoid_fit_work(null_mut(), &recording, 1),
            servoid_fit_outcome(null_mut(), &mut outcome),
            servoid_predict_begin(null_mut(), 1, 1, 1),
            servoid_predict_observe(null_mut(), 1, 1),
            servoid_predict_catch_up(null_mut(), 1),
            servoid_verdict(null_mut(), 0.5, &mut verdict),
            servoid_servo_begin(null_mut(), fit, 0.0, 1.0),
            servoid_servo_begin(&mut servo, null_mut(), 0.0, 1.0),
        ];
        assert_eq!(nulls, [null_status; 12]);
        let nothing = servoid_fit_begin(fit, &recording, &settings);
        assert_eq!(nothing, ServoidStatus::NothingToFit);
        let earlies = [
            servoid_fit_work(fit, &recording, 1),
            servoid_fit_outcome(fit, &mut outcome),
            servoid_predict_begin(fit, 1, 1, 1),
            servoid_predict_observe(fit, 1, 1),
            servoid_predict_catch_up(fit, 1),
            servoid_verdict(fit, 0.5, &mut verdict),
            servoid_servo_begin(&mut servo, fit, 0.0, 1.0),
        ];
        assert_eq!(earlies, [early; 7]);
        assert_eq!(servoid_servo_next(&mut servo, 1, 1), 0.0);
        assert_eq!(servoid_servo_turn(null_mut(), 1, 1.0), 0.0);
        assert_eq!(servoid_servo_settling(&mut servo), 0.0);
        servoid_servo_acts(&mut servo, 1.0);
    }
}

#[test]
fn no_recording_and_no_settings_lead_to_a_panic() {
    let seed = 20_261_130;
    println!("seed {seed}");
    let mut random = rng::seeded(seed);
    let mut ended = 0;
    for turn in 0..300 {
        let periods = [0, 1, 2, 17, 300][turn % 5];
        let coherent = turn % 3 == 0;
        let numbers = |random: &mut rng::Generator| random.next_u32() as i16;
        let duties: Vec<i16> = (0..periods).map(|_| numbers(&mut random)).collect();
        let steps: Vec<i16> = (duties.iter())
            .map(|duty| match coherent {
                true => (duty >> 10).max(-30),
                false => numbers(&mut random),
            })
            .collect();
        let recording = ServoidRecording {
            duties: duties.as_ptr(),
            steps: steps.as_ptr(),
            periods: periods as u32,
        };
        let settings = ServoidSettings {
            seed: random.next_u64(),
            evaluations: (random.next_u32() % 60) as u16,
            carriers: random.next_u32() as u16 * u16::from(turn % 2 == 0),
            dead_time: random.next_u32() as u16,
            full: random.next_u32() as u16,
            population: random.next_u32() as u8,
            swarm: (turn % 4 == 1).into(),
            coulomb: (turn % 8 > 1).into(),
            load: (turn % 16 > 7).into(),
            supply: (turn % 32 > 15).into(),
        };
        let mut fit = room();
        let mut found = verdict();
        unsafe {
            if servoid_fit_begin(&mut *fit, &recording, &settings) != ServoidStatus::Done {
                continue;
            }
            let mut status = ServoidStatus::Running;
            while status == ServoidStatus::Running {
                status = servoid_fit_work(&mut *fit, &recording, 1 + random.next_u32() % 5000);
            }
            let windows = [0, 1, 50, u32::MAX][turn % 4];
            let begun = servoid_predict_begin(&mut *fit, periods as u32, periods as u32, windows);
            assert_eq!(begun == ServoidStatus::Done, status == ServoidStatus::Done);
            for _ in 0..300 {
                servoid_predict_observe(&mut *fit, numbers(&mut random), numbers(&mut random));
                servoid_predict_catch_up(&mut *fit, random.next_u32() % 4);
            }
            while servoid_predict_catch_up(&mut *fit, 100) == ServoidStatus::Running {}
            servoid_verdict(&mut *fit, 0.5, &mut found);
            let mut servo: ServoidServo = zeroed();
            // Nothing is known of most of these motors: that is told, too.
            let off = found.acceleration;
            let refused = servoid_servo_begin(&mut servo, &mut *fit, off, 0.9);
            assert!(off.is_finite() || refused != ServoidStatus::Done);
            if servoid_servo_begin(&mut servo, &mut *fit, 0.1, 0.9) == ServoidStatus::Done {
                for target in [f32::MAX, 0.0, f32::NAN, -f32::INFINITY, 1e3] {
                    let step = random.next_u32() as i32;
                    let duty = servoid_servo_turn(&mut servo, step, target);
                    let other = servoid_servo_next(&mut servo, -step, target as i32);
                    let within = duty.abs() <= 0.9 && other.abs() <= 0.9;
                    assert!(within, "turn {turn}: {duty} {other}");
                }
                ended += 1;
            }
        }
    }
    println!("{ended} servos");
    assert!(ended > 50, "{ended}");
}
