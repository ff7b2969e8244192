//! Whole runs of the application on the PC: against a motor that obeys, and against everything that can go wrong.

use firmware::app::{App, Log};
use firmware::board::Board;
use firmware::phase::{Fault, Phase};
use firmware::plant::{Motor, SMALL};
use shared::fit::Settings;
use shared::scalar::Fixed;
use shared::wire::*;
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

const PERIOD_S: f32 = 1e-3;

/// What the host and the mischief see of the bench.
#[derive(Default)]
struct Bench {
    to_device: VecDeque<u8>,
    to_host: VecDeque<u8>,
    driven: Option<i16>,
    period: u32,
    /// Sign of the encoder, or 0 for a dead one.
    encoder: i32,
    locked: bool,
    current_ma: Option<i32>,
    fails: Option<Fault>,
}

struct Rig {
    motor: Motor,
    count: i32,
    shared: Rc<RefCell<Bench>>,
}

impl Board for Rig {
    const NAME: &'static str = "PC";
    const PERIOD_US: u32 = 1000;
    const SLICE: u32 = 20_000;
    const SENSES_CURRENT: bool = true;

    fn drive(&mut self, duty: i16) {
        self.shared.borrow_mut().driven = Some(duty);
    }
    fn coast(&mut self) {
        self.shared.borrow_mut().driven = None;
    }
    fn count(&mut self) -> i32 {
        self.count
    }
    fn current_ma(&mut self) -> i32 {
        let sensed = self.shared.borrow().current_ma;
        sensed.unwrap_or(self.motor.current_ma())
    }
    fn tick(&mut self) -> Result<(), Fault> {
        let mut shared = self.shared.borrow_mut();
        let before = self.motor.state.count;
        if !shared.locked {
            self.motor.advance(shared.driven, PERIOD_S);
        }
        self.count += shared.encoder * (self.motor.state.count - before);
        shared.period += 1;
        match shared.fails {
            Some(fault) => Err(fault),
            None => Ok(()),
        }
    }
    fn receive(&mut self) -> Option<u8> {
        self.shared.borrow_mut().to_device.pop_front()
    }
    fn send(&mut self, bytes: &[u8]) -> usize {
        self.shared.borrow_mut().to_host.extend(bytes);
        bytes.len()
    }
    fn entropy(&mut self) -> u32 {
        7
    }
}

struct Host<S: shared::fit::Arithmetic> {
    app: App<'static, Rig, S, 2000>,
    bench: Rc<RefCell<Bench>>,
    inbox: Deframer,
    heard: Vec<ToHost>,
    alive: bool,
}

impl<S: shared::fit::Arithmetic> Host<S> {
    fn new(motor: Motor) -> Self {
        let bench = Rc::new(RefCell::new(Bench {
            encoder: 1,
            ..Bench::default()
        }));
        let rig = Rig {
            motor,
            count: -5,
            shared: bench.clone(),
        };
        Host {
            app: App::new(
                rig,
                Box::leak(Box::default()),
                Box::leak(Box::new(Log::new())),
            ),
            bench,
            inbox: Deframer::default(),
            heard: Vec::new(),
            alive: true,
        }
    }

    fn say(&mut self, message: &ToDevice) {
        let mut buffer = [0; LONGEST_FRAME];
        let frame = encode(message, &mut buffer).unwrap();
        self.bench.borrow_mut().to_device.extend(frame);
    }

    /// One period; what the device said is kept.
    fn period(&mut self) {
        let period = self.bench.borrow().period;
        if self.alive && period.is_multiple_of(100) {
            self.say(&ToDevice::Alive);
        }
        self.app.period();
        let mut bench = self.bench.borrow_mut();
        assert!(
            bench.driven.is_none()
                || matches!(
                    self.app.phase(),
                    Phase::Probe | Phase::Excite | Phase::Record | Phase::Verify
                ),
            "driven in {:?}",
            self.app.phase()
        );
        for byte in bench.to_host.drain(..) {
            self.heard.extend(self.inbox.push::<ToHost>(byte));
        }
    }

    fn start(&mut self, job: Job) {
        self.say(&ToDevice::Arm);
        self.period();
        let nonce = self.heard.iter().rev().find_map(|message| match message {
            ToHost::Armed { nonce, .. } => Some(*nonce),
            _ => None,
        });
        self.say(&ToDevice::Start {
            nonce: nonce.expect("armed"),
            job,
        });
        self.period();
    }

