//! A motor that has tuned itself follows the set-points that its host sends, under the same guards.

mod drawing;

use drawing::{Drawn, draw, to_its_end, tuning};
use firmware::app::{Memory, Recording};
use firmware::phase::{Fault, Phase};
use firmware::trials::Mischief;
use firmware::trials::host::Host;
use shared::servo::Gains;
use shared::trace::OPEN;
use shared::wire::*;

type Device<'b> = Host<'b, f32, 2000, true>;

/// Tunes the motor and begins to follow within limits; gives the gains.
fn followed<T>(
    seed: u64,
    limits: impl Fn(&Gains, &Drawn) -> Limits,
    body: impl FnOnce(&mut Device<'_>, &Gains, &Drawn) -> T,
) -> Option<T> {
    let drawn = draw(seed);
    let bench = drawn.bench();
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<2000>::new());
    let mut host = Device::new(&bench, &mut memory, &mut recording);
    let job = tuning(&drawn.motor, seed);
    let follow = |limits: Limits| Job {
        kind: Kind::Follow,
        limits,
        ..job
    };
    host.start(follow(job.limits));
    assert_eq!(host.app.phase(), Phase::Idle, "nothing was tuned");
    assert!(host.start(job));
    let gains = to_its_end(&mut host).ok()?.tuned?.gains;
    host.send(&ToDevice::Hello);
    host.period(|_| {});
    let limits = limits(&gains, &drawn);
    assert!(host.start(follow(limits)), "seed {seed}");
    // It rests for a while first.
    for _ in 0..100 {
        host.period(|_| {});
    }
    assert_eq!(host.app.phase(), Phase::Follow, "seed {seed}");
    Some(body(&mut host, &gains, &drawn))
}

fn usual(_: &Gains, drawn: &Drawn) -> Limits {
    let stall_ma = drawn.motor.supply / drawn.motor.resistance * 1e3;
    Limits {
        duty: 32_000,
        // Where none is drawn, too: a loop asks for the whole supply at once.
        current_ma: (drawn.limit.unwrap_or(0.8) * stall_ma) as u32,
        time: 200_000,
        ..Limits::NONE
    }
}

#[test]
fn positions_are_reached_and_speeds_are_kept() {
    let motors = testing::length::cases(300, 40);
    let (mut tuned, mut missed) = (0, Vec::new());
    for seed in 0..motors {
        let answers = followed(seed, usual, |host, gains, drawn| {
            let rev = drawn.motor.counts_per_rev as i32;
            let begun = host.bench.borrow().counts();
            let mut answers = Vec::new();
            for target in [rev / 8, 10 * rev, 0] {
                host.send(&ToDevice::SetPoint(SetPoint::Position(target)));
                // As long as the way takes at most, and to settle.
                let fastest = 0.5 / gains.back_emf;
                let way = 1.5 * 10.0 * rev as f32 / fastest + 6.0 * gains.time_constant;
                for _ in 0..(way + 3.0 * gains.settling()) as usize + 200 {
                    host.period(|_| {});
                }
                let left = host.bench.borrow().counts() - begun - target;
                if left.abs() > 2.max(rev / 200) {
                    answers.push(format!("{left} counts from {target}, {rev} a revolution"));
                }
            }
            let speed = 0.3 / gains.back_emf;
            let set_point = SetPoint::Speed((speed * 65_536.0) as i32);
            host.send(&ToDevice::SetPoint(set_point));
            let settled = (3.0 * gains.settling() + 3.0 * gains.time_constant) as usize + 200;
            for _ in 0..settled {
                host.period(|_| {});
            }
            let from = host.bench.borrow().counts();
            let periods = 200.max((200.0 / speed) as usize);
            for _ in 0..periods {
                host.period(|_| {});
            }
            let went = (host.bench.borrow().counts() - from) as f32 / periods as f32;
            if (went / speed - 1.0).abs() > 0.02 {
                answers.push(format!("{went} counts a period for {speed}"));
            }
            host.send(&ToDevice::SetPoint(SetPoint::End));
            if let Err(failure) = to_its_end(host) {
                answers.push(format!("{failure:?}"));
            }
            assert_eq!(host.bench.borrow().driven, None, "seed {seed}");
            answers
        });
        let Some(answers) = answers else { continue };
        tuned += 1;
        if !answers.is_empty() {
            println!("seed {seed}: {answers:?}");
            missed.push(seed);
        }
    }
    println!(
        "{tuned} of {motors} tuned; {} missed: {missed:?}",
        missed.len()
    );
    assert!(tuned * 10 >= motors * 9, "{tuned} of {motors}");
    assert!(missed.len() as u64 * 20 <= tuned, "{missed:?}");
}

