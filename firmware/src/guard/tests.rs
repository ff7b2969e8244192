use super::*;
use shared::fit::{Grade, Settings};
use shared::wire::Kind;

const PERIOD_US: u32 = 1000;
const FREE: Limits = Limits {
    thermal: 1000,
    time: 1_000_000,
    ..Limits::NONE
};

/// Of a motor with 2,000 counts a revolution, which needed 20 periods for its first motion.
fn guard(limits: Limits) -> Guard {
    let job = Job {
        kind: Kind::Commission,
        amplitude: 30_000,
        excite: 0,
        coast: false,
        record: 0,
        verify: 0,
        verify_within: 100,
        accept: Grade::No,
        seed: 0,
        fit: Settings::USUAL,
        limits,
        counts_per_rev: 2_000,
        supply_mv: 24_000,
    };
    let rating = Rating {
        period_us: PERIOD_US,
        full: 32_768,
        current_ma: 0,
        resolution_ma: 1,
    };
    let mut guard = Guard::new(&job, rating, -7);
    for period in 1..20 {
        assert!(!guard.probe_step(8_000, period, None));
    }
    assert!(guard.probe_step(8_000, 100, None));
    guard
}

/// Periods until the guard trips, with the fault; the motion and the current are given by the period.
fn trip(
    limits: Limits,
    duty: impl Fn(u32) -> Option<i16>,
    step: impl Fn(u32) -> i32,
    current_ma: impl Fn(u32) -> Option<i32>,
) -> Option<(u32, Fault)> {
    let mut guard = guard(limits);
    let mut count = -7i32;
    (0..5000).find_map(|k| {
        count = count.wrapping_add(step(k));
        let measured = Measured {
            current_ma: current_ma(k),
            supply_mv: None,
        };
        let looked = guard.look(duty(k), count, measured);
        looked.err().map(|tripped| (k + 1, tripped.fault))
    })
}

#[test]
fn a_motor_that_obeys_trips_nothing() {
    // Accelerates, is reversed and brakes, coasts, creeps under a weak drive.
    let duty = |k: u32| match k / 500 % 4 {
        0 => Some(20_000),
        1 => Some(-20_000),
        2 => None,
        _ => Some(3_000),
    };
    let speed = |k: u32| match k / 500 % 4 {
        0 => 1 + (k % 500) as i32 / 5,
        1 => 100 - (k % 500) as i32 * 2 / 5,
        2 => (500 - (k % 500) as i32) / -5,
        _ => 0,
    };
    assert_eq!(trip(FREE, duty, speed, |_| None), None);
}

#[test]
fn every_limit_trips_just_beyond_it() {
    let steady = |_| Some(20_000);
    let one = |_| 1;
    let none = |_| None;
    let limits = |change: fn(&mut Limits)| {
        let mut limits = FREE;
        change(&mut limits);
        limits
    };
    let travel = limits(|limits| limits.travel = 100);
    assert_eq!(
        trip(travel, steady, one, none),
        Some((101, Fault::Overtravel))
    );
    assert_eq!(
        trip(travel, |_| Some(-20_000), |_| -1, none),
        Some((101, Fault::Overtravel))
    );
    let speed = limits(|limits| limits.speed = 50);
    assert_eq!(
        trip(speed, steady, |k| k as i32, none),
        Some((52, Fault::Overspeed))
    );
    let time = limits(|limits| limits.time = 300);
    assert_eq!(trip(time, steady, one, none), Some((301, Fault::TimeUp)));
    let current = limits(|limits| limits.current_ma = 900);
    assert_eq!(
        trip(current, steady, one, |k| Some(-(10 * k as i32))),
        // An eighth more than it may be.
        Some((103, Fault::Overcurrent))
    );
}

