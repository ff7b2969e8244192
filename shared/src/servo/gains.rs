//! Gains of a position and a speed loop by a fitted motor.
//!
//! The motor is taken for a speed that tends to `K·u` with the time constant `T`, `u` a part of the supply: its acceleration is `b·u − v/T`
//! with `b = K/T`. The speed loop asks for the acceleration `ω_v·(v* − v)`, so that its proportional part is `ω_v/b`, and adds what the
//! back-EMF takes; the position loop asks for the speed `ω_x·(x* − x)`. With `ω_x = ω_v/4` both poles of the whole are `ω_v/2` (any text on
//! cascaded control; Leonhard, *Control of Electrical Drives*, 2001, chapter 15).
//!
//! The speed is that of an observer of the third order, whose third state is a constant disturbance, with all poles at `θ`: the gains are those of
//! a critically damped filter, `1 − θ³`, `3/2·(1 − θ)²·(1 + θ)` and `(1 − θ)³/b` (Brookner, *Tracking and Kalman Filtering Made Easy*, 1998,
//! section 1.3; Morrison, 1969). How fast it may be depends on the encoder: a count must not move the duty by more than a tenth.

use crate::scalar::Real;
use serde::{Deserialize, Serialize};

/// Gains of a servo, per period, per count, and as parts of the supply.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Gains {
    /// Speed asked for by a count off, a period.
    pub position: f32,
    /// Part of the supply asked for by a count a period too slow.
    pub speed: f32,
    /// Part of the supply that a speed of a count a period takes: 1/K.
    pub back_emf: f32,
    /// Part of the supply that friction takes.
    pub friction: f32,
    /// What a period leaves of a speed: exp(−1/T).
    pub decay: f32,
    /// T, periods.
    pub time_constant: f32,
    /// Gains of the observer: counts, counts a period, and parts of the supply, each by a count.
    pub observer: [f32; 3],
}

/// Poles of the speed loop and of the observer are not faster than this by the lags that neither knows of: the winding's, and half a period.
const OF_LAGS: f32 = 0.25;
/// The observer's poles by the speed loop's.
const OBSERVER_BY_SPEED: f32 = 2.0;
/// The position loop's by the speed loop's: both poles of the whole are real, and the same.
const POSITION_BY_SPEED: f32 = 0.25;
/// Most that a count may move the duty, a part of the supply.
const MOST_BY_A_COUNT: f32 = 0.1;

impl Gains {
    /// Of no motor: all zeros.
    pub const NONE: Self = Gains {
        position: 0.0,
        speed: 0.0,
        back_emf: 0.0,
        friction: 0.0,
        decay: 0.0,
        time_constant: 0.0,
        observer: [0.0; 3],
    };

    /// Of a motor of a gain (counts a period under the whole supply), time constants (periods) and friction (a part of the supply), whose
    /// gain over time constant may be off by the part `off`: a loop is laid out for the fastest motor that it may be.
    pub fn of(gain: f32, [mechanical, electrical]: [f32; 2], friction: f32, off: f32) -> Self {
        let acceleration = gain / mechanical;
        let lags = electrical + 0.5;
        let by_lags = OF_LAGS / lags;
        // A count moves the speed by 3·ω_o² and the disturbance by ω_o³/b, and the duty by ω_v/b times the first, and the second.
        let by_count = 3.0 / OBSERVER_BY_SPEED + 1.0;
        let by_encoder = cube_root(MOST_BY_A_COUNT * acceleration / by_count);
        let observer = (OBSERVER_BY_SPEED * by_lags).min(by_encoder);
        let speed = observer / OBSERVER_BY_SPEED;
        let fastest = acceleration * (1.0 + off);
        let kept = Real::exp(-observer);
        let lost = 1.0 - kept;
        Gains {
            position: speed * POSITION_BY_SPEED,
            speed: speed / fastest,
            back_emf: 1.0 / gain,
            friction,
            decay: Real::exp(-1.0 / mechanical),
            time_constant: mechanical,
            observer: [
                1.0 - kept * kept * kept,
                1.5 * lost * lost * (1.0 + kept),
                lost * lost * lost / acceleration,
            ],
        }
    }

    /// Largest step, counts, that is answered without more than this part of the supply.
    pub fn largest_step(&self, duty: f32) -> f32 {
        duty / (self.position * self.speed)
    }

    /// Periods in which a step is over.
    pub fn settling(&self) -> f32 {
        // Both poles at 2·ω_x: e^(−x)·(1 + x) is a 50th at x = 5.8.
        5.8 / (2.0 * self.position)
    }
}

/// Of a positive number.
fn cube_root(x: f32) -> f32 {
    Real::exp(Real::ln(x) * (1.0 / 3.0))
}
