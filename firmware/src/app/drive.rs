//! Periods with the bridge closed: brake to standstill, play a script, check and record every period.

use super::recording::Batch;
use super::script::{Script, Which};
use super::{App, Work};
use crate::board::Board;
use crate::guard::Tripped;
use crate::phase::{Fault, Phase};
use core::mem::replace;
use shared::fit::Arithmetic;
use shared::scalar::Real;
use shared::trace::OPEN;
use shared::wire::{Job, Kind, Row, ToHost};

/// A shaft that has not moved for this long rests.
const REST_US: u32 = 50_000;
/// A shaft that brakes for longer than this will not rest.
const LONGEST_BRAKING_US: u32 = 5_000_000;
/// Length of a step of the probe.
const PROBE_STEP_US: u32 = 40_000;
/// Counts that are motion, more than an encoder on an edge toggles.
const MOTION: i32 = 8;

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    /// Length of a driving phase in periods, where it is known in advance.
    pub(super) fn length(phase: Phase, job: &Job) -> u32 {
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

    pub(super) fn script(&self, job: &Job) -> Option<Script> {
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
        let current = self.board.current_ma();
        let held_from = replace(&mut self.current, current);
        let step = self.travelled();
        // A bridge opens at once: so where a duty would act, and no sooner.
        if self.duty == OPEN {
            self.open();
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
                self.keep(held, step, held_from);
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

    /// Prepares the next duty.
    #[inline(never)]
    pub(super) fn ready(&mut self, job: &Job) {
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
    pub(super) fn apply(&mut self, duty: i16) {
        self.duty = duty;
        if duty != OPEN {
            self.duty = self.board.nearest(duty);
            self.board.drive(self.duty);
        }
    }

    /// Records the row of the period that has ended.
    #[inline(never)]
    pub(super) fn keep(&mut self, duty: i16, step: i32, current_ma: i32) {
        let step = step.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        let current_ma = current_ma.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        if self.phase == Phase::Record {
            self.recording.push(duty, step);
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
    pub(super) fn send_rows(&mut self) {
        if let Work::Play {
            batch: Some(batch), ..
        } = &mut self.work
            && let Some(rows) = batch.take()
        {
            self.memory.outbox.post(&ToHost::Rows(rows));
        }
    }

    /// True once the shaft has moved, with the drive or against it: this ends the probe.
    pub(super) fn probed(&mut self, job: &Job) -> bool {
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

    pub(super) fn verified(&mut self, job: &Job) {
        if let Some(verified) = &mut self.report.verified
            && let Some(prediction) = self.memory.fit.prediction()
        {
            verified.mean_square = prediction.mean_square(verified.periods);
            let within = job.verify_within as f32 * 0.01;
            if within > 0.0 && verified.mean_square > within * within {
                let seen = verified.mean_square.min(1e9) * 10_000.0;
                let seen = Real::sqrt(seen) as i32;
                return self.trip(Tripped {
                    fault: Fault::NotVerified,
                    seen,
                    limit: job.verify_within as i32,
                });
            }
        }
        self.done();
    }
}
