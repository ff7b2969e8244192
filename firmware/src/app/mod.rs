//! The application: a board, the phase it is in, and one control period after another.
//!
//! It holds the invariant that the rest relies on: the bridge drives only while the phase allows it, and it is open when
//! the call returns that leaves such a phase, not a period later. A phase that drives begins by braking until the shaft
//! rests, so that what is recorded begins at rest.
//!
//! Functions that are called from many places are kept out of line: inlined everywhere, they would double the image.
//!
//! Each period: wait for the end of the last one, give the bridge its duty, read, look ([`Guard`]), keep and send the row, make
//! the next duty ready; or, with the bridge open, fit a slice. Nothing waits but [`Board::tick`], and [`Board::count`] until the
//! duty acts.
//!
//! | file | holds |
//! |---|---|
//! | `link` | messages to and from the host; arming and starting |
//! | `drive` | periods with the bridge closed: brake, play, check, record |
//! | `rest` | periods with it open: fit, report the outcome |
//! | `tune` | gains, and a step that tries them |
//! | `keep` | what outlives a power cut, and whether the motor is still that one |
//! | `follow` | set-points that the host sends |
//! | `closed_loop` | what both share |
//! | `script` | which duty comes next |
//! | `recording`, `outbox` | the data of a run; the send buffer |

mod closed_loop;
mod drive;
mod follow;
mod keep;
mod link;
mod outbox;
mod recording;
mod rest;
mod script;
mod tune;

use crate::board::Board;
use crate::guard::{Guard, Tripped};
use crate::log;
use crate::phase::{Bridge, Event, Fault, Phase};
use follow::Following;
use keep::Kept;
use outbox::Outbox;
use recording::Batch;
pub use recording::Recording;
pub use script::{Plan, Script, Which};
use shared::fit::{Arithmetic, Fit};
use shared::rng::{self, Rng};
use shared::trace::OPEN;
use shared::wire::{Deframer, Job, Kind, Report, ToHost};
use tune::Trial;

/// Activity of a phase.
#[allow(
    clippy::large_enum_variant,
    reason = "there is no heap to put the larger one on"
)]
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
    /// Brakes while the prediction catches up with what was driven.
    CatchUp,
    /// Fits.
    Fit,
    /// Simulates a step of the fitted motor.
    Simulate,
    /// Has fitted.
    Fitted,
    /// Saves the servo after so many periods.
    Keep(u32),
}

/// The large part of the application's memory but for the [`Recording`], apart so that a `static` can hold it: an application
/// that is moved once stands on the stack once more. Empty it is all zeros, which takes no flash.
#[derive(Debug)]
pub struct Memory<S: Arithmetic> {
    fit: Fit<S>,
    plan: Plan,
    trial: Trial,
    /// The servo of the last tuning, and one under way.
    kept: Kept,
    following: Following,
    inbox: Deframer,
    outbox: Outbox,
}

impl<S: Arithmetic> Memory<S> {
    /// Empty.
    pub const fn new() -> Self {
        Memory {
            fit: Fit::idle(),
            plan: Plan::new(),
            trial: Trial::NONE,
            kept: Kept::NOTHING,
            following: Following::NONE,
            inbox: Deframer::new(),
            outbox: Outbox::new(),
        }
    }
}

impl<S: Arithmetic> Default for Memory<S> {
    fn default() -> Self {
        Self::new()
    }
}

/// A board that is taken through the phases, fitting in `S` what its recording of `N` periods holds.
#[derive(Debug)]
pub struct App<'m, B, S: Arithmetic, const N: usize> {
    board: B,
    memory: &'m mut Memory<S>,
    recording: &'m mut Recording<N>,
    phase: Phase,
    work: Work,
    nonces: rng::Generator,
    boot: u32,
    /// The nonce that starts a run, and the periods for which it still does.
    armed: Option<(u32, u32)>,
    /// The nonce that started the last run.
    run: Option<u32>,
    job: Option<Job>,
    guard: Option<Guard>,
    /// What the winding sees of a duty.
    bridge: shared::bridge::Bridge,
    /// Duty held during the period that ends next, and the current at its start, mA.
    duty: i16,
    current: i32,
    count: i32,
    begun_at: i32,
    /// Where the run began.
    home: i32,
    /// Periods since the run began, since the host last spoke, and since a repeated message was sent.
    at: u32,
    silence: u32,
    repeat: u32,
    report: Report,
    /// The fitted motor is ready to predict.
    predicts: bool,
    failure: Option<Tripped>,
    /// Stage and period in which the failure came.
    failed_in: (Phase, u32),
}

const NO_REPORT: Report = Report {
    run: 0,
    breakaway: 0,
    amplitude: 0,
    periods: 0,
    limited: 0,
    outcome: None,
    verified: None,
    verdict: None,
    tuned: None,
};

