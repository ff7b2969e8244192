//! The incremental encoder on the motor shaft and its counter.

use super::chance::Chance;
use super::effects::Effect;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Floor-quantises the sensed angle and subtracts the counts lost so far.
pub(super) struct Encoder<'a> {
    effects: &'a [Arc<dyn Effect>],
    counts_per_rad: f64,
    chance: Chance,
    lost: i64,
}

impl<'a> Encoder<'a> {
    pub(super) fn new(effects: &'a [Arc<dyn Effect>], counts_per_rev: u32, seed: u64) -> Self {
        Encoder {
            effects,
            counts_per_rad: f64::from(counts_per_rev) / TAU,
            chance: Chance::new(seed, "lost counts"),
            lost: 0,
        }
    }

    /// The counter's reading at a shaft angle, rad, with an error of so many counts before it is floored.
    pub(super) fn read(&self, angle: f64, error_counts: f64) -> i64 {
        let sensed = self
            .effects
            .iter()
            .fold(angle, |angle, effect| effect.sensed_angle(angle));
        (sensed * self.counts_per_rad + error_counts).floor() as i64 - self.lost
    }

    /// Lets the counter run for `dt` s at about `speed` rad/s, in which it may lose counts.
    pub(super) fn pass(&mut self, speed: f64, dt: f64) {
        for effect in self.effects {
            self.lost += effect.lost_counts(speed, dt, &mut self.chance);
        }
    }
}
