//! How a free shaft answers a strong drive, and what a shaft is that does not.

use serde::{Deserialize, Serialize};

/// Travel that a shaft at rest may show: its encoder stands on an edge, and one count is quantisation.
pub const REST_COUNTS: i32 = 2;
/// Travel that shows that a shaft is free, counts.
const FREE_COUNTS: i64 = 3 * REST_COUNTS as i64;

/// The least acceleration by a strong drive: half of what the probe's last step showed.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
pub struct Acceleration {
    /// Travel of that step, counts.
    pub motion: i64,
    /// Its time, periods.
    pub time: i64,
}

impl Acceleration {
    /// Periods after which it, times the time squared, is this many counts.
    fn periods(self, counts: i64) -> u32 {
        let square = counts * self.time * self.time / self.motion.max(1);
        u32::try_from(square).unwrap_or(u32::MAX).isqrt() + 1
    }

    /// Least speed gained in so many periods, as travel of the second half less that of the first.
    pub fn gain(self, periods: u32) -> i64 {
        let periods = i64::from(periods);
        self.motion * periods * periods / (4 * (self.time * self.time).max(1))
    }
}

/// Consecutive periods of strong drive one way, in steps with the drive.
#[derive(Debug, Clone, Default)]
pub struct Stretch {
    /// Their number.
    pub periods: u32,
    /// Their travel.
    pub travel: i64,
    /// Sum of the steps, each times its index.
    moment: i64,
}

impl Stretch {
    /// Takes a step.
    pub fn step(&mut self, step: i32) {
        self.travel += i64::from(step);
        self.moment += i64::from(step) * i64::from(self.periods);
        self.periods += 1;
    }

    /// Speed gained, as travel in the second half less that in the first, of the straight line through the steps.
    pub fn gain(&self) -> i64 {
        let periods = i64::from(self.periods.max(1));
        (6 * self.moment - 3 * (periods - 1) * self.travel) / (2 * periods)
    }
}

/// A shaft that stands, against the least that a free one would travel.
#[derive(Debug, Clone, Default)]
pub struct Rest {
    /// Periods of strong drive one way after which any free shaft has moved, whatever its speed was: where it turns round it shows the
    /// least, an eighth of the acceleration by the time squared. Zero while that is unknown.
    shown: u32,
    /// Least periods that must show it.
    enough: u32,
    /// Periods of the present drive, of drives that showed, and the encoder's position and extremes, since the shaft moved.
    driven: u32,
    showed: u32,
    seen: i32,
    extremes: (i32, i32),
}

impl Rest {
    /// Of a shaft with this least acceleration.
    pub fn of(acceleration: Acceleration, enough: u32) -> Self {
        Rest {
            shown: acceleration.periods(8 * FREE_COUNTS),
            enough,
            ..Rest::default()
        }
    }

    /// Looks at the step of a period; true if the shaft stands.
    pub fn look(&mut self, strong: bool, reversed: bool, step: i32) -> bool {
        self.seen = self.seen.saturating_add(step);
        let (lowest, highest) = self.extremes;
        self.extremes = (lowest.min(self.seen), highest.max(self.seen));
        if self.extremes.1.saturating_sub(self.extremes.0) > REST_COUNTS {
            (self.seen, self.extremes) = (0, (0, 0));
            (self.driven, self.showed) = (0, 0);
            return false;
        }
        if !strong || reversed {
            self.driven = 0;
        }
        if !strong || self.shown == 0 {
            return false;
        }
        self.driven += 1;
        if self.driven == self.shown {
            self.showed += self.shown;
        } else if self.driven > self.shown {
            self.showed += 1;
        }
        self.showed >= self.enough.max(self.shown)
    }
}
