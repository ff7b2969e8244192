//! Whether the shaft follows the drive, judged in travel and time.
//!
//! What a motor can do in a time depends on its inertia and on the encoder's resolution, neither of which is known beforehand. The
//! probe shows it: once the drive is known that just moves the shaft, a step of twice that moves it some travel in some time. Half of
//! that acceleration is the least that any strong drive does, also against the shaft's motion. A shaft that stays where it is though
//! it would have had to turn round stands; one that turns against strong drives for three times that time, the *window*, and does not
//! lose speed by a quarter of it, has a reversed encoder.

use super::Tripped;
use super::learned::OfMotion;
use super::response::{Acceleration, REST_COUNTS, Rest, Stretch};
use crate::phase::Fault;

/// Shortest window, ms.
pub const SHORTEST_WINDOW_MS: u32 = 50;
/// Longest window, ms.
pub const LONGEST_WINDOW_MS: u32 = 1_500;

/// Loss of speed that a free shaft must have had for a reversed encoder to be told from it, counts.
const AGAINST_COUNTS: i64 = 8;
/// Least travel that the probe takes for motion, counts.
const LEAST_MOTION: u32 = 8;
/// The probe takes this part of a revolution for motion: more than most gears have backlash.
const MOTION_PART: u32 = 64;
/// Steps of one count to and fro, in a row, that no turning shaft shows.
const TOGGLES: u32 = 16;
/// As many in the first, weakest step of the probe show that the encoder does so at rest.
const DITHER: u32 = 8;
/// Largest change of the travel of a period, as a part of a revolution: 500 rad/s more in a millisecond, which is beyond any motor.
const JUMP_PART: u32 = 12;
/// And this many counts more, for coarse encoders.
const JUMP_COUNTS: i32 = 8;

/// What the encoder says against what is driven.
#[derive(Debug, Clone)]
pub struct Motion {
    /// Counts that are a motion, see [`motion`](Self::motion).
    motion: i32,
    /// Largest change of the travel of a period; zero for any.
    jump: i32,
    /// Travel of the last period; none after a pause.
    last_step: Option<i32>,
    /// Periods of the probe's last step.
    stepped: u32,
    shortest: u32,
    longest: u32,
    /// Periods in which the shaft must have followed.
    window: u32,
    /// Periods of strong drive against the motion; speed lost in them, and the least that a free shaft would have lost: travel of the
    /// second half less that of the first.
    against: u32,
    lost: i64,
    least: i64,
    /// A drive as strong as this moves any free motor; none is before the probe has shown which.
    strong: i16,
    /// A drive as strong as this turns a motor that has an encoder with one line.
    turning: i16,
    forward: bool,
    stretch: Stretch,
    rest: Rest,
    acceleration: Acceleration,
    /// Sign of the last step of one count, and how often the next one was against the one before.
    toggle: i32,
    toggles: u32,
    /// The encoder toggles at rest.
    dithers: bool,
}

/// What periods of strong drive show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shown {
    /// The shaft stands, where any would have moved.
    Rest,
    /// It has gained speed with the drive in the last of them, so many.
    Gains(u32),
}

impl Motion {
    /// For a run with `counts_per_rev` counts a revolution (zero if unknown), a limit of its travel (zero for none) and a board whose
    /// [`full`](crate::board::Board::full) duty this is.
    pub fn new(counts_per_rev: u32, travel: u32, period_us: u32, full: u16) -> Self {
        let periods = |ms: u32| (ms * 1000 / period_us.max(1)).max(4);
        let mut motion = LEAST_MOTION.max(counts_per_rev / MOTION_PART);
        if travel > 0 {
            motion = motion.min(travel / 2).max(4);
        }
        let jump = match counts_per_rev {
            0 => 0,
            counts => clamped(counts / JUMP_PART).saturating_add(JUMP_COUNTS),
        };
        Motion {
            motion: clamped(motion),
            jump,
            last_step: None,
            stepped: 0,
            shortest: periods(SHORTEST_WINDOW_MS),
            longest: periods(LONGEST_WINDOW_MS),
            window: periods(SHORTEST_WINDOW_MS),
            against: 0,
            lost: 0,
            least: 0,
            strong: i16::MAX,
            turning: i16::try_from(full / 4).unwrap_or(i16::MAX),
            forward: true,
            stretch: Stretch::default(),
            rest: Rest::default(),
            acceleration: Acceleration::default(),
            toggle: 0,
            toggles: 0,
            dithers: false,
        }
    }

    /// Counts that the probe takes for a motion.
    pub fn motion(&self) -> i32 {
        self.motion
    }

    /// A period of the probe's last step has passed.
    pub fn stepped(&mut self) {
        self.stepped = self.stepped.saturating_add(1);
    }

    /// In the probe's first, weakest step: what toggles now toggles at rest.
    pub fn at_rest(&mut self) {
        self.dithers |= self.toggles >= DITHER;
    }

    /// In the rest of the probe, where any drive may turn the motor.
    pub fn probing(&mut self, duty: i16) {
        self.turning = self.turning.min(duty.max(1));
    }

