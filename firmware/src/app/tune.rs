//! From a fitted motor to a servo: gains, a step that is simulated with the fitted motor, and the same step of the motor.

use super::closed_loop::{OF_LIMITS, as_duty, as_part};
use super::keep::{Kept, KeptServo};
use super::{App, Work};
use crate::board::Board;
use crate::phase::Phase;
use shared::fit::{Arithmetic, Grade, Verdict};
use shared::servo::{Response, Servo, Step, Target};
use shared::wire::{Job, ServoState, Tuned};

/// Part of the largest duty that a step may ask for.
const ASKED: f32 = 0.5;
/// Least step, counts, that shows how it is answered.
const LEAST_STEP: f32 = 20.0;
/// Largest speed of a step by its length and the position loop's gain: `2/e`, of two equal poles.
const PEAK: f32 = 0.74;
/// A step is watched for so many of its own settling times, and this long beside.
const WATCHED: f32 = 2.5;
const BESIDE_US: u32 = 100_000;
/// Longest step, periods: ten seconds at a kilohertz.
const LONGEST: f32 = 10_000.0;
/// What a period of the fitted motor's step costs, in samples of the hot loop.
const SAMPLES: u32 = 20;

/// A step under way, of the fitted motor or of the motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial {
    servo: Servo,
    step: Step,
    /// Its length, counts, and its sense.
    counts: f32,
    back: bool,
    /// Periods in all, and over.
    periods: u32,
    over: u32,
    /// Of the fitted motor: its last reading and the next, and the duty that acts.
    read: i32,
    at: i32,
    duty: f32,
}

/// The whole counts below an angle.
fn whole(angle: f32) -> i32 {
    let toward_zero = angle as i32;
    toward_zero - i32::from(angle < toward_zero as f32)
}

impl Trial {
    /// None: all zeros.
    pub(super) const NONE: Self = Trial {
        servo: Servo::IDLE,
        step: Step::NONE,
        counts: 0.0,
        back: false,
        periods: 0,
        over: 0,
        read: 0,
        at: 0,
        duty: 0.0,
    };

    pub(super) fn periods(&self) -> u32 {
        self.periods
    }

    /// Counts to where it goes.
    fn target(&self) -> i32 {
        let counts = self.counts as i32;
        if self.back { -counts } else { counts }
    }

    /// Counts that were travelled, along it.
    fn along(&self, counts: i32) -> i32 {
        if self.back {
            counts.saturating_neg()
        } else {
            counts
        }
    }
}

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    /// Computes the gains and the step, and puts the fitted motor to rest. Returns false if its numbers are not good enough, or the limits leave
    /// no room for a step.
    #[inline(never)]
    pub(super) fn plan_step(&mut self, job: &Job) -> bool {
        let good = |verdict: &Verdict| verdict.grade >= Grade::Control;
        let Some(verdict) = self.report.verdict.filter(good) else {
            return false;
        };
        let gains = self.memory.fit.gains(verdict.acceleration);
        let limit = as_part(self.report.amplitude.min(job.limits.duty));
        let mut counts = gains.largest_step(ASKED * limit).max(LEAST_STEP);
        if job.limits.travel > 0 {
            counts = counts.min(OF_LIMITS * job.limits.travel as f32);
        }
        if job.limits.speed > 0 {
            let fastest = OF_LIMITS * f32::from(job.limits.speed);
            counts = counts.min(fastest / (PEAK * 2.0 * gains.position));
        }
        let fits = counts >= LEAST_STEP && self.memory.fit.rest();
        if !fits {
            return false;
        }
        let beside = Self::periods(BESIDE_US) as f32;
        let trial = &mut self.memory.trial;
        *trial = Trial {
            counts: counts as i32 as f32,
            // Back to where the run began, so that it stays within the limits of travel.
            back: self.count.wrapping_sub(self.home) > 0,
            periods: (WATCHED * gains.settling() + beside).min(LONGEST) as u32,
            ..Trial::NONE
        };
        trial.servo.begin(gains, limit);
        trial.step.begin(trial.counts);
        self.report.tuned = Some(Tuned {
            gains,
            step: trial.target(),
            predicted: Response::default(),
            measured: None,
            kept: false,
        });
        true
    }

    /// Simulates a slice of the fitted motor's step.
    #[inline(never)]
    pub(super) fn simulate(&mut self) {
        let memory = &mut *self.memory;
        let trial = &mut memory.trial;
        for _ in 0..B::SLICE / SAMPLES + 1 {
            let read = trial.at;
            trial.step.see(trial.along(read));
            let target = Target::Position(trial.target());
            let next = trial.servo.next(read - trial.read, target);
            // The duty that the last reading gave acts until the next one. The motor began in the middle of a count.
            let angle = memory.fit.moved(as_duty(trial.duty));
            (trial.read, trial.at) = (read, whole(angle + 0.5));
            trial.duty = next;
            trial.over += 1;
            if trial.over > trial.periods {
                return self.simulated();
            }
        }
    }

    /// Keeps what was predicted, and begins the same step of the motor.
    #[inline(never)]
    fn simulated(&mut self) {
        let trial = &mut self.memory.trial;
        if let Some(tuned) = &mut self.report.tuned {
            tuned.predicted = trial.step.response();
            let limit = trial.servo.limit();
            trial.servo.begin(tuned.gains, limit);
        }
        trial.step.begin(trial.counts);
        trial.over = 0;
        // The next phase drives: it waits for a period that begins in time.
        self.work = Work::Fitted;
    }

    /// The next duty of the step; `None` at its end.
    #[inline(never)]
    pub(super) fn closed_loop(&mut self, step: i32) -> Option<i16> {
        let travelled = self.count.wrapping_sub(self.begun_at);
        let trial = &mut self.memory.trial;
        if trial.over > 0 {
            trial.step.see(trial.along(travelled));
        }
        if trial.over > trial.periods {
            return None;
        }
        trial.over += 1;
        let target = Target::Position(trial.target());
        Some(as_duty(trial.servo.next(step, target)))
    }

    /// Keeps how the motor answered.
    pub(super) fn tuned(&mut self) {
        if let Some(tuned) = &mut self.report.tuned {
            tuned.measured = Some(self.memory.trial.step.response());
            if let Some(guard) = &self.guard {
                self.memory.kept = Kept {
                    state: ServoState::Tried,
                    servo: KeptServo {
                        gains: tuned.gains,
                        amplitude: self.report.amplitude,
                        learned: guard.learned(),
                    },
                };
            }
        }
        self.done();
    }

    /// What the guard made of the next duty.
    pub(super) fn servo_acts(&mut self, duty: i16) {
        match self.phase {
            Phase::Follow => self.memory.following.servo.acts(as_part(duty)),
            _ => self.memory.trial.servo.acts(as_part(duty)),
        }
    }
}
