//! What is kept of a tuning, also over a power cut, and whether the motor is still that one.

use super::{App, Work};
use crate::board::Board;
use crate::board::store::LONGEST;
use crate::guard::{Learned, Tripped};
use crate::phase::Fault;
use serde::{Deserialize, Serialize};
use shared::fit::{Arithmetic, Predicted, Predictors};
use shared::servo::Gains;
use shared::wire::{Job, Kind, Refusal, ServoState};

/// Under which number it is saved. Another for whatever an older firmware would misread.
const KEY: u8 = 1;
/// The host is told before the device falls silent: the link sends for this long.
pub(super) const TOLD_US: u32 = 20_000;
/// By which part gain and acceleration may be others than when the servo was tuned: a loop with both poles real bears it, and a battery that
/// sinks by a fifth or a winding that warms by 60 K is within.
const MOST_CHANGED: f32 = 0.3;

/// The motor is judged by what its error grows in this time. (Of 30 motors of twice the inertia 2 passed with 50 ms, 1 with 20 ms and none with
/// 10 ms, which refused one of 40 that had not changed.)
const WINDOW_US: u32 = 20_000;

/// What was tuned, if anything was: gains, the largest duty that they were tuned for, and what the guards have learned of the motor.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kept {
    pub(super) state: ServoState,
    pub(super) servo: KeptServo,
}

/// A servo that was tuned.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(super) struct KeptServo {
    pub(super) gains: Gains,
    pub(super) amplitude: i16,
    pub(super) learned: Learned,
}

impl Kept {
    /// Nothing: all zeros.
    pub(super) const NOTHING: Self = Kept {
        state: ServoState::None,
        servo: KeptServo {
            gains: Gains::NONE,
            amplitude: 0,
            learned: Learned::NOTHING,
        },
    };
}

/// What is saved: the motor that it was tuned for as well.
type Saved = (KeptServo, Predictors);

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    /// Takes over what was kept, if anything was.
    pub(super) fn recall(&mut self) {
        if B::SAVES
            && let Some((servo, _)) = self.saved()
        {
            self.memory.kept = Kept {
                state: ServoState::Untried,
                servo,
            };
        }
    }

    #[inline(never)]
    fn saved(&mut self) -> Option<Saved> {
        let mut bytes = [0; LONGEST];
        let length = self.board.load(KEY, &mut bytes)?;
        postcard::from_bytes(bytes.get(..length)?).ok()
    }

    /// Whether this run has tuned a servo that the board can keep.
    pub(super) fn is_to_be_kept(&self) -> bool {
        let tuned = self.report.tuned.as_ref();
        B::SAVES && tuned.is_some_and(|tuned| tuned.measured.is_some())
    }

    /// Saves it, once the host was told that the device will be silent.
    #[inline(never)]
    pub(super) fn save_servo(&mut self, left: u32) {
        if left > 0 || !self.memory.outbox.is_empty() {
            self.work = Work::Keep(left.saturating_sub(1));
            return;
        }
        let fitted = self.recording.trace().len();
        let saved: Saved = (self.memory.kept.servo, self.memory.fit.predictors(fitted));
        let mut bytes = [0; LONGEST];
        let kept =
            postcard::to_slice(&saved, &mut bytes).is_ok_and(|bytes| self.board.save(KEY, bytes));
        if let Some(tuned) = &mut self.report.tuned {
            tuned.kept = kept;
        }
        self.done();
    }

    /// Whether there is a servo for a run that follows.
    ///
    /// # Errors
    /// There is none, or the job has no verification to try it in.
    pub(super) fn has_servo(&self, job: &Job) -> Result<(), Refusal> {
        match (job.kind, self.memory.kept.state) {
            (Kind::Follow, ServoState::None) => Err(Refusal::NotTuned),
            (Kind::Follow, ServoState::Untried) if job.verify == 0 => Err(Refusal::BadJob),
            _ => Ok(()),
        }
    }

    /// Whether the run begins with a look at the motor.
    pub(super) fn is_to_be_tried(&self, job: &Job) -> bool {
        B::SAVES && job.kind == Kind::Follow && self.memory.kept.state == ServoState::Untried
    }

    /// Builds the motor that the servo was tuned for. Returns false if it is not there any more.
    #[inline(never)]
    pub(super) fn recall_motor(&mut self, job: &Job) -> bool {
        let saved = self.saved();
        self.predicts = saved.is_some_and(|(_, predictors)| {
            let window = Self::periods(WINDOW_US);
            let fit = &mut self.memory.fit;
            fit.predict_by(&predictors, job.verify, window)
        });
        self.predicts
    }

    /// Looks at how the motor of the kept servo predicted.
    pub(super) fn tried(&mut self, predicted: &Predicted) {
        let changes = [predicted.gain, predicted.gain - predicted.time_constant];
        let most = changes.iter().fold(0.0f32, |most, change| {
            // Not a number where nothing could be seen.
            if change.abs() <= most {
                most
            } else {
                change.abs()
            }
        });
        if most <= MOST_CHANGED && predicted.beats_persistence() {
            self.memory.kept.state = ServoState::Tried;
            return self.done();
        }
        self.trip(Tripped {
            fault: Fault::OtherMotor,
            seen: (100.0 * most) as i32,
            limit: (100.0 * MOST_CHANGED) as i32,
        });
    }
}
