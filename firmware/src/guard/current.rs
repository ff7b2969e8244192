//! The armature current: measured where the board can, else bounded by what the drive and the back-EMF can make of it.
//!
//! The winding's current settles at `(d - e) / r`, all in duties: the drive `d`, the back-EMF `e` and the resistance `r`, the duty that
//! drives a milliampere at rest. A reversal at speed makes it `|d| + |e|`, up to twice that of a locked shaft. The back-EMF is bounded
//! without any constant of the motor: a shaft that was driven by no more than `D` was never faster than where its back-EMF is `D`, so
//! that at a fraction of the highest speed seen it is at most that fraction of `D`.

use super::learned::OfCurrent;
use shared::wire::Limits;

/// Periods over which speed is measured, for coarse encoders.
const SPAN: usize = 16;
/// Periods of the shorter measure, which a motor that is soon fast needs, and the counts in them from which on it tells a speed.
const SHORT: usize = 3;
const TELLS: u32 = 8;

/// Counts over a span, and the most of them so far.
#[derive(Debug, Clone, Copy, Default)]
struct Speed {
    counts: i32,
    fastest: u32,
}

impl Speed {
    fn step(&mut self, newest: i16, oldest: i16) {
        self.counts += i32::from(newest) - i32::from(oldest);
        self.fastest = self.fastest.max(self.counts.unsigned_abs());
    }

    /// True unless the shaft turns with `duty`.
    fn opposes(self, duty: i16) -> bool {
        self.counts.signum() * i32::from(duty.signum()) <= 0
    }

    /// Part of the highest speed, of `strongest`.
    fn part(self, strongest: u16) -> u16 {
        let counts = u64::from(self.counts.unsigned_abs());
        let part = u64::from(strongest) * counts / u64::from(self.fastest.max(1));
        u16::try_from(part).unwrap_or(u16::MAX)
    }
}

/// Tenths of the current's limit that the drive may ask for: what is measured has noise and ripple.
const ASKED: u64 = 9;

/// The current and what is known of the winding.
#[derive(Debug, Clone)]
pub struct Current {
    /// Largest duty, and the one that holds the current at its limit while the shaft rests.
    duty: i16,
    most: i16,
    limit_ma: u32,
    /// Current at full duty and rest, mA; zero if unknown.
    stall_ma: u32,
    full: u16,
    /// Steps and drives of the last span.
    steps: [i16; SPAN],
    drives: [i16; SPAN],
    at: usize,
    long: Speed,
    short: Speed,
    /// Largest duty so far.
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
            duty: limits.duty.max(1),
            most: limits.duty.max(1),
            limit_ma: limit_ma.min(LARGEST_MA),
            stall_ma: limits.stall_ma,
            full: full.max(1),
            steps: [0; SPAN],
            drives: [0; SPAN],
            at: 0,
            long: Speed::default(),
            short: Speed::default(),
            strongest: 0,
            thermal: limits.thermal.max(1),
            heat: 0,
        };
        current.bound();
        current
    }

    /// What the drive has shown.
    pub(super) fn learned(&self) -> OfCurrent {
        OfCurrent {
            stall_ma: self.stall_ma,
            fastest: [self.long.fastest, self.short.fastest],
            strongest: self.strongest,
        }
    }

    /// Takes over what another run showed of the same winding.
    pub(super) fn learn(&mut self, from: &OfCurrent) {
        self.stall_ma = self.stall_ma.max(from.stall_ma);
        [self.long.fastest, self.short.fastest] = from.fastest;
        self.strongest = from.strongest;
        self.bound();
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
        if let Some(stall) = self.at_full(duty, current_ma) {
            self.stall_ma = stall;
            self.bound();
        }
    }

    /// A step to `duty` from rest has driven at most `current_ma`, more than half of what it drives at rest. It is larger than any
    /// before the shaft moved, and so surer: where those were too large by the sensor's error.
    pub fn at_step(&mut self, duty: i16, current_ma: u32) {
        if let Some(stall) = self.at_full(duty, current_ma.saturating_add(current_ma / 2))
            && stall < self.stall_ma
        {
            self.stall_ma = stall;
            self.bound();
        }
    }

    /// The current at full duty and rest.
    fn at_full(&self, duty: i16, current_ma: u32) -> Option<u32> {
        let duty = u64::from(duty.unsigned_abs());
        let stall = (u64::from(current_ma) * u64::from(self.full)).checked_div(duty)?;
        Some(u32::try_from(stall).unwrap_or(u32::MAX)).filter(|stall| *stall > 0)
    }

    fn bound(&mut self) {
        if self.limit_ma == 0 || self.stall_ma == 0 {
            return;
        }
        let asked = u64::from(self.limit_ma) * ASKED / 10;
        let most = asked * u64::from(self.full) / u64::from(self.stall_ma);
        self.most = i16::try_from(most).unwrap_or(i16::MAX).clamp(1, self.duty);
    }

    /// Takes the current that `drive` and the back-EMF have made of a strong drive: no larger resistance lets so much flow.
    pub fn measured(&mut self, drive: i16, current_ma: u32) {
        let made = drive.unsigned_abs().saturating_add(self.back_emf(drive));
        let made = i16::try_from(made).unwrap_or(i16::MAX);
        if let Some(stall) = self.at_full(made, current_ma)
            && self.stall_ma > 0
            && stall > self.stall_ma
        {
            self.stall_ma = stall;
            self.bound();
        }
    }

    /// Follows the shaft and the drive of a period.
    pub fn follow(&mut self, drive: i16, step: i32) {
        let step = step.clamp(i16::MIN.into(), i16::MAX.into()) as i16;
        let before = |span: usize| {
            let index = (self.at + SPAN - span) % SPAN;
            self.steps.get(index).copied().unwrap_or(0)
        };
        let (oldest, old) = (before(SPAN), before(SHORT));
        self.long.step(step, oldest);
        self.short.step(step, old);
        if let (Some(last), Some(held)) =
            (self.steps.get_mut(self.at), self.drives.get_mut(self.at))
        {
            (*last, *held) = (step, drive);
        }
        self.at = (self.at + 1) % SPAN;
        self.strongest = self.strongest.max(drive.unsigned_abs());
    }

    /// Most that the back-EMF can be against `duty`, as a duty; either way for none.
    ///
    /// The long span lags. Where the short one has too few counts, a shaft may have come to turn with any drive of the long one.
    fn back_emf(&self, duty: i16) -> u16 {
        let of = |speed: Speed| {
            if speed.opposes(duty) {
                speed.part(self.strongest)
            } else {
                0
            }
        };
        let recent = if self.short.fastest >= TELLS {
            of(self.short)
        } else {
            let against = |drive: &&i16| i32::from(**drive) * i32::from(duty.signum()) <= 0;
            let drives = self.drives.iter().filter(against);
            drives.map(|drive| drive.unsigned_abs()).max().unwrap_or(0)
        };
        of(self.long).max(recent)
    }

    /// The nearest duty to `duty` that keeps the current within its limit.
    pub fn bounded(&self, duty: i16) -> i16 {
        let most = (i32::from(self.most) - i32::from(self.back_emf(duty))).max(0);
        i32::from(duty).clamp(-most, most) as i16
    }

    /// Most that the current of a period can have been, mA: what is assumed without a sensor. Zero if the resistance is unknown.
    pub fn assumed_ma(&self, drive: i16) -> i64 {
        let duty = u64::from(drive.unsigned_abs()) + u64::from(self.back_emf(drive));
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
