//! The loop: an observer of angle, speed and disturbance, and the duty that follows.
//!
//! A duty acts from the next reading on. So what is asked of the motor is asked of where it will be then.

use super::Gains;

/// A servo under way.
#[derive(Clone, Copy, Debug)]
pub struct Servo {
    gains: Gains,
    /// Largest duty, a part of the supply.
    limit: f32,
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

impl Servo {
    /// With nothing done.
    pub const IDLE: Self = Servo {
        gains: Gains::NONE,
        limit: 0.0,
        read: 0,
        ahead: 0.0,
        speed: 0.0,
        disturbance: 0.0,
        next: 0.0,
    };

    /// Begins at rest, with duties up to `limit`, a part of the supply.
    pub fn begin(&mut self, gains: Gains, limit: f32) {
        *self = Servo {
            gains,
            limit,
            ahead: HALF,
            ..Self::IDLE
        };
    }

    /// The count went on by `step` in the period that has ended; the duty of the next period, which the last call gave, acts now. Gives the one
    /// of the period after that, on the way to `target` (counts from where it began).
    pub fn next(&mut self, step: i32, target: f32) -> f32 {
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
        let asked = self.gains.position * (target - self.read as f32 - self.ahead);
        self.next = self.duty(asked);
        self.next
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
