//! The guard: looks at every period of a run and says when it must end.
//!
//! It is pure: it drives nothing and reads nothing. What it recognises, it recognises within [`REACTION_US`].

use crate::phase::Fault;
use shared::scalar::Real;
use shared::wire::Limits;

/// Longest time for which a stall or a runaway may last.
pub const REACTION_US: u32 = 20_000;

/// A limit that was broken, and by what.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Tripped {
    /// Which one.
    pub fault: Fault,
    /// The number that broke it, in the limit's unit.
    pub seen: i32,
    /// The limit.
    pub limit: i32,
}

impl Tripped {
    /// A fault without a number.
    pub fn by(fault: Fault) -> Self {
        Tripped {
            fault,
            seen: 0,
            limit: 0,
        }
    }
}

/// State of a run against its limits.
#[derive(Debug, Clone)]
pub struct Guard {
    limits: Limits,
    /// Duty that is the whole supply.
    full: u16,
    /// Periods in half the reaction time.
    half: u32,
    origin: i32,
    last: i32,
    periods: u32,
    /// A drive as strong as this moves any free motor.
    strong: i16,
    /// Periods for which a strong drive has kept its sign, and since which the shaft has not moved.
    driven: u32,
    still: u32,
    forward: bool,
    /// Travel with the drive in the present and the last half of the reaction time.
    travel: [i32; 2],
    /// Low-passed square of the current, mA².
    heat: i64,
}

impl Guard {
    /// At the start of a run, with the shaft at `count`, on a board whose [`full`](crate::board::Board::full) duty this is.
    pub fn new(limits: Limits, period_us: u32, full: u16, count: i32) -> Self {
        Guard {
            limits,
            full: full.max(1),
            half: (REACTION_US / 2 / period_us.max(1)).max(2),
            origin: count,
            last: count,
            periods: 0,
            strong: i16::MAX,
            driven: 0,
            still: 0,
            forward: true,
            travel: [0; 2],
            heat: 0,
        }
    }

    /// From now on a drive of `duty` is known to move the shaft well.
    pub fn expect_motion(&mut self, duty: i16) {
        self.strong = duty;
    }

    /// Looks at a period that has passed: the duty held during it (none with an open bridge), the count at its end, and
    /// the current if the board measures it.
    ///
    /// # Errors
    /// The limit that was broken.
    pub fn look(
        &mut self,
        duty: Option<i16>,
        count: i32,
        current_ma: Option<i32>,
    ) -> Result<(), Tripped> {
        let limits = self.limits;
        let step = count.wrapping_sub(self.last);
        self.last = count;
        self.periods = self.periods.saturating_add(1);
        let drive = duty.unwrap_or(0);
        self.follow(drive, step);

        let current = current_ma.map_or_else(
            || {
                let product = u64::from(limits.stall_ma) * u64::from(drive.unsigned_abs());
                (product / u64::from(self.full)).cast_signed()
            },
            |current| i64::from(current).abs(),
        );
        let travel = count.wrapping_sub(self.origin).unsigned_abs();
        check(Fault::TimeUp, self.periods.into(), limits.time)?;
        check(Fault::Overtravel, travel.into(), limits.travel)?;
        check(
            Fault::Overspeed,
            step.unsigned_abs().into(),
            limits.speed.into(),
        )?;
        check(Fault::Overcurrent, current, limits.current_ma)?;
        self.warm(current);
        let continuous = i64::from(limits.continuous_ma);
        if continuous > 0 && self.heat > continuous * continuous {
            return Err(Tripped {
                fault: Fault::Overheated,
                seen: Real::sqrt(self.heat as f32) as i32,
                limit: clamped(continuous),
            });
        }
        if self.still >= 2 * self.half {
            return Err(Tripped {
                fault: Fault::Stall,
                seen: 0,
                limit: 1,
            });
        }
        let [now, before] = self.travel;
        // Against the drive, and no slower than before: braking looks different.
        let against = now <= -RUNAWAY_COUNTS && (now <= before || before > 0);
        if self.driven >= 2 * self.half && self.driven.is_multiple_of(self.half) && against {
            return Err(Tripped {
                fault: Fault::Runaway,
                seen: now,
                limit: -RUNAWAY_COUNTS,
            });
        }
        Ok(())
    }

    /// Tracks the shaft's response to a strong drive.
    fn follow(&mut self, drive: i16, step: i32) {
        let forward = drive >= 0;
        let weak = drive.unsigned_abs() < self.strong.unsigned_abs();
        if weak || forward != self.forward {
            self.forward = forward;
            self.driven = 0;
            self.still = 0;
            self.travel = [0; 2];
        }
        if weak {
            return;
        }
        self.still = if step == 0 { self.still + 1 } else { 0 };
        if self.driven.is_multiple_of(self.half) {
            self.travel = [0, self.travel[0]];
        }
        self.driven += 1;
        self.travel[0] =
            self.travel[0].saturating_add(if forward { step } else { step.saturating_neg() });
    }

    /// The winding as one heat store: it forgets with its time constant.
    fn warm(&mut self, current_ma: i64) {
        let square = current_ma * current_ma;
        let towards = square - self.heat;
        self.heat += towards / i64::from(self.limits.thermal.max(1));
    }
}

