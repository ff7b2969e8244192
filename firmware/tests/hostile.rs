//! Hostile frames and jobs: whatever comes over the link, the device neither panics nor overflows, drives only when it was armed and
//! only within the job's limit, and still answers.

use firmware::app::{Memory, Recording};
use firmware::phase::{Bridge, Phase};
use firmware::plant::{Motor, SMALL};
use firmware::trials::bench::Bench;
use firmware::trials::host::Host;
use shared::fit::{Grade, Method, Settings};
use shared::rng::{self, Generator, Rng};
use shared::trace::OPEN;
use shared::wire::*;
use std::cell::RefCell;

/// A number of any size, often an extreme one.
fn any(rng: &mut Generator) -> u64 {
    let extremes = [
        0,
        1,
        2,
        0x7f,
        0x7fff,
        0xffff,
        0x7fff_ffff,
        0xffff_ffff,
        u64::MAX,
    ];
    match rng::below(rng, 3) {
        0 => extremes[rng::below(rng, 9) as usize],
        1 => u64::from(rng::below(rng, 3000)),
        _ => rng.next_u64() >> rng::below(rng, 64),
    }
}

/// A job of extremes; every other one would be sane without some of them.
fn job(rng: &mut Generator) -> Job {
    let mut job = extreme(rng);
    if rng::below(rng, 2) == 0 {
        job.amplitude = 20_000;
        job.record = job.record.min(64);
        (job.limits.duty, job.limits.time) = (30_000, 5_000);
        if rng::below(rng, 2) == 0 {
            (job.limits.travel, job.limits.speed) = (0, 0);
            (job.excite, job.verify) = (job.excite.min(500), job.verify.min(500));
        }
    }
    job
}

fn extreme(rng: &mut Generator) -> Job {
    let kinds = [Kind::Commission, Kind::Record, Kind::Play];
    Job {
        kind: kinds[rng::below(rng, 3) as usize],
        amplitude: any(rng) as i16,
        excite: any(rng) as u32,
        coast: rng::below(rng, 2) == 0,
        record: any(rng) as u16,
        verify: any(rng) as u32,
        verify_within: any(rng) as u32,
        accept: [Grade::No, Grade::Control, Grade::Floor][rng::below(rng, 3) as usize],
        seed: rng.next_u64(),
        fit: Settings {
            method: if rng::below(rng, 2) == 0 {
                Method::Pso
            } else {
                Method::Firefly
            },
            population: any(rng) as u8,
            evaluations: (any(rng) as u16).min(2_000),
            seed: rng.next_u64(),
            coulomb: rng::below(rng, 2) == 0,
            load: rng::below(rng, 2) == 0,
            carriers: rng::below(rng, 40) as u16,
            supply: rng::below(rng, 2) == 0,
            full: any(rng) as u16,
            dead_time: rng::below(rng, 65_536) as u16,
        },
        limits: Limits {
            duty: any(rng) as i16,
            travel: any(rng) as u32,
            speed: any(rng) as u16,
            current_ma: any(rng) as u32,
            continuous_ma: any(rng) as u32,
            thermal: any(rng) as u32,
            stall_ma: any(rng) as u32,
            time: any(rng) as u32,
        },
        counts_per_rev: any(rng) as u32,
        supply_mv: any(rng) as u32,
    }
}

fn plan_part(rng: &mut Generator, of: PlanDigest) -> PlanPart {
    let length = rng::below(rng, MOST_SEGMENTS as u32 + 1) as usize;
    PlanPart {
        of,
        first: any(rng) as u16,
        segments: (0..length)
            .map(|_| Segment {
                duty: if rng::below(rng, 8) == 0 {
                    OPEN
                } else {
                    any(rng) as i16
                },
                periods: any(rng) as u16,
            })
            .collect(),
    }
}

fn digest(rng: &mut Generator) -> PlanDigest {
    PlanDigest {
        segments: any(rng) as u16,
        check: any(rng) as u32,
    }
}

