//! Whole runs of the application on the PC: with a healthy motor, and with every injected fault.

use firmware::app::{Memory, Recording};
use firmware::phase::{Fault, Phase};
use firmware::plant::{Motor, SMALL};
use firmware::trials::{self, bench::Bench};
use shared::fit::{Arithmetic, Fit, Grade, Outcome, Settings};
use shared::scalar::Fixed;
use shared::trace::{OPEN, Trace};
use shared::wire::*;
use std::cell::RefCell;
use std::ops::{Deref, DerefMut};

/// A host, a device for the length of the test, and all messages received from it.
struct Host<S: Arithmetic> {
    host: trials::host::Host<'static, S, 2000>,
    received: Vec<ToHost>,
}

impl<S: Arithmetic> Deref for Host<S> {
    type Target = trials::host::Host<'static, S, 2000>;

    fn deref(&self) -> &Self::Target {
        &self.host
    }
}

impl<S: Arithmetic> DerefMut for Host<S> {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.host
    }
}

impl<S: Arithmetic> Host<S> {
    fn new(motor: Motor) -> Self {
        let bench = Box::leak(Box::new(RefCell::new(Bench::new(motor))));
        let (memory, recording) = (
            Box::leak(Box::default()),
            Box::leak(Box::new(Recording::new())),
        );
        Host {
            host: trials::host::Host::new(bench, memory, recording),
            received: Vec::new(),
        }
    }

    /// One period; stores the device's messages.
    fn period(&mut self) {
        let Host { host, received } = self;
        host.period(|message| received.push(message));
        assert_eq!(host.drove_in, None);
    }

    fn start(&mut self, job: Job) {
        assert!(self.host.start(job), "armed");
    }