/// Counts against the drive within half the reaction time that cannot be jitter of the encoder.
const RUNAWAY_COUNTS: i32 = 3;

fn clamped(x: i64) -> i32 {
    x.clamp(i32::MIN.into(), i32::MAX.into()) as i32
}

/// Zero is no limit.
fn check(fault: Fault, seen: i64, limit: u32) -> Result<(), Tripped> {
    if limit > 0 && seen > i64::from(limit) {
        return Err(Tripped {
            fault,
            seen: clamped(seen),
            limit: clamped(limit.into()),
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PERIOD_US: u32 = 1000;
    const FREE: Limits = Limits {
        thermal: 1000,
        time: 1_000_000,
        ..Limits::NONE
    };

    /// Periods until the guard trips, with the fault; the motion and the current are given by the period.
    fn trip(
        limits: Limits,
        duty: impl Fn(u32) -> Option<i16>,
        step: impl Fn(u32) -> i32,
        current_ma: impl Fn(u32) -> Option<i32>,
    ) -> Option<(u32, Fault)> {
        let mut guard = Guard::new(limits, PERIOD_US, 32_768, -7);
        guard.expect_motion(8000);
        let mut count = -7i32;
        (0..5000).find_map(|k| {
            count = count.wrapping_add(step(k));
            let looked = guard.look(duty(k), count, current_ma(k));
            looked.err().map(|tripped| (k + 1, tripped.fault))
        })
    }

    #[test]
    fn a_motor_that_obeys_trips_nothing() {
        // Accelerates, is reversed and brakes, coasts, creeps under a weak drive.
        let duty = |k: u32| match k / 500 % 4 {
            0 => Some(20_000),
            1 => Some(-20_000),
            2 => None,
            _ => Some(3_000),
        };
        let speed = |k: u32| match k / 500 % 4 {
            0 => 1 + (k % 500) as i32 / 5,
            1 => 100 - (k % 500) as i32,
            2 => (500 - (k % 500) as i32) / -5,
            _ => 0,
        };
        assert_eq!(trip(FREE, duty, speed, |_| None), None);
    }

    #[test]
    fn every_limit_trips_just_beyond_it() {
        let steady = |_| Some(20_000);
        let one = |_| 1;
        let none = |_| None;
        let limits = |change: fn(&mut Limits)| {
            let mut limits = FREE;
            change(&mut limits);
            limits
        };
        let travel = limits(|limits| limits.travel = 100);
        assert_eq!(
            trip(travel, steady, one, none),
            Some((101, Fault::Overtravel))
        );
        assert_eq!(
            trip(travel, |_| Some(-20_000), |_| -1, none),
            Some((101, Fault::Overtravel))
        );
        let speed = limits(|limits| limits.speed = 50);
        assert_eq!(
            trip(speed, steady, |k| k as i32, none),
            Some((52, Fault::Overspeed))
        );
        let time = limits(|limits| limits.time = 300);
        assert_eq!(trip(time, steady, one, none), Some((301, Fault::TimeUp)));
        let current = limits(|limits| limits.current_ma = 900);
        assert_eq!(
            trip(current, steady, one, |k| Some(-(10 * k as i32))),
            Some((92, Fault::Overcurrent))
        );
        let assumed = limits(|limits| (limits.current_ma, limits.stall_ma) = (900, 2000));
        assert_eq!(
            trip(assumed, steady, one, none),
            Some((1, Fault::Overcurrent))
        );
    }

    #[test]
    fn the_winding_bears_a_peak_for_a_while_and_its_continuous_current_forever() {
        let mut limits = FREE;
        (limits.continuous_ma, limits.thermal) = (1000, 1000);
        let steady = |_| Some(20_000);
        assert_eq!(trip(limits, steady, |_| 1, |_| Some(999)), None);
        // I² of a first-order store reaches the limit after τ·ln(4/3).
        let (periods, fault) = trip(limits, steady, |_| 1, |_| Some(2000)).unwrap();
        assert_eq!(fault, Fault::Overheated);
        assert!((280..=295).contains(&periods), "{periods}");
    }

    #[test]
    fn a_stall_and_a_runaway_are_recognised_within_the_reaction_time() {
        let reaction = REACTION_US / PERIOD_US;
        let steady = |_| Some(-20_000);
        assert_eq!(
            trip(FREE, steady, |_| 0, |_| None),
            Some((reaction, Fault::Stall))
        );
        // The encoder counts the wrong way: the motor accelerates backwards, or is at speed already.
        for speed in [|k: u32| 1 + k as i32 / 2, |_| 30] {
            let (periods, fault) = trip(FREE, steady, speed, |_| None).unwrap();
            assert_eq!(fault, Fault::Runaway);
            assert!(periods <= reaction + 1, "{periods}");
        }
        // It fails while the motor runs.
        let fails = |k: u32| if k < 1000 { -30 } else { 30 };
        let (periods, fault) = trip(FREE, steady, fails, |_| None).unwrap();
        assert_eq!(fault, Fault::Runaway);
        assert!(periods <= 1000 + reaction, "{periods}");
    }
}