    /// Runs until there is an outcome; `mischief` may meddle before each period.
    fn run(
        &mut self,
        job: Job,
        mut mischief: impl FnMut(&mut Bench, Phase, u32),
    ) -> Result<Report, Failure> {
        self.start(job);
        let mut in_phase = (self.app.phase(), 0);
        for _ in 0..100_000 {
            let phase = self.app.phase();
            in_phase = if in_phase.0 == phase {
                (phase, in_phase.1 + 1)
            } else {
                (phase, 0)
            };
            mischief(&mut self.bench.borrow_mut(), phase, in_phase.1);
            self.period();
            match self.heard.last() {
                Some(ToHost::Report(report)) => return Ok(report.clone()),
                Some(ToHost::Failed(failure)) => return Err(failure.clone()),
                _ => {}
            }
        }
        panic!("no outcome in {:?}", self.app.phase());
    }

    fn rows(&self, stage: Stage) -> Vec<Row> {
        let mut rows = Vec::new();
        for message in &self.heard {
            if let ToHost::Rows(batch) = message
                && batch.stage == stage
            {
                assert_eq!(
                    batch.first as usize,
                    rows.len(),
                    "rows of {stage:?} without a gap"
                );
                rows.extend(batch.rows.iter().copied());
            }
        }
        rows
    }
}

fn job() -> Job {
    Job {
        kind: Kind::Commission,
        amplitude: 30_000,
        excite: 3_000,
        coast: true,
        record: 2_000,
        verify: 1_500,
        verify_within: 60,
        seed: 3,
        fit: Settings::default(),
        limits: Limits {
            duty: 32_000,
            travel: 0,
            speed: 0,
            current_ma: 20_000,
            continuous_ma: 0,
            thermal: 0,
            stall_ma: 0,
            time: 60_000,
        },
    }
}

#[test]
fn a_motor_commissions_itself_in_both_formats() {
    fn whole<S: shared::fit::Arithmetic>() {
        let mut host = Host::<S>::new(SMALL);
        let report = host
            .run(job(), |_, _, _| {})
            .unwrap_or_else(|failure| panic!("{failure:?}"));
        let outcome = report.outcome.expect("fitted");
        let kt = f64::from(SMALL.constant);
        let total = kt * kt + f64::from(SMALL.resistance * SMALL.viscous);
        let gain = kt / total * 24.0 * 2000.0 / std::f64::consts::TAU * 1e-3;
        let (r, l, j, f) = (
            f64::from(SMALL.resistance),
            f64::from(SMALL.inductance),
            f64::from(SMALL.inertia),
            f64::from(SMALL.viscous),
        );
        let mechanical = (r * j + l * f) / total * 1e3;
        let found = [outcome.estimates[0].value, outcome.estimates[1].value];
        println!(
            "{found:?} for {gain}, {mechanical}; {outcome:?} {:?}",
            report.verified
        );
        assert!(
            (f64::from(found[0]) / gain - 1.0).abs() < 2e-3,
            "{found:?} for {gain}"
        );
        assert!(
            (f64::from(found[1]) / mechanical - 1.0).abs() < 5e-3,
            "{found:?} for {mechanical}"
        );
        let verified = report.verified.expect("verified");
        assert_eq!(verified.periods, 1_500);
        assert!(verified.mean_square.sqrt() < 0.5);
        for (stage, length) in [
            (Stage::Excite, 3_000),
            (Stage::Record, 2_000),
            (Stage::Verify, 1_500),
        ] {
            assert_eq!(host.rows(stage).len(), length, "{stage:?}");
        }
        // The host fits what it was sent, and gets the same bits.
        let rows = host.rows(Stage::Record);
        let duties: Vec<i16> = rows.iter().map(|row| row.duty).collect();
        let steps: Vec<i16> = rows.iter().map(|row| row.step).collect();
        let trace = shared::trace::Trace {
            duties: &duties,
            steps: &steps,
        };
        let mut fit = shared::fit::Fit::<S>::idle();
        assert!(fit.begin(&trace, job().fit));
        let again = loop {
            if let Some(outcome) = fit.work(&trace, 1_000_000) {
                break outcome;
            }
        };
        assert_eq!(again, outcome);
    }
    whole::<f32>();
    whole::<Fixed>();
}

