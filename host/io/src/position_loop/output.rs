//! The volts of a position loop over the intervals of a recording.

use super::gain::{self, GainUnknown};
use super::settings::{GainOrigin, LoopSettings, PositionLoop};
use std::f64::consts::TAU;

/// Instants at which the output is taken in an interval. The output bends where it reaches its limit, at a time within the
/// interval that is known to an eighth of it.
const INSTANTS: usize = 8;

/// What a loop was told and what it read, sample by sample.
#[derive(Clone, Copy)]
pub struct Follower<'a> {
    /// Time of each sample, s; strictly increasing.
    pub time_s: &'a [f64],
    /// Target from each sample until the next, counts.
    pub target_counts: &'a [f64],
    /// Reading, counts, from the target's zero.
    pub counts: &'a [f64],
    /// Whether the bridge is closed from each sample on; `None` where it always is.
    pub enabled: Option<&'a [bool]>,
    /// Encoder counts per revolution.
    pub counts_per_rev: f64,
}

impl Follower<'_> {
    /// The loop of these settings, its gain estimated where none is given.
    ///
    /// # Errors
    /// Why the recording does not tell the gain.
    pub fn control(
        &self,
        settings: &LoopSettings,
        limit_v: f64,
    ) -> Result<PositionLoop, GainUnknown> {
        let (gain, origin) = match settings.gain_v_per_rad {
            Some(gain) => (gain, GainOrigin::Given),
            None => {
                let (gain, estimate) = gain::estimate(self, settings, limit_v)?;
                (gain, GainOrigin::Estimated(estimate))
            }
        };
        Ok(settings.with(gain, limit_v, origin))
    }

    /// The mean voltage of `control` over the interval that begins at each sample; zero while the bridge is open. Behind the
    /// last sample nothing is known, and its own voltage stands there.
    ///
    /// The angle between readings is a cubic with the slope of its neighbours (the loop itself is faster than the log). A loop
    /// of a stated rate holds its output until its next instant: its reading is half a period old in the mean. A target acts at
    /// once: how long it waits for the loop's next instant is not in the log.
    pub fn volts(&self, control: &PositionLoop) -> Vec<f64> {
        let late = control.rate_hz.map_or(0.0, |rate| 0.5 / rate);
        let slopes = self.slopes();
        let samples = self.time_s.len();
        (0..samples)
            .map(|k| {
                if !self.is_closed(k) {
                    return 0.0;
                }
                let start = self.time_s[k];
                let Some(end) = self.time_s.get(k + 1) else {
                    return self.at(control, &slopes, k, start - late);
                };
                let step = (end - start) / INSTANTS as f64;
                let sum: f64 = (0..INSTANTS)
                    .map(|i| self.at(control, &slopes, k, start + (i as f64 + 0.5) * step - late))
                    .sum();
                sum / INSTANTS as f64
            })
            .collect()
    }

    /// Whether the bridge is closed from sample `k` on.
    pub(super) fn is_closed(&self, k: usize) -> bool {
        self.enabled.is_none_or(|enabled| enabled[k])
    }

    /// Radians per count.
    pub(super) fn rad_per_count(&self) -> f64 {
        TAU / self.counts_per_rev
    }

    /// The voltage at a time of sample `k`'s interval, or before it.
    fn at(&self, control: &PositionLoop, slopes: &[f64], k: usize, time: f64) -> f64 {
        let mut j = k;
        while j > 0 && self.time_s[j] > time {
            j -= 1;
        }
        let (counts, speed) = self.reading(slopes, j, time);
        let error = self.target_counts[k] - counts;
        control.volts(error * self.rad_per_count(), speed * self.rad_per_count())
    }

    /// Reading in counts and its rate in counts per second at a time between samples `j` and `j + 1`.
    fn reading(&self, slopes: &[f64], j: usize, time: f64) -> (f64, f64) {
        let (Some(end), true) = (self.time_s.get(j + 1), time > self.time_s[j]) else {
            return (self.counts[j], slopes[j]);
        };
        let length = end - self.time_s[j];
        let x = (time - self.time_s[j]) / length;
        let rise = self.counts[j + 1] - self.counts[j];
        let (from, to) = (slopes[j] * length, slopes[j + 1] * length);
        // Hermite's cubic from 0 to `rise`.
        let (square, bend) = (3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise);
        let counts = self.counts[j] + x * (from + x * (square + x * bend));
        let rate = (from + x * (2.0 * square + x * 3.0 * bend)) / length;
        (counts, rate)
    }

    /// Slope of the parabola through each sample and its neighbours, counts per second.
    fn slopes(&self) -> Vec<f64> {
        let samples = self.time_s.len();
        let chord = |k: usize| {
            let length = self.time_s[k + 1] - self.time_s[k];
            (length, (self.counts[k + 1] - self.counts[k]) / length)
        };
        (0..samples)
            .map(|k| match (k.checked_sub(1), k + 1 < samples) {
                (Some(before), true) => {
                    let ((h0, d0), (h1, d1)) = (chord(before), chord(k));
                    (h1 * d0 + h0 * d1) / (h0 + h1)
                }
                (Some(before), false) => chord(before).1,
                (None, true) => chord(k).1,
                (None, false) => 0.0,
            })
            .collect()
    }
}
