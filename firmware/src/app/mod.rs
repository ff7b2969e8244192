//! The application: a board, the phase it is in, and one control period after another.
//!
//! It holds the invariant that the rest relies on: the bridge drives only while the phase allows it, and it is open when
//! the call returns that leaves such a phase, not a period later. A phase that drives begins by braking until the shaft
//! rests, so that what is recorded begins at rest.
//!
//! Functions that are called from many places are kept out of line: inlined everywhere, they would double the image.
//!
//! Each period: wait for its end, read, look ([`Guard`]), keep and send the row, drive; or, with the bridge open, fit a
//! slice. Nothing waits but [`Board::tick`].

mod log;
mod outbox;
mod script;

use crate::board::Board;
use crate::guard::{Guard, Tripped};
use crate::phase::{Bridge, Event, Fault, Phase};
use log::Batch;
pub use log::Log;
use outbox::Outbox;
pub use script::{Plan, Script, Which};
use shared::fit::{Arithmetic, Fit, Outcome};
use shared::rng::{self, Rng};
use shared::trace::OPEN;
use shared::wire::{
    About, Deframer, Failure, Job, Kind, Refusal, Report, Row, ToDevice, ToHost, VERSION, Verified,
};

/// A nonce starts a run for this long.
const ARMED_US: u32 = 5_000_000;
/// Silence of the host after which a driven motor is let go.
const SILENCE_US: u32 = 500_000;
/// A shaft that has not moved for this long rests.
const REST_US: u32 = 50_000;
/// A shaft that brakes for longer than this will not rest.
const LONGEST_BRAKING_US: u32 = 5_000_000;
/// Length of a step of the probe.
const PROBE_STEP_US: u32 = 40_000;
/// Counts that are motion, and not an encoder that sits on an edge.
const MOTION: i32 = 8;
/// A report is sent again after this long, until the host says something that shows that it has it.
const REPEAT_US: u32 = 500_000;
/// The fit's progress is sent this often.
const PROGRESS_US: u32 = 200_000;

/// What a phase does with its periods. There is no heap to put the larger one on.
#[allow(clippy::large_enum_variant)]
#[derive(Debug)]
enum Work {
    /// Nothing.
    Rest,
    /// Brakes until the shaft has not moved for a while; counts the periods since it did, and all.
    Brake { still: u32, all: u32 },
    /// Plays a script, whose next duty is ready when the period begins.
    Play {
        script: Script,
        next: Option<i16>,
        /// None until the first duty acts.
        batch: Option<Batch>,
    },
    /// Fits.
    Fit,
    /// Has fitted.
    Fitted,
}

/// The large part of the application's memory but for the [`Log`], apart so that a `static` can hold it: an application
/// that is moved once stands on the stack once more.
#[derive(Debug)]
pub struct Memory<S: Arithmetic> {
    fit: Fit<S>,
    plan: Plan,
    inbox: Deframer,
    outbox: Outbox,
}

impl<S: Arithmetic> Memory<S> {
    /// Empty.
    pub const fn new() -> Self {
        Memory {
            fit: Fit::idle(),
            plan: Plan::new(),
            inbox: Deframer::new(),
            outbox: Outbox::new(),
        }
    }
}

#[cfg(all(target_os = "none", any(feature = "cortex-m", feature = "trials")))]
impl<S: Arithmetic> Memory<S> {
    /// Empty, in a `static`. Out of line: it is put together on the stack, which must be free again when the rest runs.
    #[inline(never)]
    pub fn placed(cell: &'static static_cell::StaticCell<Self>) -> &'static mut Self {
        cell.init_with(Self::new)
    }
}

impl<S: Arithmetic> Default for Memory<S> {
    fn default() -> Self {
        Self::new()
    }
}

/// A board that is taken through the phases, fitting in `S` what its log of `N` periods holds.
#[derive(Debug)]
pub struct App<'m, B, S: Arithmetic, const N: usize> {
    board: B,
    memory: &'m mut Memory<S>,
    log: &'m mut Log<N>,
    phase: Phase,
    work: Work,
    nonces: rng::Generator,
    boot: u32,
    armed: Option<(u32, u32)>,
    job: Option<Job>,
    guard: Option<Guard>,
    /// Duty held during the period that ends next.
    duty: i16,
    count: i32,
    begun_at: i32,
    /// Periods since the run began, since the host last spoke, and since a repeated message was sent.
    at: u32,
    silence: u32,
    repeat: u32,
    report: Report,
    failure: Option<Tripped>,
    /// Stage and period in which the failure came.
    failed_in: (Phase, u32),
}