#[test]
fn every_fault_ends_a_run_with_the_bridge_open_and_its_cause_reported() {
    type Mischief = fn(&mut Bench, Phase, u32);
    let cases: [(Fault, Mischief); 6] = [
        (Fault::Runaway, |bench, _, _| bench.encoder = -1),
        (Fault::Stall, |bench, _, _| bench.locked = true),
        (Fault::Stall, |bench, phase, at| {
            bench.encoder = i32::from(phase != Phase::Record || at < 300)
        }),
        (Fault::Runaway, |bench, phase, at| {
            if phase == Phase::Excite && at > 500 {
                bench.encoder = -1
            }
        }),
        (Fault::Overcurrent, |bench, phase, at| {
            bench.current_ma = (phase == Phase::Verify && at > 100).then_some(-30_000)
        }),
        (Fault::Bridge, |bench, phase, at| {
            bench.fails = (phase == Phase::Record && at > 100).then_some(Fault::Bridge)
        }),
    ];
    for (fault, mischief) in cases {
        let mut host = Host::<f32>::new(SMALL);
        let failure = host.run(job(), mischief).expect_err("it must fail");
        assert_eq!(failure.fault, fault, "{failure:?}");
        assert_eq!(host.bench.borrow().driven, None);
        assert_eq!(host.app.phase(), Phase::Report(Err(fault)));
    }
}

#[test]
fn limits_end_a_run() {
    type Change = fn(&mut Limits);
    let cases: [(Fault, Change); 5] = [
        (Fault::Overtravel, |limits| limits.travel = 900),
        (Fault::Overspeed, |limits| limits.speed = 60),
        (Fault::TimeUp, |limits| limits.time = 2_500),
        (Fault::Overheated, |limits| {
            (limits.continuous_ma, limits.thermal) = (900, 300)
        }),
        (Fault::Overcurrent, |limits| limits.current_ma = 3_000),
    ];
    for (fault, change) in cases {
        let mut job = job();
        change(&mut job.limits);
        let mut host = Host::<f32>::new(SMALL);
        let failure = host.run(job, |_, _, _| {}).expect_err("it must fail");
        assert_eq!(failure.fault, fault, "{failure:?}");
        assert!(failure.seen >= failure.limit, "{failure:?}");
    }
}

#[test]
fn a_silent_host_and_a_stop_let_the_motor_go() {
    for phase in [Phase::Probe, Phase::Excite, Phase::Record, Phase::Verify] {
        let mut host = Host::<f32>::new(SMALL);
        host.start(job());
        while host.app.phase() != phase {
            host.period();
        }
        host.alive = false;
        let silent = (0..).find(|_| {
            host.period();
            host.bench.borrow().driven.is_none() && matches!(host.app.phase(), Phase::Report(_))
        });
        assert!(silent.unwrap() <= 500, "{phase:?}");
        assert_eq!(host.app.phase(), Phase::Report(Err(Fault::LinkLost)));

        let mut host = Host::<f32>::new(SMALL);
        host.start(job());
        while host.app.phase() != phase {
            host.period();
        }
        host.say(&ToDevice::Stop);
        host.period();
        assert_eq!(
            host.app.phase(),
            Phase::Report(Err(Fault::Stopped)),
            "{phase:?}"
        );
        assert_eq!(host.bench.borrow().driven, None);
    }
}

#[test]
fn nothing_moves_without_the_nonce_of_a_fresh_arming() {
    let mut host = Host::<f32>::new(SMALL);
    host.say(&ToDevice::Start {
        nonce: 0,
        job: job(),
    });
    host.period();
    assert!(matches!(
        host.heard.last(),
        Some(ToHost::Refused(Refusal::NotArmed))
    ));
    host.say(&ToDevice::Arm);
    host.period();
    let Some(ToHost::Armed { nonce, periods }) = host.heard.last().cloned() else {
        panic!("{:?}", host.heard.last());
    };
    host.say(&ToDevice::Start {
        nonce: nonce ^ 1,
        job: job(),
    });
    host.say(&ToDevice::Start { nonce, job: job() });
    host.period();
    assert_eq!(
        host.app.phase(),
        Phase::Idle,
        "a wrong nonce uses the arming up"
    );
    host.say(&ToDevice::Arm);
    host.period();
    let Some(ToHost::Armed { nonce, .. }) = host.heard.last().cloned() else {
        panic!("{:?}", host.heard.last());
    };
    for _ in 0..=periods {
        host.period();
    }
    host.say(&ToDevice::Start { nonce, job: job() });
    host.period();
    assert_eq!(host.app.phase(), Phase::Idle, "an old nonce");
}

#[test]
fn a_cogging_motor_is_not_taken_for_a_plain_one() {
    let mut host = Host::<f32>::new(Motor {
        cogging: 0.02,
        ..SMALL
    });
    let failure = host
        .run(job(), |_, _, _| {})
        .expect_err("the model must not stand");
    assert_eq!(failure.fault, Fault::NotVerified, "{failure:?}");
    assert!(failure.report.unwrap().outcome.is_some());
}