/// Anything but a start with the right nonce.
fn message(rng: &mut Generator) -> ToDevice {
    match rng::below(rng, 12) {
        0 => ToDevice::Hello,
        1 => ToDevice::Alive,
        2 => ToDevice::Stop,
        3..=5 => {
            let of = digest(rng);
            ToDevice::Plan(plan_part(rng, of))
        }
        6 => ToDevice::Resend {
            first: any(rng) as u32,
        },
        _ => ToDevice::Start {
            nonce: any(rng) as u32,
            job: job(rng),
            plan: digest(rng),
        },
    }
}

/// A frame, whole, spoilt, or none.
fn frame(rng: &mut Generator, message: &ToDevice) -> Vec<u8> {
    let mut buffer = [0; LONGEST_FRAME];
    let mut bytes = encode(message, &mut buffer).unwrap_or_default().to_vec();
    match rng::below(rng, 4) {
        0 if !bytes.is_empty() => {
            let at = rng::below(rng, bytes.len() as u32) as usize;
            bytes[at] ^= 1 << rng::below(rng, 8);
        }
        1 => {
            let length = rng::below(rng, 700) as usize;
            bytes = (0..length).map(|_| rng.next_u32() as u8).collect();
        }
        _ => {}
    }
    bytes
}

/// A device that gets `frames` frames; if it is armed now and then, with hostile jobs. Gives how often it drove.
fn attack(seed: u64, frames: u32, armed: bool) -> u32 {
    let mut rng = rng::seeded(seed);
    let bench = RefCell::new(Bench::new(Motor { ..SMALL }));
    let (mut memory, mut recording) = (Memory::<f32>::new(), Recording::<64>::new());
    let mut host = Host::<f32, 64>::new(&bench, &mut memory, &mut recording);
    host.alive = armed;
    // The largest duty of the job that runs.
    let mut limit = 0;
    let mut drove = 0;
    for _ in 0..frames {
        if armed && host.app.phase() == Phase::Idle && rng::below(&mut rng, 4) == 0 {
            let none = PlanDigest::of(&[]);
            let plan = plan_part(&mut rng, none).segments;
            let of = PlanDigest::of(&plan);
            host.send(&ToDevice::Plan(PlanPart {
                of,
                first: 0,
                segments: plan,
            }));
            let job = job(&mut rng);
            if host.start_with(job, of) {
                limit = i32::from(job.limits.duty);
            }
        }
        let message = message(&mut rng);
        let bytes = frame(&mut rng, &message);
        for byte in bytes {
            let _ = bench.borrow_mut().to_device.push_back(byte);
        }
        host.period(|_| {});
        assert_eq!(host.drove_in, None, "seed {seed}");
        if let Some(duty) = bench.borrow().driven {
            assert!(armed, "seed {seed}: it drives and nobody has armed it");
            assert!(
                i32::from(duty).abs() <= limit,
                "seed {seed}: {duty} beyond {limit} in {:?}",
                host.app.phase()
            );
            assert_eq!(host.app.phase().bridge(), Bridge::Driven, "seed {seed}");
            drove += 1;
        }
    }
    // It still answers.
    host.send(&ToDevice::Stop);
    let mut answered = false;
    for _ in 0..100 {
        host.send(&ToDevice::Hello);
        host.period(|message| answered |= matches!(message, ToHost::About(_)));
    }
    assert!(answered, "seed {seed}");
    drove
}

#[test]
fn no_frame_and_no_job_panics_or_drives_what_it_must_not() {
    let attacks = testing::length::cases(1_000, 30);
    let mut drove = 0;
    for seed in 0..attacks {
        assert_eq!(attack(seed, 5_000, false), 0);
        drove += attack(seed, 5_000, true);
    }
    println!("{} frames, {drove} periods driven", attacks * 10_000);
    assert!(drove > 0);
}
