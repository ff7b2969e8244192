//! The guard: looks at every period of a run and says when it must end, and what the drive may be so that it need not.
//!
//! It is pure: it drives nothing and reads nothing.
//!
//! | file | holds |
//! |---|---|
//! | `learned` | what a run has shown of its motor |
//! | `motion` | whether the shaft follows the drive: stall, runaway, dead line, jump |
//! | `response` | how a free shaft answers a strong drive |
//! | `current` | the armature current, measured or bounded; the winding's heat |

mod current;
mod learned;
mod motion;
mod response;

use crate::phase::Fault;
use current::{Current, LARGEST_MA};
pub use learned::Learned;
pub use motion::{LONGEST_WINDOW_MS, SHORTEST_WINDOW_MS};
use motion::{Motion, Shown};
use shared::scalar::Real;
use shared::wire::{Job, Limits};

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

/// What a board measures in a period, beside the encoder.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Measured {
    /// Armature current, mA, if the board measures it.
    pub current_ma: Option<i32>,
    /// Supply voltage, mV, if the board measures it.
    pub supply_mv: Option<u16>,
}

/// What a guard must know of the board.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rating {
    /// Length of a control period, µs.
    pub period_us: u32,
    /// See [`Board::full`](crate::board::Board::full).
    pub full: u16,
    /// See [`Board::CURRENT_LIMIT_MA`](crate::board::Board::CURRENT_LIMIT_MA).
    pub current_ma: u32,
    /// See [`Board::CURRENT_RESOLUTION_MA`](crate::board::Board::CURRENT_RESOLUTION_MA).
    pub resolution_ma: u16,
}

/// State of a run against its limits.
#[derive(Debug, Clone)]
pub struct Guard {
    limits: Limits,
    supply_mv: u32,
    resolution_ma: u16,
    origin: i32,
    last: i32,
    periods: u32,
    motion: Motion,
    current: Current,
    /// Largest current in the probe's last step, mA.
    step_ma: u32,
    /// Periods of strong drive without a current, and whether the shaft gained speed in them.
    quiet: u32,
    gained: bool,
}

impl Guard {
    /// At the start of a run, with the shaft at `count`.
    pub fn new(job: &Job, rating: Rating, count: i32) -> Self {
        let limits = job.limits;
        Guard {
            limits,
            supply_mv: job.supply_mv,
            resolution_ma: rating.resolution_ma,
            origin: count,
            last: count,
            periods: 0,
            motion: Motion::new(
                job.counts_per_rev,
                limits.travel,
                rating.period_us,
                rating.full,
            ),
            current: Current::new(&limits, rating.full, rating.current_ma),
            step_ma: 0,
            quiet: 0,
            gained: false,
        }
    }

    /// What it has learned of the motor.
    pub fn learned(&self) -> Learned {
        Learned {
            motion: self.motion.learned(),
            current: self.current.learned(),
            step_ma: self.step_ma,
        }
    }

    /// Takes over what another run showed of the same motor.
    pub fn learn(&mut self, from: &Learned) {
        self.motion.learn(&from.motion);
        self.current.learn(&from.current);
        self.step_ma = from.step_ma;
    }

    /// Largest duty of a probe: half the supply where nothing is known that bounds the current.
    pub fn probe_to(&self, full: u16, senses_current: bool) -> i16 {
        let known = senses_current || self.current.knows_resistance();
        let half = i16::try_from(full / 2).unwrap_or(i16::MAX);
        let most = if known { i16::MAX } else { half };
        most.min(self.limits.duty)
    }

    /// Looks at a period of the probe, in which the shaft has `moved` so far and `duty` is driven; true once that is a motion.
    ///
    /// # Errors
    /// A shaft that moves against the drive.
    pub fn probe(
        &mut self,
        duty: i16,
        moved: i32,
        first_step: bool,
        current_ma: Option<i32>,
    ) -> Result<bool, Tripped> {
        if first_step {
            self.motion.at_rest();
        } else {
            self.motion.probing(duty);
        }
        if let Some(current) = current_ma
            && moved == 0
            && current.unsigned_abs() >= CLEAR * u32::from(self.resolution_ma)
        {
            self.current.at_rest(duty, current.unsigned_abs());
        }
        let motion = self.motion.motion();
        if moved <= -motion {
            return Err(Tripped {
                fault: Fault::Runaway,
                seen: moved,
                limit: -motion,
            });
        }
        Ok(moved >= motion)
    }

    /// Looks at a period of the probe's last step, in which `duty` has moved the shaft by `moved`; true once that is a motion, which
    /// shows what such a drive does.
    pub fn probe_step(&mut self, duty: i16, moved: i32, current_ma: Option<i32>) -> bool {
        self.motion.stepped();
        let current = current_ma.map_or(0, i32::unsigned_abs);
        self.step_ma = self.step_ma.max(current);
        let done = moved >= self.motion.motion();
        if done {
            self.motion.expect(duty);
            if self.step_ma >= CLEAR * u32::from(self.resolution_ma) {
                self.current.at_step(duty, self.step_ma);
            }
        }
        done
    }

    /// The run goes on after a pause in which the shaft was not watched.
    pub fn resume(&mut self, count: i32) {
        self.last = count;
        self.motion.pause();
    }

