//! The link: bytes that must not change, and bytes that must do no harm.

use proptest::prelude::*;
use shared::fit::{Estimate, Grade, Method, Outcome, Predicted, Reason, Settings, Stop, Verdict};
use shared::rng::{self, Rng};
use shared::servo::{Gains, Response};
use shared::wire::*;

fn job() -> Job {
    Job {
        kind: Kind::Commission,
        amplitude: 30_000,
        excite: 20_000,
        coast: true,
        record: 2_000,
        verify: 4_000,
        verify_within: 50,
        accept: Grade::Control,
        seed: 0x0123_4567_89ab_cdef,
        fit: Settings {
            method: Method::Firefly,
            population: 20,
            evaluations: 4_000,
            seed: 7,
            coulomb: true,
            load: false,
            carriers: 20,
            dead_time: 655,
            supply: true,
            full: 16_800,
        },
        limits: Limits {
            duty: 32_767,
            travel: 100_000,
            speed: 500,
            current_ma: 5_000,
            continuous_ma: 1_000,
            thermal: 60_000,
            stall_ma: 10_000,
            time: 60_000,
        },
        counts_per_rev: 4_096,
        supply_mv: 24_000,
    }
}

fn report() -> Report {
    let estimate = Estimate {
        value: 446.5,
        std: 0.25,
    };
    Report {
        run: 0xdead_beef,
        breakaway: 800,
        amplitude: 30_000,
        periods: 26_100,
        limited: 12,
        outcome: Some(Outcome {
            estimates: [estimate; 4].into_iter().collect(),
            mean_square: 0.0833,
            evaluations: 4_096,
            stop: Stop::Converged,
        }),
        verified: Some(Predicted {
            mean_square: 0.09,
            periods: 4_000,
            by_persistence: 0.03,
            gain: 0.001,
            time_constant: -0.002,
        }),
        verdict: Some(Verdict {
            grade: Grade::Control,
            reason: Reason::Left,
            gain: 0.011,
            time_constant: 0.025,
            acceleration: 0.024,
        }),
        tuned: Some(Tuned {
            gains: Gains {
                position: 0.02,
                speed: 0.2,
                back_emf: 0.002,
                friction: 0.02,
                decay: 0.98,
                time_constant: 50.0,
                observer: [0.4, 0.05, 0.004],
            },
            step: -120,
            predicted: Response {
                overshoot: 0.01,
                settling: 140,
                left: -0.5,
            },
            measured: Some(Response {
                overshoot: 0.02,
                settling: 150,
                left: 0.5,
            }),
            kept: true,
        }),
    }
}

fn digest() -> PlanDigest {
    PlanDigest {
        segments: 40,
        check: 0x1234_5678,
    }
}

fn to_device() -> Vec<ToDevice> {
    let segment = Segment {
        duty: -300,
        periods: 500,
    };
    vec![
        ToDevice::Hello,
        ToDevice::Alive,
        ToDevice::Arm,
        ToDevice::Start {
            nonce: 0xdead_beef,
            job: job(),
            plan: digest(),
        },
        ToDevice::Stop,
        ToDevice::Plan(PlanPart {
            of: digest(),
            first: 16,
            segments: [segment; 2].into_iter().collect(),
        }),
        ToDevice::Resend { first: 48 },
        ToDevice::Describe,
        ToDevice::SetPoint(SetPoint::Position(-1_000_000)),
    ]
}

fn to_host() -> Vec<ToHost> {
    let row = Row {
        duty: -32_767,
        step: -800,
        current_ma: -30_000,
        supply_mv: 65_000,
    };
    vec![
        ToHost::About(About {
            version: VERSION,
            board: "QEMU netduinoplus2".try_into().unwrap(),
            firmware: "0.1.0".try_into().unwrap(),
            period_us: 1_000,
            capacity: 2_000,
            format: Format::F32,
            senses_current: true,
            boot: 0x1234_5678,
            stage: Stage::Idle,
            full: 16_800,
        }),
        ToHost::Armed {
            nonce: 0xdead_beef,
            periods: 5_000,
        },
        ToHost::Refused(Refusal::NotArmed),
        ToHost::Stage {
            stage: Stage::Record,
            at: 21_000,
            length: 2_000,
            run: 0xdead_beef,
        },
        ToHost::Rows(Rows {
            run: 0xdead_beef,
            stage: Stage::Excite,
            first: 4_800,
            count: -1_000_000,
            rows: [row; MOST_ROWS].into_iter().collect(),
        }),
        ToHost::Fitting {
            done: 100,
            of: 4_050,
            least: 12.5,
        },
        ToHost::Report(report()),
        ToHost::Failed(Failure {
            run: 0xdead_beef,
            fault: Fault::Overcurrent,
            stage: Stage::Verify,
            at: 23_456,
            seen: 5_100,
            limit: 5_000,
            report: Some(report()),
        }),
        ToHost::Planned {
            of: digest(),
            held: 18,
        },
        ToHost::Started { run: 0xdead_beef },
        ToHost::NotStarted {
            run: 0xdead_beef,
            why: Refusal::BadPlan,
        },
        ToHost::Details(Details {
            reset: Reset::Watchdog,
            current_limit_ma: 40_000,
            senses_supply: true,
            carriers: 20,
            dead_time: 273,
            encoder_latency_us: 255,
            servo: ServoState::Untried,
            keeps_servo: true,
        }),
    ]
}