    /// Runs until there is an outcome; `mischief` may inject a fault before each period.
    #[expect(
        clippy::result_large_err,
        reason = "a failure holds the report of what was fitted"
    )]
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
            match self.received.last() {
                Some(ToHost::Report(report)) => return Ok(report.clone()),
                Some(ToHost::Failed(failure)) => return Err(failure.clone()),
                _ => {}
            }
        }
        panic!("no outcome in {:?}", self.app.phase());
    }

    /// The device's fit once more, from what it has sent.
    fn fitted_again(&self) -> (Fit<S>, Outcome) {
        let rows = self.rows(Stage::Record);
        let duties: Vec<i16> = rows.iter().map(|row| row.duty).collect();
        let steps: Vec<i16> = rows.iter().map(|row| row.step).collect();
        let trace = Trace::new(&duties, &steps);
        let mut fit = Fit::idle();
        assert!(fit.begin(&trace, job().fit));
        loop {
            if let Some(outcome) = fit.work(&trace, 1_000_000) {
                return (fit, outcome);
            }
        }
    }

    fn rows(&self, stage: Stage) -> Vec<Row> {
        let mut rows = Vec::new();
        for message in &self.received {
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

fn start(nonce: u32) -> ToDevice {
    ToDevice::Start {
        nonce,
        job: job(),
        plan: PlanDigest::of(&[]),
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
        accept: Grade::Floor,
        seed: 3,
        fit: Settings::default(),
        limits: Limits {
            duty: 32_000,
            current_ma: 20_000,
            time: 60_000,
            ..Limits::NONE
        },
        counts_per_rev: SMALL.counts_per_rev as u32,
        supply_mv: 24_000,
    }
}

#[test]
fn a_motor_commissions_itself_in_both_formats() {
    fn whole<S: Arithmetic>() {
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
        // A row has the current at its start: none before the first duty has acted.
        for stage in [Stage::Excite, Stage::Record, Stage::Verify] {
            let rows = host.rows(stage);
            let first = rows.iter().position(|row| row.duty != 0).unwrap();
            assert!(
                rows[..=first].iter().all(|row| row.current_ma == 0),
                "{stage:?}"
            );
            assert!(
                rows[first + 1].current_ma.signum() == rows[first].duty.signum(),
                "{stage:?}"
            );
        }
        // The host fits what it was sent, and gets the same bits.
        assert_eq!(host.fitted_again().1, outcome);
    }
    whole::<f32>();
    whole::<Fixed>();
}

/// A carrier takes a new duty over when it next turns round. A shaft that is read before then seems to answer so much later:
/// at 200 µs that would be a percent and more of this motor's time constant.
#[test]
fn it_does_not_matter_how_long_after_a_periods_end_the_carrier_takes_the_duty_over() {
    let found = [0.0, 20e-6, 50e-6, 200e-6].map(|turn_s| {
        let mut host = Host::<f32>::new(SMALL);
        host.bench.borrow_mut().turn_s = turn_s;
        let report = host
            .run(job(), |_, _, _| {})
            .unwrap_or_else(|failure| panic!("{failure:?}"));
        let outcome = report.outcome.expect("fitted");
        let verified = report.verified.expect("verified").mean_square.sqrt();
        println!("{turn_s} s: {:?}, {verified} held out", outcome.estimates);
        assert!(verified < 0.5, "{verified} counts held out at {turn_s} s");
        // The long excitation has an open bridge in it again and again. Coasting shows viscous friction, which no model of the
        // device's has: how much, does not depend on the carrier either.
        let rows = host.rows(Stage::Excite);
        assert!(rows.iter().any(|row| row.duty == OPEN));
        let (mut fit, _) = host.fitted_again();
        assert!(fit.predict(2_000, rows.len() as u32, 50));
        for row in &rows {
            fit.observe(row.duty, row.step);
            fit.catch_up(u32::MAX);
        }
        let coasted = fit.predicted().expect("it predicts").mean_square.sqrt();
        println!("{coasted} counts over the long excitation");
        let values = [0, 1, 2].map(|k| outcome.estimates[k].value);
        (values, coasted)
    });
    let (at_once, coasted) = found[0];
    for (late, late_coasted) in &found[1..] {
        assert!(
            (late_coasted - coasted).abs() < 0.5,
            "{late_coasted}, {coasted} counts"
        );
        // The motor is integrated in other steps.
        for (k, within) in [1e-4, 1e-3, 2e-2].into_iter().enumerate() {
            let off = late[k] / at_once[k] - 1.0;
            assert!(off.abs() < within, "{late:?}, {at_once:?}");
        }
    }
}

/// Also run on emulated microcontrollers, see `scripts/proof`.
#[test]
fn whatever_goes_wrong_in_whichever_phase_the_bridge_opens_and_the_cause_is_reported() {
    fn all<S: Arithmetic>() {
        let mut text = String::new();
        let failed = trials::run::<S>(&mut text, &mut Memory::new(), &mut Recording::new());
        println!("{text}");
        assert_eq!(failed, Ok(0), "{text}");
    }
    all::<f32>();
    all::<Fixed>();
}

#[test]
fn nothing_moves_without_the_nonce_of_a_fresh_arming() {
    let mut host = Host::<f32>::new(SMALL);
    host.send(&start(0));
    host.period();
    assert!(matches!(
        host.received.last(),
        Some(ToHost::NotStarted {
            why: Refusal::NotArmed,
            ..
        })
    ));
    host.send(&ToDevice::Arm);
    host.period();
    let Some(ToHost::Armed { nonce, periods }) = host.received.last().cloned() else {
        panic!("{:?}", host.received.last());
    };
    host.send(&start(nonce ^ 1));
    host.send(&start(nonce));
    host.period();
    assert_eq!(
        host.app.phase(),
        Phase::Idle,
        "a wrong nonce uses the arming up"
    );
    host.send(&ToDevice::Arm);
    host.period();
    let Some(ToHost::Armed { nonce, .. }) = host.received.last().cloned() else {
        panic!("{:?}", host.received.last());
    };
    for _ in 0..=periods {
        host.period();
    }
    host.send(&start(nonce));
    host.period();
    assert_eq!(host.app.phase(), Phase::Idle, "an old nonce");
}

#[test]
fn a_nonce_that_two_hosts_share_starts_one_job() {
    let mut host = Host::<f32>::new(SMALL);
    host.send(&ToDevice::Arm);
    host.period();
    let Some(ToHost::Armed { nonce, .. }) = host.received.last().cloned() else {
        panic!("{:?}", host.received.last());
    };
    host.send(&start(nonce));
    host.period();
    let told = |host: &Host<f32>| {
        host.received
            .iter()
            .rev()
            .find_map(|message| match message {
                ToHost::Started { run } => Some(Ok(*run)),
                ToHost::NotStarted { run, why } => Some(Err((*run, *why))),
                _ => None,
            })
    };
    assert_eq!(told(&host), Some(Ok(nonce)));
    let job = Job {
        limits: Limits {
            duty: 100,
            ..job().limits
        },
        ..job()
    };
    let plan = PlanDigest::of(&[]);
    host.send(&ToDevice::Start { nonce, job, plan });
    host.period();
    assert_eq!(
        told(&host),
        Some(Err((nonce, Refusal::Busy))),
        "another job"
    );
    host.send(&start(nonce));
    host.period();
    assert_eq!(told(&host), Some(Ok(nonce)), "the same job, once more");
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