impl<'m, B: Board, S: Arithmetic, const N: usize> App<'m, B, S, N> {
    /// Takes the board over, opens its bridge and waits in [`Phase::Idle`].
    // Out of line: made and moved in one place, it would stand on the stack twice for good.
    #[inline(never)]
    pub fn new(mut board: B, memory: &'m mut Memory<S>, recording: &'m mut Recording<N>) -> Self {
        let mut nonces = rng::seeded(u64::from(board.entropy()));
        let boot = nonces.next_u32();
        let mut app = Self {
            board,
            memory,
            recording,
            phase: Phase::Idle,
            work: Work::Rest,
            nonces,
            boot,
            armed: None,
            run: None,
            job: None,
            guard: None,
            bridge: shared::bridge::Bridge::new(0),
            duty: OPEN,
            current: 0,
            count: 0,
            begun_at: 0,
            home: 0,
            at: 0,
            silence: 0,
            repeat: 0,
            report: NO_REPORT,
            predicts: false,
            failure: None,
            failed_in: (Phase::Idle, 0),
        };
        app.open();
        app.travelled();
        app.recall();
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
        self.silence = self.silence.saturating_add(1);
        self.repeat = self.repeat.saturating_add(1);
        self.at = self.at.saturating_add(1);
        self.armed = self
            .armed
            .and_then(|(nonce, left)| Some((nonce, left.checked_sub(1)?)));
        if self.phase.bridge() == Bridge::Driven {
            match ticked.and_then(|()| self.check_link()) {
                Ok(()) => self.drive(),
                Err(fault) => self.fail(fault),
            }
        } else {
            self.open();
            self.travelled();
            self.rest(ticked.is_ok());
        }
        // After the drive: it must not come late because the host has much to say. A stop opens the bridge here.
        self.receive();
        let (outbox, board) = (&mut self.memory.outbox, &mut self.board);
        outbox.flush(|bytes| board.send(bytes));
    }

    /// Opens the bridge.
    #[inline(never)]
    fn open(&mut self) {
        self.duty = OPEN;
        self.board.coast();
    }

    /// Reads the encoder; gives the counts since it was read last.
    #[inline(never)]
    fn travelled(&mut self) -> i32 {
        let count = self.board.count();
        let step = count.wrapping_sub(self.count);
        self.count = count;
        step
    }

    /// Gives up because of `fault`: opens the bridge, and has the fault to report.
    pub fn fail(&mut self, fault: Fault) {
        self.trip(Tripped::by(fault));
    }

    #[inline(never)]
    fn trip(&mut self, tripped: Tripped) {
        let phase = self.failed_by(tripped);
        self.enter(phase);
    }

    /// Keeps what to report; gives the phase that does.
    fn failed_by(&mut self, tripped: Tripped) -> Phase {
        if !matches!(self.phase, Phase::Report(Err(_))) {
            self.failure = Some(tripped);
            self.failed_in = (self.phase, self.at);
            log::tripped(&tripped, self.phase, self.at);
            self.send_rows();
        }
        self.phase.failed(tripped.fault)
    }

    fn periods(us: u32) -> u32 {
        (us / B::PERIOD_US.max(1)).max(1)
    }

    /// Goes on to the next phase that has something to do.
    #[inline(never)]
    fn done(&mut self) {
        self.send_rows();
        if let Ok(next) = self.phase.after(Event::Done) {
            self.enter(next);
        }
    }

    /// Enters a phase, or the next that has something to do.
    #[inline(never)]
    fn enter(&mut self, mut phase: Phase) {
        // A loop, and no calls of its own: so there is a bound on the stack that all of it can need (`scripts/stack`).
        while let Some(next) = self.leads_on(phase) {
            phase = next;
        }
    }

    /// Enters a phase; gives the one to go on to if there is nothing to do in it.
    fn leads_on(&mut self, phase: Phase) -> Option<Phase> {
        if phase.bridge() == Bridge::Open {
            self.open();
        }
        let changed = phase != self.phase;
        if changed {
            log::entered(phase);
        }
        self.phase = phase;
        self.work = match (phase.bridge(), phase, self.job) {
            (Bridge::Driven, _, Some(job)) if self.length(phase, &job) == 0 => {
                return phase.after(Event::Done).ok();
            }
            (Bridge::Driven, _, Some(job)) => {
                if let Some(guard) = &mut self.guard {
                    guard.resume(self.count);
                }
                if phase == Phase::Follow {
                    let memory = &mut *self.memory;
                    memory.following.begin(&memory.kept.servo, &job);
                }
                self.apply(0);
                Work::Brake { still: 0, all: 0 }
            }
            (_, Phase::Fit, Some(job)) if job.kind.fits() => {
                if !self.memory.fit.begin(&self.recording.trace(), job.fit) {
                    return Some(self.failed_by(Tripped::by(Fault::NothingToFit)));
                }
                Work::Fit
            }
            (_, Phase::Fit, Some(job)) if self.is_to_be_tried(&job) => {
                if !self.recall_motor(&job) {
                    return Some(self.failed_by(Tripped::by(Fault::OtherMotor)));
                }
                // Building takes longer than a period: the next phase waits for one that begins in time.
                Work::Fitted
            }
            // To look at how it predicted takes long as well.
            (_, Phase::Simulate, Some(job))
                if B::SAVES && job.kind == Kind::Follow && self.predicts =>
            {
                Work::Fitted
            }
            (_, Phase::Simulate, Some(job)) if job.kind == Kind::Tune && self.plan_step(&job) => {
                Work::Simulate
            }
            (_, Phase::Keep, Some(_)) if self.is_to_be_kept() => {
                Work::Keep(Self::periods(keep::TOLD_US))
            }
            (_, Phase::Fit | Phase::Simulate | Phase::Keep, _) => {
                return phase.after(Event::Done).ok();
            }
            _ => Work::Rest,
        };
        if let (true, Some(job)) = (changed, self.job) {
            let stage = ToHost::Stage {
                stage: phase.stage(),
                at: self.at,
                length: self.length(phase, &job),
                run: self.report.run,
            };
            self.memory.outbox.post(&stage);
        }
        self.repeat = u32::MAX;
        None
    }
}