const NO_REPORT: Report = Report {
    breakaway: 0,
    amplitude: 0,
    periods: 0,
    outcome: None,
    verified: None,
};

impl<'m, B: Board, S: Arithmetic, const N: usize> App<'m, B, S, N> {
    /// Takes the board over, opens its bridge and waits in [`Phase::Idle`].
    pub fn new(mut board: B, memory: &'m mut Memory<S>, log: &'m mut Log<N>) -> Self {
        board.coast();
        let count = board.count();
        let mut nonces = rng::seeded(u64::from(board.entropy()));
        let boot = nonces.next_u32();
        let mut app = Self {
            board,
            memory,
            log,
            phase: Phase::Idle,
            work: Work::Rest,
            nonces,
            boot,
            armed: None,
            job: None,
            guard: None,
            duty: OPEN,
            count,
            begun_at: count,
            at: 0,
            silence: 0,
            repeat: 0,
            report: NO_REPORT,
            failure: None,
            failed_in: (Phase::Idle, 0),
        };
        app.introduce();
        app
    }

    /// The board.
    pub fn board(&self) -> &B {
        &self.board
    }

    /// The phase that the device is in.
    pub fn phase(&self) -> Phase {
        self.phase
    }

    /// One control period.
    pub fn period(&mut self) {
        let ticked = self.board.tick();
        let count = self.board.count();
        let step = count.wrapping_sub(self.count);
        self.count = count;
        self.silence = self.silence.saturating_add(1);
        self.repeat = self.repeat.saturating_add(1);
        self.at = self.at.saturating_add(1);
        if self.phase.bridge() == Bridge::Driven {
            match ticked.and_then(|()| self.listen()) {
                Ok(()) => self.drive(step),
                Err(fault) => self.fail(fault),
            }
        } else {
            self.board.coast();
            self.duty = OPEN;
            self.rest(ticked.is_ok());
        }
        // After the drive: it must not come late because the host has much to say. A stop opens the bridge here.
        self.hear();
        let (outbox, board) = (&mut self.memory.outbox, &mut self.board);
        outbox.flush(|bytes| board.send(bytes));
    }

    /// Gives up because of `fault`: opens the bridge, and has the fault to report.
    pub fn fail(&mut self, fault: Fault) {
        self.trip(Tripped {
            fault,
            seen: 0,
            limit: 0,
        });
    }

    #[inline(never)]
    fn trip(&mut self, tripped: Tripped) {
        if !matches!(self.phase, Phase::Report(Err(_))) {
            self.failure = Some(tripped);
            self.failed_in = (self.phase, self.at);
            self.send_rows();
        }
        self.enter(self.phase.failed(tripped.fault));
    }

    fn periods(us: u32) -> u32 {
        (us / B::PERIOD_US.max(1)).max(1)
    }

    // --- the link ---

    fn listen(&self) -> Result<(), Fault> {
        if self.silence > Self::periods(SILENCE_US) {
            return Err(Fault::LinkLost);
        }
        Ok(())
    }

    fn hear(&mut self) {
        // No more than a period brings at any baud rate we use: a babbling line cannot hold the period up.
        for _ in 0..256 {
            let Some(byte) = self.board.receive() else {
                return;
            };
            if let Some(message) = self.memory.inbox.push(byte) {
                self.silence = 0;
                self.obey(message);
            }
        }
    }

    #[inline(never)]
    fn obey(&mut self, message: ToDevice) {
        match message {
            ToDevice::Hello => {
                self.acknowledged();
                self.introduce();
            }
            ToDevice::Alive => {}
            ToDevice::Arm => {
                self.acknowledged();
                self.arm();
            }
            ToDevice::Start { nonce, job } => match self.start(nonce, job) {
                Ok(()) => {}
                Err(refusal) => self.refuse(refusal),
            },
            ToDevice::Stop => {
                if !matches!(self.phase, Phase::Idle | Phase::Report(_)) {
                    self.fail(Fault::Stopped);
                }
            }
            ToDevice::Plan { first, segments } => {
                if first == 0 && self.phase == Phase::Idle {
                    self.memory.plan.clear();
                }
                let follows =
                    usize::from(first) == self.memory.plan.len() && self.phase == Phase::Idle;
                if !follows || self.memory.plan.extend_from_slice(&segments).is_err() {
                    self.refuse(Refusal::BadPlan);
                }
            }
            ToDevice::Resend { first } => self.resend(first),
        }
    }

