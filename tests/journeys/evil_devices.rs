//! Devices that are broken or are none of ours: the host ends, says what is wrong, and keeps what came before.

use host::device::{Conversation, DeviceError, Expected, Run, follow};
use shared::fit::{Estimate, Outcome, Settings, Stop};
use shared::wire::{
    About, Deframer, Failure, Fault, Format, Job, Kind, LONGEST_FRAME, Limits, Refusal, Report,
    Row, Rows, Stage, ToDevice, ToHost, VERSION, encode,
};
use std::collections::VecDeque;
use std::io::{ErrorKind, Read, Result as Io, Write};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

const NONCE: u32 = 77;
const EXCITE: u32 = 400;
const RECORD: u16 = 100;

/// What the device does after it was started: the messages of its `k`-th turn; nothing to hang up.
type Script = fn(k: u32, asked: &[ToDevice]) -> Option<Vec<ToHost>>;

struct Evil {
    script: Script,
    started: bool,
    turn: u32,
    inbox: Deframer,
    asked: Arc<Mutex<Vec<ToDevice>>>,
    bytes: VecDeque<u8>,
    clock: Arc<AtomicU64>,
}

fn frame(message: &ToHost) -> Vec<u8> {
    let mut buffer = [0; LONGEST_FRAME];
    encode(message, &mut buffer).unwrap().to_vec()
}

fn about() -> About {
    About {
        version: VERSION,
        board: "evil".try_into().unwrap(),
        firmware: "0".try_into().unwrap(),
        period_us: 1000,
        capacity: 2000,
        format: Format::F32,
        senses_current: false,
        boot: 1,
        stage: Stage::Idle,
        full: 32_768,
    }
}

impl Read for Evil {
    fn read(&mut self, buffer: &mut [u8]) -> Io<usize> {
        self.clock.fetch_add(5, Ordering::Relaxed);
        if self.started && self.bytes.is_empty() {
            let asked = self.asked.lock().unwrap().clone();
            let Some(said) = (self.script)(self.turn, &asked) else {
                return Ok(0);
            };
            self.turn += 1;
            self.bytes.extend(said.iter().flat_map(frame));
        }
        let taken = buffer.len().min(self.bytes.len());
        if taken == 0 {
            return Err(ErrorKind::TimedOut.into());
        }
        for (slot, byte) in buffer.iter_mut().zip(self.bytes.drain(..taken)) {
            *slot = byte;
        }
        Ok(taken)
    }
}

