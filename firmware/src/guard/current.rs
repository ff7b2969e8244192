//! The armature current: measured where the board can, else bounded by what the drive and the back-EMF can make of it.
//!
//! The winding's current settles at `(d - e) / r`, all in duties: the drive `d`, the back-EMF `e` and the resistance `r`, the duty that
//! drives a milliampere at rest. A reversal at speed makes it `|d| + |e|`, up to twice that of a locked shaft. The back-EMF is bounded
//! without any constant of the motor: a shaft that was driven by no more than `D` was never faster than where its back-EMF is `D`, so
//! that at a fraction of the highest speed seen it is at most that fraction of `D`.

use shared::wire::Limits;

/// Periods over which speed is measured, for coarse encoders.
const SPAN: usize = 16;
/// Part of the current's limit that the drive may ask for: what is measured has noise and ripple.
const ASKED: u32 = 9;
const OF: u32 = 10;

/// The current and what is known of the winding.
#[derive(Debug, Clone)]
pub struct Current {
    /// Duty that holds the current at its limit while the shaft rests.
    most: i16,
    limit_ma: u32,
    /// Current at full duty and rest, mA; zero if unknown.
    stall_ma: u32,
    full: u16,
    steps: [i16; SPAN],
    at: usize,
    /// Counts over the span; the most of them so far, and the largest duty so far.
    speed: i32,
    fastest: u32,
    strongest: u16,
    thermal: u32,
    /// Low-passed square of the current, mA².
    heat: i64,
}

impl Current {
    /// With the run's limits on a board with this [`full`](crate::board::Board::full) duty, whose bridge bears `rated_ma` (zero if it
    /// protects itself).
    pub fn new(limits: &Limits, full: u16, rated_ma: u32) -> Self {
        let limit_ma = match (limits.current_ma, rated_ma) {
            (0, rated) => rated,
            (limit, 0) => limit,
            (limit, rated) => limit.min(rated),
        };
        let mut current = Current {
            most: limits.duty.max(1),
            limit_ma: limit_ma.min(LARGEST_MA),
            stall_ma: limits.stall_ma,
            full: full.max(1),
            steps: [0; SPAN],
            at: 0,
            speed: 0,
            fastest: 0,
            strongest: 0,
            thermal: limits.thermal.max(1),
            heat: 0,
        };
        if limits.stall_ma > 0 {
            current.bound(full, limits.stall_ma);
        }
        current
    }

    /// Limit of the current, mA; zero for none.
    pub fn limit_ma(&self) -> u32 {
        self.limit_ma
    }

    /// True if the drive is bounded by a current, not only by a duty.
    pub fn knows_resistance(&self) -> bool {
        self.stall_ma > 0
    }

    /// The shaft rests and `duty` drives `current_ma`: this shows the resistance.
    pub fn at_rest(&mut self, duty: i16, current_ma: u32) {
        if current_ma == 0 || duty == 0 {
            return;
        }
        let stall = u64::from(current_ma) * u64::from(self.full) / u64::from(duty.unsigned_abs());
        self.stall_ma = u32::try_from(stall).unwrap_or(u32::MAX).max(1);
        self.bound(duty.unsigned_abs(), current_ma);
    }

    fn bound(&mut self, duty: u16, current_ma: u32) {
        if self.limit_ma == 0 {
            return;
        }
        let asked = u64::from(self.limit_ma / OF * ASKED);
        let most = asked * u64::from(duty) / u64::from(current_ma.max(1));
        self.most = self
            .most
            .min(i16::try_from(most).unwrap_or(i16::MAX))
            .max(1);
    }

    /// Follows the shaft and the drive of a period.
    pub fn follow(&mut self, drive: i16, step: i32) {
        let step = step.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        if let Some(oldest) = self.steps.get_mut(self.at) {
            self.speed += i32::from(step) - i32::from(*oldest);
            *oldest = step;
        }
        self.at = (self.at + 1) % SPAN;
        self.fastest = self.fastest.max(self.speed.unsigned_abs());
        self.strongest = self.strongest.max(drive.unsigned_abs());
    }

    /// Most that the back-EMF can be, as a duty.
    fn back_emf(&self) -> u16 {
        let speed = u64::from(self.speed.unsigned_abs());
        let bound = u64::from(self.strongest) * speed / u64::from(self.fastest.max(1));
        u16::try_from(bound).unwrap_or(u16::MAX)
    }

    /// Against the motion.
    fn opposes(&self, duty: i16) -> bool {
        self.speed.signum() * i32::from(duty.signum()) < 0
    }

    /// The nearest duty to `duty` that keeps the current within its limit.
    pub fn bounded(&self, duty: i16) -> i16 {
        let mut most = i32::from(self.most);
        if self.opposes(duty) {
            most = (most - i32::from(self.back_emf())).max(0);
        }
        i32::from(duty).clamp(-most, most) as i16
    }

    /// Most that the current of a period can have been, mA: what is assumed without a sensor. Zero if the resistance is unknown.
    pub fn assumed_ma(&self, drive: i16) -> i64 {
        let mut duty = u64::from(drive.unsigned_abs());
        if self.opposes(drive) || drive == 0 {
            duty += u64::from(self.back_emf());
        }
        let current = u64::from(self.stall_ma) * duty / u64::from(self.full);
        i64::try_from(current).unwrap_or(i64::MAX)
    }

    /// Takes a period's current into the winding's heat, one store that forgets with its time constant; gives its square, mA².
    pub fn warm(&mut self, current_ma: i64) -> i64 {
        let current = current_ma.clamp(0, LARGEST_MA.into());
        self.heat += (current * current - self.heat) / i64::from(self.thermal);
        self.heat
    }
}

/// Largest current that is told apart, mA: its square fits into 64 bits.
pub const LARGEST_MA: u32 = i32::MAX as u32;