    /// The host has the report, if there was one: it went on.
    fn acknowledged(&mut self) {
        if matches!(self.phase, Phase::Report(_)) {
            self.enter(Phase::Idle);
        }
    }

    #[inline(never)]
    fn introduce(&mut self) {
        let about = About {
            version: VERSION,
            board: text(B::NAME),
            firmware: text(env!("CARGO_PKG_VERSION")),
            period_us: B::PERIOD_US,
            capacity: u16::try_from(N).unwrap_or(u16::MAX),
            format: S::FORMAT,
            senses_current: B::SENSES_CURRENT,
            boot: self.boot,
            stage: self.phase.stage(),
            full: self.board.full(),
        };
        self.memory.outbox.post(&ToHost::About(about));
    }

    #[inline(never)]
    fn refuse(&mut self, refusal: Refusal) {
        self.memory.outbox.post(&ToHost::Refused(refusal));
    }

    #[inline(never)]
    fn arm(&mut self) {
        if self.phase != Phase::Idle {
            return self.refuse(Refusal::Busy);
        }
        let nonce = self.nonces.next_u32();
        let periods = Self::periods(ARMED_US);
        self.armed = Some((nonce, self.at.wrapping_add(periods)));
        self.memory.outbox.post(&ToHost::Armed { nonce, periods });
    }

    #[inline(never)]
    fn resend(&mut self, first: u32) {
        let trace = self.log.trace();
        let mut batch = Batch::resumed(first);
        for (duty, step) in trace.iter().skip(first as usize) {
            let row = Row {
                duty: duty.unwrap_or(OPEN),
                step,
                current_ma: 0,
            };
            if let Some(rows) = batch.push(row) {
                self.memory.outbox.post(&ToHost::Rows(rows));
                return;
            }
        }
        if let Some(rows) = batch.take() {
            self.memory.outbox.post(&ToHost::Rows(rows));
        }
    }

    // --- a run ---

    #[inline(never)]
    fn start(&mut self, nonce: u32, job: Job) -> Result<(), Refusal> {
        if self.phase != Phase::Idle {
            return Err(Refusal::Busy);
        }
        // One try for each arming, right or wrong.
        match self.armed.take() {
            Some((armed, until)) if armed == nonce && self.at <= until => {}
            _ => return Err(Refusal::NotArmed),
        }
        let commission = job.kind == Kind::Commission;
        let fits = usize::from(job.record) <= N && (job.record >= 50 || !commission);
        let sane = job.amplitude > 0 && job.limits.duty > 0 && job.limits.time > 0;
        if !fits || !sane {
            return Err(Refusal::BadJob);
        }
        if job.kind == Kind::Play && self.memory.plan.is_empty() {
            return Err(Refusal::BadPlan);
        }
        self.at = 0;
        self.begun_at = self.count;
        self.log.clear();
        self.report = NO_REPORT;
        self.failure = None;
        self.guard = Some(Guard::new(
            job.limits,
            B::PERIOD_US,
            self.board.full(),
            self.count,
        ));
        self.job = Some(job);
        if let Ok(phase) = self.phase.after(Event::Start) {
            self.enter(phase);
        }
        Ok(())
    }

    /// Goes on to the next phase that has something to do.
    #[inline(never)]
    fn done(&mut self) {
        self.send_rows();
        if let Ok(next) = self.phase.after(Event::Done) {
            self.enter(next);
        }
    }

    fn enter(&mut self, phase: Phase) {
        if phase.bridge() == Bridge::Open {
            self.board.coast();
            self.duty = OPEN;
        }
        let changed = phase != self.phase;
        self.phase = phase;
        self.work = match (phase.bridge(), phase, self.job) {
            (Bridge::Driven, _, Some(job)) if Self::length(phase, &job) == 0 => {
                return self.done();
            }
            (Bridge::Driven, _, Some(_)) => {
                self.apply(0);
                Work::Brake { still: 0, all: 0 }
            }
            (_, Phase::Fit, Some(job)) if job.kind == Kind::Commission => {
                if !self.memory.fit.begin(&self.log.trace(), job.fit) {
                    return self.fail(Fault::NothingToFit);
                }
                Work::Fit
            }
            (_, Phase::Fit, _) => return self.done(),
            _ => Work::Rest,
        };
        if let (true, Some(job)) = (changed, self.job) {
            let stage = ToHost::Stage {
                stage: phase.stage(),
                at: self.at,
                length: Self::length(phase, &job),
            };
            self.memory.outbox.post(&stage);
        }
        self.repeat = u32::MAX;
    }

