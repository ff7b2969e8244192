//! The servo follows set-points that the host sends.

use super::App;
use super::closed_loop::{OF_LIMITS, as_duty, as_part};
use super::keep::KeptServo;
use crate::board::Board;
use shared::fit::Arithmetic;
use shared::servo::{Servo, Target};
use shared::wire::{Job, SetPoint};

/// A shaft that has not moved for this long, after the last set-point, rests.
const REST_US: u32 = 50_000;
/// One that goes on for longer than this, slowly, will not rest.
const LONGEST_US: u32 = 500_000;
/// What is left to the limit of travel, a part of it.
const MARGIN: u32 = 16;

/// A servo on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Following {
    pub(super) servo: Servo,
    target: Target,
    /// Largest position, counts; none if zero.
    travel: u32,
    /// Counts from where the servo began to where the run did, which is not where a motor ends that was tried before.
    home: Option<i32>,
    /// It is to stop: periods since, and periods at rest.
    stops: Option<(u32, u32)>,
}

impl Following {
    /// Of nothing.
    pub(super) const NONE: Self = Following {
        servo: Servo::IDLE,
        target: Target::Position(0),
        travel: 0,
        home: None,
        stops: None,
    };

    /// At rest where it is.
    #[inline(never)]
    pub(super) fn begin(&mut self, kept: &KeptServo, job: &Job) {
        *self = Self::NONE;
        self.travel = job.limits.travel;
        let limit = as_part(kept.amplitude.min(job.limits.duty));
        self.servo.begin(kept.gains, limit);
        if job.limits.speed > 0 {
            self.servo
                .no_faster_than(OF_LIMITS * f32::from(job.limits.speed));
        }
    }

    /// Takes a set-point.
    pub(super) fn take(&mut self, set_point: SetPoint) {
        match set_point {
            // It stops for good.
            _ if self.stops.is_some() => {}
            SetPoint::Position(counts) => {
                let most = match self.travel {
                    0 => u32::MAX,
                    travel => travel - travel / MARGIN,
                };
                let most = i32::try_from(most).unwrap_or(i32::MAX);
                self.target = Target::Position(counts.clamp(-most, most));
            }
            SetPoint::Speed(speed) => self.target = Target::Speed(speed as f32 * (1.0 / 65_536.0)),
            SetPoint::End => {
                self.target = Target::Speed(0.0);
                self.stops = Some((0, 0));
            }
        }
    }
}

impl<B: Board, S: Arithmetic, const N: usize> App<'_, B, S, N> {
    /// The next duty on the way to the set-point; `None` where it has come to rest after the last one.
    #[inline(never)]
    pub(super) fn follow(&mut self, step: i32) -> Option<i16> {
        let following = &mut self.memory.following;
        if let Some((since, still)) = &mut following.stops {
            *since += 1;
            *still = if step == 0 { *still + 1 } else { 0 };
            if *still > Self::periods(REST_US) || *since > Self::periods(LONGEST_US) {
                return None;
            }
        }
        let begun = self.count.wrapping_sub(step);
        let home = *(following.home).get_or_insert(self.home.wrapping_sub(begun));
        let target = match following.target {
            Target::Position(counts) => Target::Position(counts.saturating_add(home)),
            Target::Speed(speed) => Target::Speed(speed),
        };
        Some(as_duty(following.servo.next(step, target)))
    }
}
