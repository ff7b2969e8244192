//! The motion that was measured, as the effects of a series-parallel model want it.

use super::settings::WINDOW_COUNTS;
use servoid_engine::problem::Data;
use shared::model::MeasuredInterval;

/// Fewest and most samples to each side in a window.
const HALF: (usize, usize) = (2, 12);

/// Position and speed of the shaft over each sample interval.
pub struct Motion {
    /// Over each interval; the last one repeats the one before.
    pub seen: Vec<MeasuredInterval<f64>>,
    /// Position within the revolution at each sample, turns.
    pub turns: Vec<f64>,
}

impl Motion {
    /// Takes the motion from the readings: slopes of straight lines through short windows.
    pub fn measured(data: &Data) -> Self {
        let fastest = data.units.speed * data.units.interval / core::f64::consts::TAU
            * data.units.counts_per_rev;
        let half =
            ((WINDOW_COUNTS / fastest.max(f64::MIN_POSITIVE)) as usize).clamp(HALF.0, HALF.1);
        let turns: Vec<f64> = (0..data.len())
            .map(|k| (data.centre(k) / data.units.counts_per_rev).rem_euclid(1.0))
            .collect();
        // At this sample, and at the next.
        let (mut speed, mut next_speed) = (0.0, slope(data, 0, half));
        let seen = (0..data.len())
            .map(|k| {
                let last = data.recordings.is_last(k);
                let next = if last { k } else { k + 1 };
                speed = if data.recordings.is_first(k) {
                    slope(data, k, half)
                } else {
                    next_speed
                };
                next_speed = speed;
                if next > k {
                    next_speed = slope(data, next, half);
                }
                let travel = (data.centre(next) - data.centre(k)) / data.units.counts_per_rev;
                let still = still(data, k, half);
                MeasuredInterval {
                    turns: (turns[k] + 0.5 * travel).rem_euclid(1.0),
                    speed: if still {
                        0.0
                    } else {
                        0.5 * (speed + next_speed)
                    },
                    speed_change: if still { 0.0 } else { next_speed - speed },
                }
            })
            .collect();
        Motion { seen, turns }
    }
}

/// Speed at sample `k`, per unit.
fn slope(data: &Data, k: usize, half: usize) -> f64 {
    let window = data.recordings.around(k, half);
    let n = window.len() as f64;
    let (mut time, mut angle) = (0.0, 0.0);
    for j in window.clone() {
        time += data.time_s[j] - data.time_s[k];
        angle += data.counts[j] - data.counts[k];
    }
    let (time, angle) = (time / n, angle / n);
    let (mut cross, mut square) = (0.0, 0.0);
    for j in window {
        let t = data.time_s[j] - data.time_s[k] - time;
        cross += t * (data.counts[j] - data.counts[k] - angle);
        square += t * t;
    }
    let per_s = if square > 0.0 { cross / square } else { 0.0 };
    per_s / data.units.counts_per_rev * core::f64::consts::TAU / data.units.speed
}

/// Whether the reading stands still around interval `k`; a shaft at rest on the edge of a cell may dither
/// by one count.
fn still(data: &Data, k: usize, half: usize) -> bool {
    let window = data.recordings.around(k, half.max(3));
    let (low, high) = window.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), j| {
        (low.min(data.counts[j]), high.max(data.counts[j]))
    });
    high - low <= if data.quantised { 1.0 } else { 0.0 }
}
