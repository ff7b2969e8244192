//! The loop: an observer of angle, speed and disturbance, and the duty that follows.
//!
//! A duty acts from the next reading on. So what is asked of the motor is asked of where it will be then.
//!
//! Far from its target a position loop asks for no more speed than can be braked: `√(2·a·x)` for the acceleration `a` and what is left to go,
//! joined smoothly to the proportional part.

use super::Gains;
use crate::scalar::Real;

/// Where a servo is to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// Counts from where it began.
    Position(i32),
    /// Counts a period.
    Speed(f32),
}

/// A servo under way.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    gains: Gains,
    /// Largest duty, a part of the supply.
    limit: f32,
    /// Largest speed that is asked for, counts a period, and acceleration on the way to a position, counts a period squared.
    fastest: f32,
    hardest: f32,
    /// Counts from where it began, by the reading.
    read: i32,
    /// The observer: counts by which the angle is ahead of the reading, counts a period, and a part of the supply.
    ahead: f32,
    speed: f32,
    disturbance: f32,
    /// Duty of the next period.
    next: f32,
}

/// A count that lies anywhere within a count says nothing: what is beyond half of one does.
const HALF: f32 = 0.5;
/// Friction is counted where the speed that is asked for is more than what half a count asks for.
const ASKED: f32 = 0.5;
/// Parts of the motor's largest speed and acceleration that are asked for: what is left is for the loop to keep to them.
const OF_SPEED: f32 = 0.8;
const OF_ACCELERATION: f32 = 0.5;

impl Servo {
    /// With nothing done.
    pub const IDLE: Self = Servo {
        gains: Gains::NONE,
        limit: 0.0,
        fastest: 0.0,
        hardest: 0.0,
        read: 0,
        ahead: 0.0,
        speed: 0.0,
        disturbance: 0.0,
        next: 0.0,
    };

    /// Begins at rest, with duties up to `limit`, a part of the supply.
    pub fn begin(&mut self, gains: Gains, limit: f32) {
        // The friction is fed forward; what is left of the drive moves the motor.
        let moves = (limit - gains.friction).max(0.0);
        let fastest = OF_SPEED * moves / gains.back_emf;
        *self = Servo {
            gains,
            limit,
            fastest,
            hardest: OF_ACCELERATION * moves / (gains.back_emf * gains.time_constant),
            ahead: HALF,
            ..Self::IDLE
        };
    }

    /// Asks for no more than a speed, counts a period.
    pub fn no_faster_than(&mut self, speed: f32) {
        self.fastest = self.fastest.min(speed);
    }

    /// The count went on by `step` in the period that has ended; the duty of the next period, which the last call gave, acts now. Gives the one
    /// of the period after that, on the way to `target`.
    pub fn next(&mut self, step: i32, target: Target) -> f32 {
        self.read = self.read.wrapping_add(step);
        self.ahead -= step as f32;
        // The reading is the whole counts below the angle.
        let off = HALF - self.ahead;
        let says = off - off.clamp(-HALF, HALF);
        let [angle, speed, disturbance] = self.gains.observer;
        self.ahead += angle * says;
        self.speed += speed * says;
        self.disturbance += disturbance * says;
        self.predict();
        let asked = match target {
            Target::Position(counts) => {
                self.toward(counts.wrapping_sub(self.read) as f32 - self.ahead)
            }
            Target::Speed(speed) => speed,
        };
        self.next = self.duty(asked.clamp(-self.fastest, self.fastest));
        self.next
    }

    /// The speed at which to go where it is `left` counts to go: in proportion near the target, and from afar as fast as can be braked.
    fn toward(&self, left: f32) -> f32 {
        let (by_position, size) = (self.gains.position, left.abs());
        let near = self.hardest / (by_position * by_position);
        if size <= near {
            by_position * left
        } else {
            Real::sqrt(2.0 * self.hardest * (size - 0.5 * near)).copysign(left)
        }
    }

    /// Largest duty, a part of the supply.
    pub fn limit(&self) -> f32 {
        self.limit
    }

    /// The next duty will be another than [`next`](Self::next) gave.
    pub fn acts(&mut self, duty: f32) {
        self.next = duty;
    }

    /// Goes on to the next reading, under the duty that acts now.
    fn predict(&mut self) {
        let Gains {
            back_emf,
            decay,
            time_constant,
            ..
        } = self.gains;
        let drives = self.next - self.friction(self.speed) + self.disturbance;
        let tends_to = drives / back_emf;
        let from = self.speed - tends_to;
        self.ahead += tends_to + from * time_constant * (1.0 - decay);
        self.speed = tends_to + from * decay;
    }

    /// What friction takes at a speed.
    fn friction(&self, speed: f32) -> f32 {
        let least = self.gains.position * ASKED;
        self.gains.friction * (speed / least).clamp(-1.0, 1.0)
    }

    /// The duty that brings the speed to what is asked.
    fn duty(&self, asked: f32) -> f32 {
        let needed = self.gains.speed * (asked - self.speed)
            + self.gains.back_emf * self.speed
            + self.friction(asked)
            - self.disturbance;
        needed.clamp(-self.limit, self.limit)
    }
}