fn frame<T: serde::Serialize>(message: &T) -> Vec<u8> {
    let mut buffer = [0; LONGEST_FRAME];
    encode(message, &mut buffer).expect("it fits").to_vec()
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A change here is a change of the protocol: append messages, or raise [`VERSION`] and say so in the changelog.
#[test]
fn the_bytes_of_every_message_are_pinned() {
    let pinned = include_str!("wire_bytes.txt");
    let device = to_device()
        .into_iter()
        .map(|message| (format!("{message:?}"), frame(&message)));
    let host = to_host()
        .into_iter()
        .map(|message| (format!("{message:?}"), frame(&message)));
    let name = |debug: String| debug.split([' ', '(']).next().unwrap().to_owned();
    let now: String = device
        .chain(host)
        .map(|(debug, bytes)| format!("{} {}\n", name(debug), hex(&bytes)))
        .collect();
    assert!(now == pinned, "the wire has changed:\n{now}");
}

#[test]
fn every_message_comes_back_whole_also_through_one_deframer_in_a_row() {
    let mut inbox = Deframer::new();
    let bytes: Vec<u8> = to_host().iter().flat_map(frame).collect();
    let heard: Vec<ToHost> = bytes.iter().filter_map(|&byte| inbox.push(byte)).collect();
    assert_eq!(heard, to_host());
    let bytes: Vec<u8> = to_device().iter().flat_map(frame).collect();
    let heard: Vec<ToDevice> = bytes.iter().filter_map(|&byte| inbox.push(byte)).collect();
    assert_eq!(heard, to_device());
    assert_eq!(inbox.dropped(), 0);
}

/// Frames of either side, changed at random: bits flipped, bytes lost, doubled, swapped; or nothing but noise.
#[test]
fn a_hundred_thousand_damaged_frames_are_dropped_and_the_next_whole_one_is_heard() {
    const FRAMES: usize = 100_000;
    let seed = 20_261_121;
    let mut rng = rng::seeded(seed);
    let whole: Vec<Vec<u8>> = to_device()
        .iter()
        .map(frame)
        .chain(to_host().iter().map(frame))
        .collect();
    let (mut device, mut host) = (Deframer::new(), Deframer::new());
    let mut accepted = 0;
    for round in 0..FRAMES {
        let mut bytes = whole[rng::below(&mut rng, whole.len() as u32) as usize].clone();
        let undamaged = bytes.clone();
        for _ in 0..=rng::below(&mut rng, 4) {
            let at = rng::below(&mut rng, bytes.len().max(1) as u32) as usize;
            match rng::below(&mut rng, 5) {
                0 => bytes[at] ^= 1 << rng::below(&mut rng, 8),
                1 => drop(bytes.remove(at)),
                2 => bytes.insert(at, rng.next_u32() as u8),
                3 => bytes.truncate(at.max(1)),
                _ => {
                    bytes = (0..rng::below(&mut rng, 700) + 1)
                        .map(|_| rng.next_u32() as u8)
                        .collect()
                }
            }
            if bytes.is_empty() {
                break;
            }
        }
        if bytes == undamaged {
            continue;
        }
        // What the damage leaves open, the next frame's neighbour closes.
        bytes.push(0);
        for byte in bytes {
            accepted += usize::from(device.push::<ToDevice>(byte).is_some());
            accepted += usize::from(host.push::<ToHost>(byte).is_some());
        }
        let ask = frame(&ToDevice::Hello);
        let heard: Vec<ToDevice> = ask.iter().filter_map(|&byte| device.push(byte)).collect();
        assert_eq!(heard, [ToDevice::Hello], "seed {seed}, round {round}");
        for byte in ask {
            host.push::<ToHost>(byte);
        }
    }
    // An inserted byte at a frame's end leaves the frame before it whole: that one is rightly heard.
    assert!(
        accepted < FRAMES / 50,
        "{accepted} of {FRAMES} damaged frames passed"
    );
}

proptest! {
    #[test]
    fn no_bytes_panic(bytes in proptest::collection::vec(any::<u8>(), 0..2000)) {
        let (mut device, mut host) = (Deframer::new(), Deframer::new());
        for byte in bytes {
            let _ = device.push::<ToDevice>(byte);
            let _ = host.push::<ToHost>(byte);
        }
    }
}

proptest! {
    /// Parts of two plans that are lost, come twice and in any order leave what is asked for whole, or nothing of it.
    #[test]
    fn a_plan_is_put_together_whole_or_not_at_all(
        plans in prop::array::uniform2(prop::collection::vec((any::<i16>(), any::<u16>()), 1..100)),
        order in prop::collection::vec((0..2_usize, 0..7_usize), 0..60),
    ) {
        let plans = plans.map(|plan| plan.into_iter().map(|(duty, periods)| Segment { duty, periods }).collect::<Vec<_>>());
        let mut store = PlanStore::<100>::new();
        for (which, part) in order {
            let plan = &plans[which];
            let first = part * MOST_SEGMENTS;
            let Some(rest) = plan.get(first..) else { continue };
            let part = PlanPart {
                of: PlanDigest::of(plan),
                first: first as u16,
                segments: rest.iter().copied().take(MOST_SEGMENTS).collect(),
            };
            let held = usize::from(store.take(&part).unwrap());
            prop_assert_eq!(store.segments(), &plan[..held]);
            for plan in &plans {
                let whole = store.whole(PlanDigest::of(plan));
                prop_assert!(whole.is_none() || whole == Some(plan.as_slice()));
                prop_assert_eq!(whole.is_some(), store.segments() == plan.as_slice());
            }
        }
    }
}