#[test]
fn limits_hold_and_a_silent_host_opens_the_bridge() {
    let seed = 3;
    // A set-point beyond the limits of travel and speed is followed up to them.
    let within = followed(
        seed,
        |gains, drawn| Limits {
            travel: 4 * drawn.motor.counts_per_rev as u32,
            speed: (0.3 / gains.back_emf) as u16,
            ..usual(gains, drawn)
        },
        |host, _, drawn| {
            host.send(&ToDevice::SetPoint(SetPoint::Position(i32::MAX)));
            let begun = host.bench.borrow().counts();
            for _ in 0..20_000 {
                host.period(|message| {
                    assert!(!matches!(message, ToHost::Failed(_)), "{message:?}")
                });
            }
            let went = (host.bench.borrow().counts() - begun) as f32 / drawn.motor.counts_per_rev;
            assert!((3.5..4.0).contains(&went), "{went}");
            host.alive = false;
            let failure = to_its_end(host).expect_err("the host is silent");
            assert_eq!(failure.fault, Fault::LinkLost);
            assert_eq!(host.bench.borrow().driven, None);
            // Nobody heard it: it may not go on when somebody speaks again.
            host.alive = true;
            host.send(&ToDevice::SetPoint(SetPoint::Position(0)));
            for _ in 0..1_000 {
                host.period(|_| {});
                assert!(matches!(host.bench.borrow().driven, None | Some(OPEN)));
            }
        },
    );
    assert!(within.is_some(), "seed {seed} was not tuned");
}

#[test]
fn whatever_goes_wrong_while_it_follows_opens_the_bridge_and_is_named() {
    let all: [(Mischief, &[Fault]); 7] = [
        (Mischief::ShaftLocked, &[Fault::Stall, Fault::Overcurrent]),
        // At speed, an encoder that turns round jumps.
        (
            Mischief::EncoderReversed,
            &[Fault::Runaway, Fault::EncoderJump],
        ),
        (Mischief::EncoderStuck, &[Fault::Stall]),
        (Mischief::EncoderLine, &[Fault::EncoderLine, Fault::Stall]),
        (Mischief::EncoderJump, &[Fault::EncoderJump]),
        (Mischief::SupplySag, &[Fault::Undervoltage]),
        (Mischief::BridgeFault, &[Fault::Bridge]),
    ];
    for seed in [3, 9, 20] {
        for (mischief, faults) in all {
            let told = followed(seed, usual, |host, gains, _| {
                let speed = 0.3 / gains.back_emf * 65_536.0;
                host.send(&ToDevice::SetPoint(SetPoint::Speed(speed as i32)));
                for _ in 0..1_000 {
                    host.period(|_| {});
                }
                mischief.on(&mut host.bench.borrow_mut());
                let failure = to_its_end(host).expect_err("it goes wrong");
                assert_eq!(
                    host.bench.borrow().driven,
                    None,
                    "seed {seed}, {mischief:?}"
                );
                failure.fault
            });
            println!("seed {seed}, {mischief:?}: {told:?}");
            let told = told.unwrap_or_else(|| panic!("seed {seed} was not tuned"));
            assert!(
                faults.contains(&told),
                "seed {seed}, {mischief:?}: {told:?}"
            );
        }
    }
}