    /// The nearest duty that keeps the current within its limit.
    pub fn bounded(&self, duty: i16) -> i16 {
        self.current.bounded(duty)
    }

    /// Looks at a period that has passed: the duty held during it (none with an open bridge), the count at its end, and what was
    /// measured there.
    ///
    /// # Errors
    /// The limit that was broken.
    pub fn look(
        &mut self,
        duty: Option<i16>,
        count: i32,
        measured: Measured,
    ) -> Result<(), Tripped> {
        let limits = self.limits;
        let step = count.wrapping_sub(self.last);
        self.last = count;
        self.periods = self.periods.saturating_add(1);
        let drive = duty.unwrap_or(0);
        self.current.follow(drive, step);

        let current = match (measured.current_ma, duty) {
            (Some(current), _) => i64::from(current).abs(),
            (None, Some(drive)) => self.current.assumed_ma(drive),
            (None, None) => 0,
        };
        let travel = count.wrapping_sub(self.origin).unsigned_abs();
        check(Fault::TimeUp, self.periods.into(), limits.time)?;
        check(Fault::Overtravel, travel.into(), limits.travel)?;
        check(
            Fault::Overspeed,
            step.unsigned_abs().into(),
            limits.speed.into(),
        )?;
        if measured.current_ma.is_some() {
            if self.motion.is_strong(drive) {
                let current = u32::try_from(current).unwrap_or(u32::MAX);
                self.current.measured(drive, current);
            }
            // An eighth more than the limit: the drive is held below it, and a reading has noise.
            let limit = self.current.limit_ma();
            check(Fault::Overcurrent, current, limit.saturating_add(limit / 8))?;
        }
        self.supply(measured.supply_mv)?;
        let heat = self.current.warm(current);
        let continuous = i64::from(limits.continuous_ma.min(LARGEST_MA));
        if continuous > 0 && heat > continuous * continuous {
            return Err(Tripped {
                fault: Fault::Overheated,
                seen: Real::sqrt(heat as f32) as i32,
                limit: clamped(continuous),
            });
        }
        let shown = self.motion.look(drive, step)?;
        self.follows(shown, duty, measured.current_ma)
    }

    /// A supply that the motor's braking has raised, or that breaks down.
    fn supply(&self, measured_mv: Option<u16>) -> Result<(), Tripped> {
        let (Some(seen), nominal @ 1..) = (measured_mv, self.supply_mv) else {
            return Ok(());
        };
        let tripped = |fault, limit: u32| Tripped {
            fault,
            seen: seen.into(),
            limit: clamped(limit.into()),
        };
        let highest = nominal.saturating_add(nominal / SUPPLY_ABOVE);
        let lowest = nominal - nominal / SUPPLY_BELOW;
        if u32::from(seen) > highest {
            return Err(tripped(Fault::Overvoltage, highest));
        }
        if u32::from(seen) < lowest {
            return Err(tripped(Fault::Undervoltage, lowest));
        }
        Ok(())
    }

    /// A reading that cannot be told from none.
    fn is_quiet(&self, current_ma: i32) -> bool {
        2 * current_ma.unsigned_abs() <= 3 * u32::from(self.resolution_ma)
    }

    /// A strong drive moves the shaft, and takes current to do so.
    fn follows(
        &mut self,
        shown: Option<Shown>,
        duty: Option<i16>,
        current_ma: Option<i32>,
    ) -> Result<(), Tripped> {
        let quiet = match current_ma {
            Some(current) => self.is_quiet(current),
            None => false,
        };
        if !quiet {
            (self.quiet, self.gained) = (0, false);
        } else if duty.is_some_and(|duty| self.motion.is_strong(duty)) {
            self.quiet = self.quiet.saturating_add(1);
        }
        // All the while without a current.
        self.gained |= matches!(shown, Some(Shown::Gains(periods)) if self.quiet >= periods);
        let window = self.motion.window();
        if quiet && self.quiet > window && self.gained {
            return Err(Tripped::by(Fault::CurrentSensor));
        }
        match shown {
            Some(Shown::Rest) if quiet && self.quiet > window / 2 => {
                Err(Tripped::by(Fault::MotorLead))
            }
            Some(Shown::Rest) => Err(Tripped::by(Fault::Stall)),
            // It coasts, however long that takes: what drives it would show.
            _ if quiet && self.quiet > COASTS * window => Err(Tripped::by(Fault::MotorLead)),
            _ => Ok(()),
        }
    }

    /// The fault of a probe that has ended without a motion.
    pub fn unmoved(&self, current_ma: Option<i32>) -> Fault {
        match current_ma {
            Some(current) if self.is_quiet(current) => Fault::MotorLead,
            _ => Fault::Stall,
        }
    }
}

/// A supply may rise by a quarter, and fall by a third.
const SUPPLY_ABOVE: u32 = 4;
const SUPPLY_BELOW: u32 = 3;
/// Steps of the current's measurement from which on a resistance can be taken from it.
const CLEAR: u32 = 8;
/// Windows of strong drive without a current after which no motor can be connected.
const COASTS: u32 = 8;

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
mod tests;