impl Write for Evil {
    fn write(&mut self, bytes: &[u8]) -> Io<usize> {
        for &byte in bytes {
            let Some(message) = self.inbox.push::<ToDevice>(byte) else {
                continue;
            };
            let answer = match &message {
                ToDevice::Hello => Some(ToHost::About(about())),
                ToDevice::Arm => Some(ToHost::Armed {
                    nonce: NONCE,
                    periods: 5000,
                }),
                ToDevice::Start { nonce, .. } => Some(ToHost::Started { run: *nonce }),
                _ => None,
            };
            self.started |= matches!(message, ToDevice::Start { .. });
            self.bytes.extend(answer.iter().flat_map(frame));
            if message != ToDevice::Alive {
                self.asked.lock().unwrap().push(message);
            }
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Io<()> {
        Ok(())
    }
}

fn job() -> Job {
    Job {
        kind: Kind::Commission,
        amplitude: 20_000,
        excite: EXCITE,
        coast: false,
        record: RECORD,
        verify: 0,
        verify_within: 100,
        accept: shared::fit::Grade::No,
        seed: 0,
        fit: Settings {
            evaluations: 10,
            ..Settings::USUAL
        },
        limits: Limits {
            duty: 32_000,
            time: 30_000,
            ..Limits::NONE
        },
        counts_per_rev: 2_000,
        supply_mv: 24_000,
    }
}

fn rows(stage: Stage, first: u32, number: u32) -> ToHost {
    let row = Row {
        duty: 100,
        step: 1,
        current_ma: 0,
        supply_mv: 0,
    };
    ToHost::Rows(Rows {
        run: NONCE,
        stage,
        first,
        count: first as i32,
        rows: (0..number).map(|_| row).collect(),
    })
}

fn report(periods: u32) -> Report {
    let estimate = Estimate {
        value: 1.0,
        std: 0.1,
    };
    Report {
        run: NONCE,
        breakaway: 100,
        amplitude: 20_000,
        periods,
        limited: 0,
        outcome: Some(Outcome {
            estimates: [estimate; 2].into_iter().collect(),
            mean_square: 0.1,
            evaluations: 100,
            stop: Stop::Converged,
        }),
        verified: Some(shared::fit::Predicted {
            mean_square: 0.1,
            periods: 10,
            by_persistence: 0.1,
            gain: 0.0,
            time_constant: 0.0,
        }),
        verdict: None,
        tuned: None,
    }
}

/// Whole rows of both stages, in its first turns; then what `after` says.
fn good(k: u32, after: impl FnOnce(u32) -> Option<Vec<ToHost>>) -> Option<Vec<ToHost>> {
    match k {
        0..50 => Some(vec![rows(Stage::Excite, 8 * k, 8)]),
        50..60 => Some(vec![rows(Stage::Record, 10 * (k - 50), 10)]),
        k => after(k - 60),
    }
}

/// Starts a run on a device and follows it: what came of it, the periods that arrived, and the last that the host has said.
fn run(script: Script) -> (Result<Run, DeviceError>, usize, Option<ToDevice>) {
    let clock = Arc::new(AtomicU64::new(0));
    let asked = Arc::new(Mutex::new(Vec::new()));
    let evil = Evil {
        script,
        started: false,
        turn: 0,
        inbox: Deframer::new(),
        asked: Arc::clone(&asked),
        bytes: VecDeque::new(),
        clock: Arc::clone(&clock),
    };
    let origin = Instant::now();
    let time = move || origin + Duration::from_millis(clock.load(Ordering::Relaxed));
    let mut host = Conversation::over(Box::new(evil), "evil".to_owned()).with_clock(Box::new(time));
    let about = host.about().unwrap();
    host.start(job(), &[]).unwrap();
    let expected = Expected::of(&job(), &[], &about);
    let mut recorded = Vec::new();
    let never = AtomicBool::new(false);
    let run = follow(
        &mut host,
        &about,
        &expected,
        &[],
        &never,
        &mut recorded,
        |_| Ok(()),
    );
    let arrived = recorded
        .iter()
        .map(|part| part.rows.iter().flatten().count());
    let last = asked.lock().unwrap().last().cloned();
    (run, arrived.sum(), last)
}

#[test]
fn a_device_that_makes_no_sense_ends_with_the_reason_and_what_came_is_kept() {
    let cases: [(&str, Script, &str); 13] = [
        (
            "falls silent",
            |k, _| good(k, |_| Some(vec![])),
            "no answer",
        ),
        ("hangs up", |k, _| good(k, |_| None), "the link broke"),
        (
            "repeats how far its fit is",
            |k, _| {
                good(k, |_| {
                    Some(vec![ToHost::Fitting {
                        done: 7,
                        of: 100,
                        least: 1.0,
                    }])
                })
            },
            "nothing new",
        ),
        (
            "repeats its rows",
            |k, _| good(k, |_| Some(vec![rows(Stage::Excite, 0, 8)])),
            "nothing new",
        ),
        (
            "fits for ever",
            |k, _| {
                good(k, |k| {
                    Some(vec![ToHost::Fitting {
                        done: k + 1,
                        of: u32::MAX,
                        least: 1.0,
                    }])
                })
            },
            "which cannot be",
        ),
        (
            "goes round its stages for ever",
            |k, _| {
                good(k, |k| {
                    let stage = [Stage::Record, Stage::Fit, Stage::Verify][k as usize % 3];
                    Some(vec![ToHost::Stage {
                        stage,
                        at: 0,
                        length: 10,
                        run: NONCE,
                    }])
                })
            },
            "nothing new",
        ),
        (
            "sends rows beyond its stage",
            |k, _| good(k, |_| Some(vec![rows(Stage::Excite, EXCITE, 8)])),
            "which cannot be",
        ),
        (
            "sends rows far beyond its stage",
            |k, _| good(k, |_| Some(vec![rows(Stage::Record, 49_999_999, 8)])),
            "which cannot be",
        ),
        (
            "sends rows of a stage without any",
            |k, _| good(k, |_| Some(vec![rows(Stage::Verify, 0, 8)])),
            "which cannot be",
        ),
        (
            "reports what is no number",
            |k, _| {
                good(k, |_| {
                    let mut report = report(500);
                    report.verified.as_mut().unwrap().mean_square = f32::NAN;
                    Some(vec![ToHost::Report(report)])
                })
            },
            "NaN for the error of the verification",
        ),
        (
            "reports an infinite parameter",
            |k, _| {
                good(k, |_| {
                    let mut report = report(500);
                    report.outcome.as_mut().unwrap().estimates[1].value = f32::INFINITY;
                    Some(vec![ToHost::Report(report)])
                })
            },
            "inf for a parameter",
        ),
        (
            "fails with a fit that is none",
            |k, _| {
                good(k, |_| {
                    let mut report = report(500);
                    report.outcome.as_mut().unwrap().mean_square = -1.0;
                    Some(vec![ToHost::Failed(Failure {
                        run: NONCE,
                        fault: Fault::NotVerified,
                        stage: Stage::Verify,
                        at: 0,
                        seen: 0,
                        limit: 0,
                        report: Some(report),
                    })])
                })
            },
            "-1 for the error of the fit",
        ),
        (
            "starts anew",
            |k, _| {
                good(k, |_| {
                    Some(vec![ToHost::About(About { boot: 2, ..about() })])
                })
            },
            "restarted",
        ),
    ];
    for (what, script, expected) in cases {
        let (run, arrived, last) = run(script);
        let error = run.expect_err(what).to_string();
        assert!(error.contains(expected), "a device that {what}: {error}");
        assert_eq!(arrived, 500, "a device that {what}");
        assert_eq!(last, Some(ToDevice::Stop), "a device that {what}");
    }
}

#[test]
fn what_is_late_or_refused_by_the_way_ends_no_run() {
    let (run, _, _) = run(|k, _| {
        good(k, |k| match k {
            // Of the run before, on its way for long.
            0 => {
                let mut report = report(1);
                report.run = NONCE + 1;
                Some(vec![
                    ToHost::Refused(Refusal::Busy),
                    ToHost::NotStarted {
                        run: NONCE + 1,
                        why: Refusal::NotArmed,
                    },
                    ToHost::Report(report),
                ])
            }
            1 => Some(vec![ToHost::Report(report(500))]),
            _ => None,
        })
    });
    assert_eq!(run.unwrap().outcome.unwrap().periods, 500);
}

#[test]
fn rows_that_are_lost_at_an_end_are_missed_and_a_link_lost_after_the_report_costs_no_more() {
    let (run, _, _) = run(|k, asked| match k {
        // The last rows of both stages never come.
        49 | 59 => Some(vec![]),
        k => good(k, |_| {
            let told = asked
                .iter()
                .any(|said| matches!(said, ToDevice::Resend { .. }));
            (!told).then(|| vec![ToHost::Report(report(500))])
        }),
    });
    let run = run.unwrap();
    assert!(run.outcome.is_ok());
    let missing: Vec<_> = run
        .recorded
        .iter()
        .map(|part| (part.stage, part.rows.len(), part.missing()))
        .collect();
    assert_eq!(missing, [(Stage::Excite, 400, 8), (Stage::Record, 100, 10)]);
}

#[test]
fn a_device_that_cannot_be_is_refused_before_it_is_armed() {
    let wrong: [fn(&mut About); 5] = [
        |about| about.full = 0,
        |about| about.full = 65_535,
        |about| about.capacity = 0,
        |about| about.period_us = 0,
        |about| about.period_us = u32::MAX,
    ];
    for wrong in wrong {
        let mut about = about();
        wrong(&mut about);
        let bytes = frame(&ToHost::About(about.clone()));
        let link = Replay(bytes.into());
        let error = Conversation::over(Box::new(link), "evil".to_owned())
            .about()
            .unwrap_err();
        assert!(matches!(error, DeviceError::Nonsense { .. }), "{about:?}");
    }
}

struct Replay(VecDeque<u8>);

impl Read for Replay {
    fn read(&mut self, buffer: &mut [u8]) -> Io<usize> {
        let byte = self.0.pop_front().ok_or(ErrorKind::TimedOut)?;
        buffer[0] = byte;
        Ok(1)
    }
}

impl Write for Replay {
    fn write(&mut self, bytes: &[u8]) -> Io<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Io<()> {
        Ok(())
    }
}