    /// What the probe has shown.
    pub(super) fn learned(&self) -> OfMotion {
        OfMotion {
            window: self.window,
            strong: self.strong,
            turning: self.turning,
            dithers: self.dithers,
            acceleration: self.acceleration,
        }
    }

    /// Takes over what the probe of another run showed of the same motor.
    pub(super) fn learn(&mut self, from: &OfMotion) {
        self.window = from.window;
        self.strong = from.strong;
        self.turning = from.turning;
        self.dithers = from.dithers;
        self.acceleration = from.acceleration;
        self.rest = Rest::of(from.acceleration, self.shortest);
    }

    /// Nobody has looked for a while.
    pub fn pause(&mut self) {
        self.last_step = None;
    }

    /// The probe has ended: a drive of `strong` moves the shaft well.
    pub fn expect(&mut self, strong: i16) {
        self.strong = strong;
        self.turning = strong;
        let periods = self.stepped.clamp(1, self.longest / 3);
        self.window = (3 * periods).max(self.shortest);
        self.acceleration = Acceleration {
            motion: self.motion.into(),
            time: periods.into(),
        };
        self.rest = Rest::of(self.acceleration, self.shortest);
    }

    /// True for a drive that moves the shaft well.
    pub fn is_strong(&self, duty: i16) -> bool {
        duty.unsigned_abs() >= self.strong.unsigned_abs()
    }

    /// Periods of a window.
    pub fn window(&self) -> u32 {
        self.window
    }

    /// Looks at the step of a period under `drive`; says what the last ones have shown, where they have.
    ///
    /// # Errors
    /// A jump of the encoder, a dead line, a shaft that runs against the drive.
    pub fn look(&mut self, drive: i16, step: i32) -> Result<Option<Shown>, Tripped> {
        self.jumped(step)?;
        let forward = drive >= 0;
        let reversed = forward != self.forward;
        self.forward = forward;
        self.toggled(step, reversed, drive)?;
        let strong = self.is_strong(drive);
        if self.rest.look(strong, reversed, step) {
            if self.toggles >= TOGGLES / 2 && !self.dithers {
                return Err(Tripped::by(Fault::EncoderLine));
            }
            return Ok(Some(Shown::Rest));
        }
        let mut shown = None;
        if !strong || reversed || self.stretch.periods >= self.window / 2 {
            shown = self.ended()?;
        }
        if strong {
            let with = if forward { step } else { step.saturating_neg() };
            self.stretch.step(with);
        }
        Ok(shown)
    }

    /// A stretch of strong drive has ended.
    fn ended(&mut self) -> Result<Option<Shown>, Tripped> {
        let stretch = core::mem::take(&mut self.stretch);
        let least = self.acceleration.gain(stretch.periods);
        if least < i64::from(REST_COUNTS) {
            return Ok(None);
        }
        let gain = stretch.gain();
        if stretch.travel >= 0 {
            // Not what the last bit of a run-up to no-load speed still brings.
            let much = i64::from(REST_COUNTS).max(least / 4);
            let gains = stretch.travel.min(gain) >= much;
            return Ok(gains.then_some(Shown::Gains(stretch.periods)));
        }
        self.against += stretch.periods;
        self.lost = self.lost.saturating_add(gain);
        self.least = self.least.saturating_add(least);
        if self.against < self.window || self.least < AGAINST_COUNTS {
            return Ok(None);
        }
        // Braking looks different: it takes speed, more than quantisation hides.
        let runs = self.lost < self.least / 4;
        (self.against, self.lost, self.least) = (0, 0, 0);
        if runs {
            return Err(Tripped {
                fault: Fault::Runaway,
                seen: stretch.travel.max(i32::MIN.into()) as i32,
                limit: 0,
            });
        }
        Ok(None)
    }

    fn jumped(&mut self, step: i32) -> Result<(), Tripped> {
        let change = step.saturating_sub(self.last_step.unwrap_or(step));
        self.last_step = Some(step);
        if self.jump > 0 && change.unsigned_abs() > self.jump.unsigned_abs() {
            return Err(Tripped {
                fault: Fault::EncoderJump,
                seen: change,
                limit: self.jump,
            });
        }
        Ok(())
    }

    /// With one line dead, an edge of the other counts up and the next one down. A shaft that is reversed also turns round.
    fn toggled(&mut self, step: i32, reversed: bool, drive: i16) -> Result<(), Tripped> {
        if reversed {
            self.toggles = self.toggles.saturating_sub(2);
        }
        if step == 0 {
            return Ok(());
        }
        let to_and_fro = step.abs() == 1 && step == -self.toggle;
        let turns = drive.unsigned_abs() >= self.turning.unsigned_abs();
        // A shaft that a servo holds may stand on an edge for hours; the probe's first steps, where any drive may turn it, count.
        let counts = turns || self.strong == i16::MAX;
        self.toggles = match to_and_fro {
            true => self.toggles + u32::from(counts),
            false => 0,
        };
        self.toggle = if step.abs() == 1 { step } else { 0 };
        if turns && !self.dithers && self.toggles >= TOGGLES {
            return Err(Tripped::by(Fault::EncoderLine));
        }
        Ok(())
    }
}

fn clamped(x: u32) -> i32 {
    i32::try_from(x).unwrap_or(i32::MAX)
}
