//! The application's side of the link: identification, arming and starting, retransmission of the recording.

use super::recording::Batch;
use super::tune::Trial;
use super::{App, NO_REPORT};
use crate::board::Board;
use crate::guard::{Guard, Rating};
use crate::log;
use crate::phase::{Event, Fault, Phase};
use shared::bridge::Bridge;
use shared::fit::Arithmetic;
use shared::rng::Rng;
use shared::trace::OPEN;
use shared::wire::{
    About, Details, Job, Kind, PlanDigest, PlanPart, Refusal, Report, Row, ToDevice, ToHost,
    VERSION,
};

/// A nonce starts a run for this long.
const ARMED_US: u32 = 5_000_000;
/// Host time-out after which the bridge opens.
const SILENCE_US: u32 = 500_000;

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    pub(super) fn check_link(&self) -> Result<(), Fault> {
        if self.silence > Self::periods(SILENCE_US) {
            return Err(Fault::LinkLost);
        }
        Ok(())
    }

    pub(super) fn receive(&mut self) {
        // No more than a period brings at any baud rate we use: a babbling line cannot hold the period up.
        for _ in 0..256 {
            let Some(byte) = self.board.receive() else {
                return;
            };
            if let Some(message) = self.memory.inbox.push(byte) {
                self.silence = 0;
                self.handle(message);
            }
        }
    }

    #[inline(never)]
    pub(super) fn handle(&mut self, message: ToDevice) {
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
            ToDevice::Start { nonce, job, plan } => {
                let answer = match self.start(nonce, job, plan) {
                    Ok(()) => ToHost::Started { run: nonce },
                    Err(why) => {
                        log::refused(why);
                        ToHost::NotStarted { run: nonce, why }
                    }
                };
                self.memory.outbox.post(&answer);
            }
            ToDevice::Stop => {
                if !matches!(self.phase, Phase::Idle | Phase::Report(_)) {
                    self.fail(Fault::Stopped);
                }
            }
            ToDevice::Plan(part) => self.plan(&part),
            ToDevice::SetPoint(set_point) => {
                if self.phase == Phase::Follow {
                    self.memory.following.take(set_point);
                }
            }
            ToDevice::Resend { first } => self.resend(first),
            ToDevice::Describe => {
                let details = Details {
                    reset: self.board.reset(),
                    current_limit_ma: B::CURRENT_LIMIT_MA,
                    senses_supply: self.board.supply_mv().is_some(),
                    carriers: self.board.carriers(),
                    dead_time: self.board.dead_time(),
                    encoder_latency_us: self.board.encoder_latency_us(),
                    servo: self.memory.kept.state,
                    keeps_servo: B::SAVES,
                };
                self.memory.outbox.post(&ToHost::Details(details));
            }
        }
    }

    /// The host has the report, if there was one: it went on.
    pub(super) fn acknowledged(&mut self) {
        if matches!(self.phase, Phase::Report(_)) {
            self.enter(Phase::Idle);
        }
    }

    /// Takes a part of a plan and says how much is held. Not while a run may be playing it.
    #[inline(never)]
    pub(super) fn plan(&mut self, part: &PlanPart) {
        if self.phase != Phase::Idle {
            return self.refuse(Refusal::Busy);
        }
        let Some(held) = self.memory.plan.take(part) else {
            return self.refuse(Refusal::BadPlan);
        };
        let of = part.of;
        self.memory.outbox.post(&ToHost::Planned { of, held });
    }

    #[inline(never)]
    pub(super) fn introduce(&mut self) {
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
    pub(super) fn refuse(&mut self, refusal: Refusal) {
        log::refused(refusal);
        self.memory.outbox.post(&ToHost::Refused(refusal));
    }

    #[inline(never)]
    pub(super) fn arm(&mut self) {
        if self.phase != Phase::Idle {
            return self.refuse(Refusal::Busy);
        }
        // Asked for again, because the answer was late: the same, or a start by the first answer would be refused.
        let nonce = match self.armed {
            Some((nonce, _)) => nonce,
            None => self.nonces.next_u32(),
        };
        let periods = Self::periods(ARMED_US);
        self.armed = Some((nonce, periods));
        self.memory.outbox.post(&ToHost::Armed { nonce, periods });
    }

    #[inline(never)]
    pub(super) fn resend(&mut self, first: u32) {
        let trace = self.recording.trace();
        let mut batch = Batch::resumed(self.report.run, first);
        for (duty, step) in trace.iter().skip(first as usize) {
            let row = Row {
                duty: duty.unwrap_or(OPEN),
                step,
                current_ma: 0,
                supply_mv: 0,
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

    #[inline(never)]
    pub(super) fn start(&mut self, nonce: u32, job: Job, plan: PlanDigest) -> Result<(), Refusal> {
        // Asked for again, because the answer was lost. A run that has ended since is told again, not made again: what acknowledged
        // its report was meant for an earlier one, or came late.
        if self.run == Some(nonce) {
            // Two hosts that armed it together have the same nonce: the run is the first one's.
            if self.job != Some(job) {
                return Err(Refusal::Busy);
            }
            if self.phase == Phase::Idle {
                let ended = self.failure.map_or(Ok(()), |tripped| Err(tripped.fault));
                self.enter(Phase::Report(ended));
            }
            return Ok(());
        }
        if self.phase != Phase::Idle {
            return Err(Refusal::Busy);
        }
        // One try for each arming, right or wrong.
        if self.armed.take().map(|(armed, _)| armed) != Some(nonce) {
            return Err(Refusal::NotArmed);
        }
        let commission = job.kind.fits();
        let fits = usize::from(job.record) <= N && (job.record >= 50 || !commission);
        let sane = job.amplitude > 0 && job.limits.duty > 0 && job.limits.time > 0;
        if !fits || !sane {
            return Err(Refusal::BadJob);
        }
        if job.kind == Kind::Play && self.memory.plan.whole(plan).is_none() {
            return Err(Refusal::BadPlan);
        }
        self.has_servo(&job)?;
        self.run = Some(nonce);
        self.at = 0;
        self.begun_at = self.count;
        self.home = self.count;
        self.memory.trial = Trial::NONE;
        self.recording.clear();
        self.report = Report {
            run: nonce,
            amplitude: match job.kind {
                Kind::Follow => self.memory.kept.servo.amplitude,
                _ => 0,
            },
            ..NO_REPORT
        };
        self.predicts = false;
        self.failure = None;
        let rating = Rating {
            period_us: B::PERIOD_US,
            full: self.board.full(),
            current_ma: B::CURRENT_LIMIT_MA,
            resolution_ma: B::CURRENT_RESOLUTION_MA,
        };
        let guard = self.guard.insert(Guard::new(&job, rating, self.count));
        if job.kind == Kind::Follow {
            guard.learn(&self.memory.kept.servo.learned);
        }
        self.bridge = Bridge::new(job.supply_mv);
        log::started(&job);
        self.job = Some(job);
        if let Ok(phase) = self.phase.after(Event::Start) {
            self.enter(phase);
        }
        Ok(())
    }
}

/// A text, if it fits.
fn text<const L: usize>(from: &str) -> heapless::String<L> {
    let mut text = heapless::String::new();
    let _ = text.push_str(from);
    text
}
