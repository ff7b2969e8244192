//! Periods with the bridge closed: brake to standstill, play a script, check and record every period.

use super::recording::Batch;
use super::script::{Script, Which};
use super::{App, Work};
use crate::board::Board;
use crate::guard::{Guard, LONGEST_WINDOW_MS, Measured, Tripped};
use crate::phase::{Fault, Phase};
use core::mem::replace;
use shared::fit::{Arithmetic, Grade};
use shared::scalar::Real;
use shared::trace::OPEN;
use shared::wire::{Job, Kind, Row, ToHost};

/// A shaft that has not moved for this long rests.
const REST_US: u32 = 50_000;
/// A shaft that brakes for longer than this will not rest.
const LONGEST_BRAKING_US: u32 = 5_000_000;
/// Length of a step of the probe.
const PROBE_STEP_US: u32 = 25_000;
/// The shaft that the probe has moved comes to rest in this time, or nearly.
const PROBE_BRAKE_US: u32 = 100_000;

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    /// Length of a driving phase in periods, where it is known in advance.
    pub(super) fn length(&self, phase: Phase, job: &Job) -> u32 {
        match (phase, job.kind) {
            (Phase::Follow, Kind::Follow) => u32::MAX,
            (Phase::Verify, Kind::Follow) if self.is_to_be_tried(job) => job.verify,
            (_, Kind::Follow) | (Phase::Probe, Kind::Play) => 0,
            (Phase::Probe, _) => Script::GROWING_STEPS * Self::periods(PROBE_STEP_US),
            (Phase::Excite, Kind::Play) => u32::MAX,
            (Phase::Excite, _) => job.excite,
            (Phase::Record, kind) if kind.fits() => job.record.into(),
            (Phase::Verify, kind) if kind.fits() => job.verify,
            (Phase::Tune, Kind::Tune) => self.memory.trial.periods(),
            _ => 0,
        }
    }

    pub(super) fn script(&self, job: &Job) -> Option<Script> {
        let amplitude = self.report.amplitude;
        let which = match (self.phase, job.kind) {
            (Phase::Probe, _) => {
                let guard = self.guard.as_ref()?;
                let to = guard.probe_to(self.board.full(), B::SENSES_CURRENT);
                return Some(Script::growing(to, Self::periods(PROBE_STEP_US)));
            }
            (Phase::Excite, Kind::Play) => return Some(Script::plan()),
            (Phase::Excite, _) => Which::Excite { coast: job.coast },
            (Phase::Record, _) => Which::Record,
            (Phase::Verify, _) => Which::Verify,
            (Phase::Tune | Phase::Follow, _) => return Some(Script::Servo),
            _ => return None,
        };
        let length = self.length(self.phase, job);
        Some(Script::excitation(which, length, amplitude, job.seed))
    }

    /// One period of a driving phase: applies the prepared duty; checks, records and sends the period that has ended; and
    /// prepares the next duty.
    // Out of line, as all that is long: short instructions reach the first kilobyte of a stack only.
    #[inline(never)]
    pub(super) fn drive(&mut self) {
        let Some(job) = self.job else {
            return self.fail(Fault::Stopped);
        };
        let held = self.duty;
        if let Work::Play {
            next: Some(duty), ..
        } = self.work
        {
            self.apply(duty);
        }
        // The legs of a bridge whose shunts are below them conduct when the carrier has turned.
        let step = self.travelled();
        let current = self.board.current_ma();
        let held_from = replace(&mut self.current, current);
        let measured = Measured {
            current_ma: B::SENSES_CURRENT.then_some(current),
            supply_mv: self.board.supply_mv(),
        };
        // A bridge opens at once: so where a duty would act, and no sooner.
        if self.duty == OPEN {
            self.open();
        }
        let driven = (held != OPEN).then_some(held);
        let looked = match &mut self.guard {
            Some(guard) => guard.look(driven, self.count, measured),
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
                self.ready(&job, step);
            }
            Work::Play {
                batch: batch @ None,
                ..
            } => {
                *batch = Some(Batch::new(self.report.run, self.phase.stage(), self.count));
                self.begun_at = self.count;
                self.ready(&job, step);
            }
            Work::CatchUp => {
                self.apply(0);
                if self.memory.fit.catch_up(B::SLICE) {
                    self.verified(&job);
                }
            }
            Work::Play { next, .. } => {
                let ends = next.is_none();
                self.keep(held, step, held_from, measured);
                if self.phase == Phase::Probe && self.probed(&job, held, measured.current_ma) {
                    return;
                }
                if !ends {
                    self.ready(&job, step);
                } else if self.phase == Phase::Probe {
                    let unmoved = |guard: &Guard| guard.unmoved(measured.current_ma);
                    self.fail(self.guard.as_ref().map_or(Fault::Stall, unmoved));
                } else if self.phase == Phase::Verify {
                    self.send_rows();
                    self.work = Work::CatchUp;
                    self.apply(0);
                } else if self.phase == Phase::Tune {
                    self.tuned();
                } else {
                    self.done();
                }
            }
            _ => self.fail(Fault::Stopped),
        }
    }

    /// Prepares the next duty.
    #[inline(never)]
    pub(super) fn ready(&mut self, job: &Job, step: i32) {
        let closed_loop = matches!(self.phase, Phase::Tune | Phase::Follow);
        let asked = match self.phase {
            Phase::Tune => self.closed_loop(step),
            Phase::Follow => self.follow(step),
            _ => None,
        };
        let Work::Play { script, next, .. } = &mut self.work else {
            return;
        };
        let limit = job.limits.duty;
        let scripted = script.next(self.memory.plan.segments());
        *next = asked.or(scripted).map(|duty| {
            if duty == OPEN {
                return OPEN;
            }
            let ordered = duty.clamp(-limit, limit);
            let guard = self.guard.as_ref();
            let bounded = guard.map_or(ordered, |guard| guard.bounded(ordered));
            self.report.limited += u32::from(bounded != ordered);
            bounded
        });
        if let (true, Some(duty)) = (closed_loop, *next) {
            self.servo_acts(duty);
        }
    }

    #[inline(never)]
    pub(super) fn apply(&mut self, duty: i16) {
        self.duty = duty;
        if duty != OPEN {
            self.duty = self.board.nearest(duty);
            self.board.drive(self.duty);
        }
    }

    /// Records the row of the period that has ended, which began with `from_ma`.
    #[inline(never)]
    pub(super) fn keep(&mut self, duty: i16, step: i32, from_ma: i32, measured: Measured) {
        let step = step.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        let current_ma = from_ma.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        let duty = self.bridge.at_winding(duty, measured.supply_mv);
        if self.phase == Phase::Record {
            self.recording.push(duty, step);
        }
        if self.phase == Phase::Verify && self.predicts {
            self.memory.fit.observe(duty, step);
            self.memory.fit.catch_up(B::SLICE);
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
                supply_mv: measured.supply_mv.unwrap_or(0),
            };
            if let Some(rows) = batch.push(row) {
                self.memory.outbox.post(&ToHost::Rows(rows));
            }
        }
    }

    #[inline(never)]
    pub(super) fn send_rows(&mut self) {
        if let Work::Play {
            batch: Some(batch), ..
        } = &mut self.work
            && let Some(rows) = batch.take()
        {
            self.memory.outbox.post(&ToHost::Rows(rows));
        }
    }

    /// Looks at a period of the probe; true if it has ended or been given up.
    pub(super) fn probed(&mut self, job: &Job, duty: i16, current_ma: Option<i32>) -> bool {
        let first_step = self.report.periods <= Self::periods(PROBE_STEP_US);
        let (Some(guard), Work::Play { script, .. }) = (&mut self.guard, &mut self.work) else {
            return false;
        };
        if let Script::Step { brake, .. } = *script {
            if brake > 0 || duty == 0 {
                // It brakes: the step begins where that ends.
                self.begun_at = self.count;
            } else if guard.probe_step(duty, self.count.wrapping_sub(self.begun_at), current_ma) {
                self.done();
                return true;
            }
            return false;
        }
        let moved = self.count.wrapping_sub(self.begun_at);
        match guard.probe(duty, moved, first_step, current_ma) {
            Ok(false) => {}
            Ok(true) => {
                self.report.breakaway = self.duty;
                self.report.amplitude = job.amplitude.min(job.limits.duty);
                let strong = self.duty.saturating_mul(2).max(job.limits.duty / 4);
                *script = Script::Step {
                    brake: Self::periods(PROBE_BRAKE_US),
                    duty: guard.bounded(strong.min(job.limits.duty)),
                    left: Self::periods(LONGEST_WINDOW_MS * 1000),
                };
            }
            Err(tripped) => {
                self.trip(tripped);
                return true;
            }
        }
        false
    }

    pub(super) fn verified(&mut self, job: &Job) {
        let tried = self.is_to_be_tried(job);
        let fit = &mut self.memory.fit;
        if tried && let Some(predicted) = fit.predicted() {
            self.report.verified = Some(predicted);
            return self.tried(&predicted);
        }
        // A motor that cannot even predict is good for nothing.
        let (mut grade, mut mean_square) = (Grade::No, 0.0);
        if self.predicts
            && let Some(predicted) = fit.predicted()
        {
            let verdict = fit.verdict(&predicted, job.verify_within as f32 * 0.01);
            (grade, mean_square) = (verdict.grade, predicted.mean_square);
            self.report.verified = Some(predicted);
            self.report.verdict = Some(verdict);
        }
        if grade < job.accept {
            return self.trip(Tripped {
                fault: Fault::NotVerified,
                seen: Real::sqrt(mean_square.min(1e9) * 10_000.0) as i32,
                limit: job.verify_within as i32,
            });
        }
        self.done();
    }
}