/// Without a sensor the limit bounds the drive; the guard cannot look for more.
#[test]
fn the_drive_is_bounded_by_the_current_it_can_make_also_on_a_reversal() {
    let mut limits = FREE;
    (limits.current_ma, limits.stall_ma, limits.duty) = (900, 2000, 32_000);
    let mut guard = guard(limits);
    let most = 32_768 * 9 / 10 * 900 / 2000;
    let close = |duty: i16, to: i32| (i32::from(duty) - to).abs() <= 2;
    assert!(close(guard.bounded(32_000), most));
    // At its highest speed so far, the back-EMF may be all that was driven.
    let mut count = -7;
    let mut run = |guard: &mut Guard, drive: i16, steps: core::ops::Range<i32>| {
        for step in steps {
            count += step.min(40);
            assert_eq!(guard.look(Some(drive), count, Measured::default()), Ok(()));
        }
    };
    run(&mut guard, 10_000, 0..100);
    assert!(close(guard.bounded(-32_000), 10_000 - most));
    assert!(close(guard.bounded(32_000), most));
    // At half of it, half.
    run(&mut guard, 2_000, 20..21);
    run(&mut guard, 2_000, -20..-19);
    for _ in 0..15 {
        run(&mut guard, 2_000, 20..21);
    }
    let half = guard.bounded(-32_000);
    assert!(
        half < -(most as i16) + 10_000 && half > -(most as i16),
        "{half}"
    );
}

#[test]
fn the_winding_bears_a_peak_for_a_while_and_its_continuous_current_forever() {
    let mut limits = FREE;
    (limits.continuous_ma, limits.thermal) = (1000, 1000);
    let steady = |_| Some(20_000);
    assert_eq!(trip(limits, steady, |_| 1, |_| Some(999)), None);
    // I² of a first-order store reaches the limit after τ·ln(4/3).
    let (periods, fault) = trip(limits, steady, |_| 1, |_| Some(2000)).unwrap();
    assert_eq!(fault, Fault::Overheated);
    assert!((280..=295).contains(&periods), "{periods}");
}

#[test]
fn a_shaft_that_does_not_follow_is_recognised_within_one_and_a_half_windows() {
    let reaction = 90;
    let steady = |_| Some(-20_000);
    let hasty = |k: u32| {
        Some(if (k / 30).is_multiple_of(2) {
            20_000
        } else {
            -20_000
        })
    };
    for (drive, within) in [
        (steady as fn(u32) -> Option<i16>, reaction),
        // A drive that turns round again and again expects less.
        (hasty, 2 * reaction),
    ] {
        let (periods, fault) = trip(FREE, drive, |_| 0, |_| None).unwrap();
        assert_eq!(fault, Fault::Stall);
        assert!(periods <= within, "{periods}");
    }
    // The encoder counts the wrong way: the motor accelerates backwards, or is at speed already.
    for speed in [|k: u32| 1 + k as i32 / 2, |_| 30] {
        let (periods, fault) = trip(FREE, steady, speed, |_| None).unwrap();
        assert_eq!(fault, Fault::Runaway);
        assert!(periods <= reaction, "{periods}");
    }
    // It fails while the motor runs.
    let fails = |k: u32| if k < 1000 { -30 } else { 30 };
    let (periods, fault) = trip(FREE, steady, fails, |_| None).unwrap();
    assert_eq!(fault, Fault::Runaway);
    assert!(periods <= 1000 + reaction, "{periods}");
}

#[test]
fn a_count_that_goes_to_and_fro_or_jumps_is_no_shafts() {
    let steady = |_| Some(20_000);
    // One line is dead: of a period's edges an odd number shows.
    for seed in 0..20 {
        let mut rng = shared::rng::seeded(seed);
        let odd: Vec<bool> = (0..200)
            .map(|_| shared::rng::below(&mut rng, 2) == 1)
            .collect();
        let mut level = 0;
        let steps: Vec<i32> = odd
            .iter()
            .map(|&odd| {
                let before = level;
                level = if odd { 1 - level } else { level };
                level - before
            })
            .collect();
        let (periods, fault) = trip(FREE, steady, |k| steps[k as usize % 200], |_| None).unwrap();
        assert_eq!(fault, Fault::EncoderLine, "seed {seed}");
        assert!(periods <= 90, "seed {seed}: {periods}");
    }
    let jumps = |k: u32| if k == 300 { 60_000 } else { 20 };
    assert_eq!(
        trip(FREE, steady, jumps, |_| None),
        Some((301, Fault::EncoderJump))
    );
}