    /// Periods that a phase drives, as far as they are known before.
    fn length(phase: Phase, job: &Job) -> u32 {
        match (phase, job.kind) {
            (Phase::Probe, Kind::Play) => 0,
            (Phase::Probe, _) => 41 * Self::periods(PROBE_STEP_US),
            (Phase::Excite, Kind::Play) => u32::MAX,
            (Phase::Excite, _) => job.excite,
            (Phase::Record, Kind::Commission) => job.record.into(),
            (Phase::Verify, Kind::Commission) => job.verify,
            _ => 0,
        }
    }

    fn script(&self, job: &Job) -> Option<Script> {
        let amplitude = self.report.amplitude;
        let which = match (self.phase, job.kind) {
            (Phase::Probe, _) => {
                return Some(Script::growing(
                    job.limits.duty,
                    Self::periods(PROBE_STEP_US),
                ));
            }
            (Phase::Excite, Kind::Play) => return Some(Script::plan()),
            (Phase::Excite, _) => Which::Excite { coast: job.coast },
            (Phase::Record, _) => Which::Record,
            (Phase::Verify, _) => Which::Verify,
            _ => return None,
        };
        let length = Self::length(self.phase, job);
        Some(Script::excitation(which, length, amplitude, job.seed))
    }

    /// A period of a phase that drives: what has just ended is looked at, kept and sent; then the next duty is applied.
    fn drive(&mut self, step: i32) {
        let Some(job) = self.job else {
            return self.fail(Fault::Stopped);
        };
        let current = self.board.current_ma();
        let held = self.duty;
        if let Work::Play {
            next: Some(duty), ..
        } = self.work
        {
            self.apply(duty);
        }
        let driven = (held != OPEN).then_some(held);
        let sensed = B::SENSES_CURRENT.then_some(current);
        let looked = match &mut self.guard {
            Some(guard) => guard.look(driven, self.count, sensed),
            None => Ok(()),
        };
        if let Err(tripped) = looked {
            return self.trip(tripped);
        }
        match &mut self.work {
            Work::Brake { still, all } => {
                *still = if step == 0 { *still + 1 } else { 0 };
                *all += 1;
                let rests = *still >= Self::periods(REST_US);
                if !rests && *all < Self::periods(LONGEST_BRAKING_US) {
                    return self.apply(0);
                }
                let Some(script) = self.script(&job) else {
                    return self.done();
                };
                // The first duty acts when the next period begins, as all others do: one that came late in this period would
                // put the whole recording off.
                self.work = Work::Play {
                    script,
                    next: None,
                    batch: None,
                };
                self.ready(&job);
            }
            Work::Play {
                batch: batch @ None,
                ..
            } => {
                *batch = Some(Batch::new(self.phase.stage(), self.count));
                self.begun_at = self.count;
                self.ready(&job);
            }
            Work::Play { next, .. } => {
                let ends = next.is_none();
                self.keep(held, step, current);
                if self.phase == Phase::Probe && self.probed(&job) {
                    return;
                }
                if !ends {
                    self.ready(&job);
                } else if self.phase == Phase::Probe {
                    self.fail(Fault::Stall);
                } else if self.phase == Phase::Verify {
                    self.verified(&job);
                } else {
                    self.done();
                }
            }
            _ => self.fail(Fault::Stopped),
        }
    }

    /// Makes the next duty ready.
    #[inline(never)]
    fn ready(&mut self, job: &Job) {
        let Work::Play { script, next, .. } = &mut self.work else {
            return;
        };
        let limit = job.limits.duty;
        *next = script.next(&self.memory.plan).map(|duty| match duty {
            OPEN => OPEN,
            duty => duty.clamp(-limit, limit),
        });
    }

    #[inline(never)]
    fn apply(&mut self, duty: i16) {
        if duty == OPEN {
            self.duty = OPEN;
            self.board.coast();
        } else {
            self.duty = self.board.nearest(duty);
            self.board.drive(self.duty);
        }
    }

    /// Keeps the row of the period that has ended.
    #[inline(never)]
    fn keep(&mut self, duty: i16, step: i32, current_ma: i32) {
        let step = step.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        let current_ma = current_ma.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        if self.phase == Phase::Record {
            self.log.push(duty, step);
        }
        if self.phase == Phase::Verify
            && let Some(verified) = &mut self.report.verified
            && let Some(prediction) = self.memory.fit.prediction()
        {
            prediction.step(duty, step);
            verified.periods += 1;
        }
        self.report.periods = self.report.periods.saturating_add(1);
        if let Work::Play {
            batch: Some(batch), ..
        } = &mut self.work
        {
            let row = Row {
                duty,
                step,
                current_ma,
            };
            if let Some(rows) = batch.push(row) {
                self.memory.outbox.post(&ToHost::Rows(rows));
            }
        }
    }

