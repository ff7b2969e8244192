//! A servo that was tuned outlives a power cut, and follows only where the motor is still that one.

mod drawing;

use drawing::{Drawn, draw, to_its_end, tuning};
use firmware::app::{Memory, Recording};
use firmware::phase::{Fault, Phase};
use firmware::trials::bench::Bench;
use firmware::trials::host::Host;
use shared::wire::*;
use std::cell::RefCell;

type Device<'b> = Host<'b, f32, 2000, true>;

/// Periods of the verification that tries a kept servo.
const TRIED: u32 = 1_000;

/// A device on the bench, just switched on.
fn powered_up<T>(bench: &RefCell<Bench>, body: impl FnOnce(&mut Device<'_>) -> T) -> T {
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<2000>::new());
    let mut host = Device::new(bench, &mut memory, &mut recording);
    host.period(|_| {});
    body(&mut host)
}

/// What the device says of its servo.
fn state(host: &mut Device<'_>) -> ServoState {
    host.send(&ToDevice::Describe);
    let mut state = None;
    for _ in 0..10 {
        host.period(|message| {
            if let ToHost::Details(details) = message {
                assert!(details.keeps_servo);
                state = Some(details.servo);
            }
        });
    }
    state.expect("it answers")
}

/// Tunes the motor; gives its bench, with what is kept.
fn tuned(seed: u64) -> Option<(Drawn, RefCell<Bench>)> {
    let drawn = draw(seed);
    let bench = drawn.bench();
    let kept = powered_up(&bench, |host| {
        assert_eq!(state(host), ServoState::None);
        assert!(host.start(tuning(&drawn.motor, seed)));
        let tuned = to_its_end(host).ok()?.tuned?;
        tuned.measured?;
        assert_eq!(state(host), ServoState::Tried);
        Some(tuned.kept)
    })?;
    assert!(kept, "seed {seed}");
    Some((drawn, bench))
}

fn following(drawn: &Drawn, seed: u64) -> Job {
    let job = tuning(&drawn.motor, seed);
    let stall_ma = drawn.motor.supply / drawn.motor.resistance * 1e3;
    Job {
        kind: Kind::Follow,
        verify: TRIED,
        limits: Limits {
            current_ma: (drawn.limit.unwrap_or(0.8) * stall_ma) as u32,
            time: 200_000,
            ..job.limits
        },
        ..job
    }
}

/// Begins to follow after a power-up; gives the failure, if it comes to one before it follows.
fn begun(host: &mut Device<'_>, job: Job) -> Result<(), Box<Failure>> {
    assert!(host.start(job));
    let mut failure = None;
    while failure.is_none() && host.app.phase() != Phase::Follow {
        host.period(|message| {
            if let ToHost::Failed(failed) = message {
                failure = Some(Box::new(failed));
            }
        });
    }
    failure.map_or(Ok(()), Err)
}

#[test]
fn a_kept_servo_is_tried_and_follows_from_where_the_run_began() {
    let motors = testing::length::cases(200, 40);
    let (mut kept, mut missed) = (0, Vec::new());
    for seed in 0..motors {
        let Some((drawn, bench)) = tuned(seed) else {
            continue;
        };
        kept += 1;
        let job = following(&drawn, seed);
        let rev = drawn.motor.counts_per_rev as i32;
        let followed = powered_up(&bench, |host| {
            assert_eq!(state(host), ServoState::Untried);
            // Nobody follows with a motor that was not looked at.
            assert!(host.start(Job { verify: 0, ..job }));
            assert_eq!(host.app.phase(), Phase::Idle);
            let home = bench.borrow().counts();
            begun(host, job).map_err(|failure| format!("{failure:?}"))?;
            host.send(&ToDevice::SetPoint(SetPoint::Position(rev)));
            for _ in 0..10_000 {
                host.period(|_| {});
            }
            let went = bench.borrow().counts() - home;
            host.send(&ToDevice::SetPoint(SetPoint::End));
            let report = to_its_end(host).map_err(|failure| format!("{failure:?}"))?;
            assert!(report.verified.is_some(), "seed {seed}");
            assert_eq!(state(host), ServoState::Tried);
            // It was seen: no second time.
            host.send(&ToDevice::Hello);
            host.period(|_| {});
            begun(host, Job { verify: 0, ..job }).map_err(|failure| format!("{failure:?}"))?;
            let off = went - rev;
            match off.abs() <= 2.max(rev / 100) {
                true => Ok(()),
                false => Err(format!("{off} counts off, {rev} a revolution")),
            }
        });
        if let Err(why) = followed {
            println!("seed {seed}: {why}");
            missed.push(seed);
        }
    }
    println!(
        "{kept} of {motors} kept, {} missed: {missed:?}",
        missed.len()
    );
    assert!(kept * 10 >= motors * 9, "{kept} of {motors}");
    assert!(missed.len() as u64 * 20 <= kept, "{missed:?}");
}

#[test]
fn another_motor_is_refused_and_the_bridge_is_open() {
    let motors = testing::length::cases(100, 30);
    type Change = fn(&mut firmware::plant::Motor);
    let changes: [(&str, Change); 4] = [
        ("twice the inertia", |motor| motor.inertia *= 2.0),
        ("half the constant", |motor| motor.constant *= 0.5),
        ("half the supply", |motor| motor.supply *= 0.5),
        ("twice the counts", |motor| motor.counts_per_rev *= 2.0),
    ];
    let mut passed = [0; 4];
    let mut tried = 0;
    for seed in 0..motors {
        let Some((drawn, bench)) = tuned(seed) else {
            continue;
        };
        tried += 1;
        for (k, (what, change)) in changes.iter().enumerate() {
            let mut motor = drawn.motor.clone();
            change(&mut motor);
            let mut other = Bench::new(motor);
            other.saved = bench.borrow().saved.clone();
            let other = RefCell::new(other);
            let begun = powered_up(&other, |host| {
                let begun = begun(host, following(&drawn, seed));
                assert!(host.drove_in.is_none());
                begun
            });
            match begun {
                Ok(()) => {
                    println!("seed {seed}: {what} was not seen");
                    passed[k] += 1;
                }
                Err(failure) => {
                    assert_eq!(other.borrow().driven, None, "seed {seed}, {what}");
                    if failure.fault != Fault::OtherMotor {
                        println!("seed {seed}, {what}: {:?}", failure.fault);
                    }
                }
            }
        }
    }
    println!("of {tried} motors passed: {passed:?}");
    assert!(
        passed.iter().all(|passed| passed * 20 <= tried),
        "{passed:?}"
    );
}