    #[inline(never)]
    fn send_rows(&mut self) {
        if let Work::Play {
            batch: Some(batch), ..
        } = &mut self.work
            && let Some(rows) = batch.take()
        {
            self.memory.outbox.post(&ToHost::Rows(rows));
        }
    }

    /// Whether the shaft has moved, which ends the probe: with the drive, or against it.
    fn probed(&mut self, job: &Job) -> bool {
        let moved = self.count.wrapping_sub(self.begun_at);
        if moved <= -MOTION {
            self.trip(Tripped {
                fault: Fault::Runaway,
                seen: moved,
                limit: -MOTION,
            });
            return true;
        }
        if moved < MOTION {
            return false;
        }
        self.report.breakaway = self.duty;
        self.report.amplitude = job.amplitude.min(job.limits.duty);
        if let Some(guard) = &mut self.guard {
            let strong = self.duty.saturating_mul(2).max(job.limits.duty / 4);
            guard.expect_motion(strong.min(job.limits.duty));
        }
        self.done();
        true
    }

    /// Builds the fitted motor to predict with. That takes longer than a period may, so it is done while the bridge is open.
    #[inline(never)]
    fn predict(&mut self) {
        if self.job.is_none_or(|job| job.verify == 0) {
            return;
        }
        self.report.verified = self.memory.fit.predict().then_some(Verified {
            mean_square: 0.0,
            periods: 0,
        });
    }

    fn verified(&mut self, job: &Job) {
        if let Some(verified) = &mut self.report.verified
            && let Some(prediction) = self.memory.fit.prediction()
        {
            verified.mean_square = prediction.mean_square(verified.periods);
            let within = job.verify_within as f32 * 0.01;
            if within > 0.0 && verified.mean_square > within * within {
                let seen = verified.mean_square.min(1e9) * 10_000.0;
                let seen = libm::sqrtf(seen) as i32;
                return self.trip(Tripped {
                    fault: Fault::NotVerified,
                    seen,
                    limit: job.verify_within as i32,
                });
            }
        }
        self.done();
    }

    /// A period with the bridge open.
    fn rest(&mut self, punctual: bool) {
        match (&self.work, self.phase) {
            (Work::Fit, Phase::Fit) => self.fit(),
            (Work::Fitted, Phase::Fit) if punctual => {
                // The host may have been silent while nothing moved.
                self.silence = 0;
                self.done();
            }
            (_, Phase::Report(outcome)) if self.repeat >= Self::periods(REPEAT_US) => {
                self.repeat = 0;
                let message = match outcome {
                    Ok(()) => ToHost::Report(self.report.clone()),
                    Err(fault) => ToHost::Failed(self.failed(fault)),
                };
                self.memory.outbox.post(&message);
            }
            _ => {}
        }
    }

    #[inline(never)]
    fn fit(&mut self) {
        let Memory { fit, outbox, .. } = &mut *self.memory;
        if let Some(outcome) = fit.work(&self.log.trace(), B::SLICE) {
            return self.fitted_to(outcome);
        }
        if self.repeat >= Self::periods(PROGRESS_US) {
            self.repeat = 0;
            let (done, of) = fit.progress();
            let least = fit.least();
            outbox.post(&ToHost::Fitting { done, of, least });
        }
    }

    fn fitted_to(&mut self, outcome: Outcome) {
        self.report.outcome = Some(outcome);
        self.predict();
        // The next phase drives: it waits for a period that begins in time.
        self.work = Work::Fitted;
    }

    #[inline(never)]
    fn failed(&self, fault: Fault) -> Failure {
        let (phase, at) = self.failed_in;
        let tripped = self.failure.unwrap_or(Tripped {
            fault,
            seen: 0,
            limit: 0,
        });
        Failure {
            fault,
            stage: phase.stage(),
            at,
            seen: tripped.seen,
            limit: tripped.limit,
            report: (self.report.periods > 0).then(|| self.report.clone()),
        }
    }
}

/// As much of a text as fits.
fn text<const L: usize>(from: &str) -> heapless::String<L> {
    let mut text = heapless::String::new();
    for c in from.chars() {
        if text.push(c).is_err() {
            break;
        }
    }
    text
}
