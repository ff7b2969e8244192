//! How far models run on their own before they are set back to the measured state. Open-loop errors of whole
//! recordings show the smallest effects, but only where the motor was left to the voltage: behind a current
//! loop, or under a controller, every small error of the torque adds up without end.

use super::settings::{AGAINST, FEWEST_SAMPLES, LOST, USUAL_WINDOW_S};
use crate::diagnose::models::Errors;
use crate::fit::{Options, SPEED_HALF_WIDTH};
use servoid_engine::data::local_parabola;
use servoid_engine::problem::{Data, Horizon};
use shared::encoder::FLOOR_RMS_COUNTS;
use shared::motor::Machine;
use std::ops::Range;

/// How far models run on their own.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// Length of the windows, s; the whole recording if `None`.
    pub window_s: Option<f64>,
    /// Why.
    pub reason: String,
}

impl Span {
    /// What the user wants, or what the kind of recording demands before any model is fitted.
    pub fn of(data: &Data, options: &Options) -> Self {
        let because = |window_s, reason: &str| Span {
            window_s,
            reason: reason.to_owned(),
        };
        if options.window_s.is_some() {
            return because(options.window_s, "as asked for");
        }
        if !data.drive.is_voltage() {
            return because(
                usual(data),
                "behind a current loop an error of the torque adds up twice over a whole recording",
            );
        }
        if !data.quantised {
            return because(
                usual(data),
                "the angle is no plain count: its errors have no floor that whole runs could reach",
            );
        }
        because(
            None,
            "the motor was left to the voltage: whole runs show the smallest effects",
        )
    }

    /// Length of the windows where the user chose none, s.
    pub fn usual_window_s(data: &Data) -> f64 {
        USUAL_WINDOW_S.max(FEWEST_SAMPLES * data.units.interval)
    }

    /// Windows instead of whole runs, where the linear motor run over the whole recording says little, even
    /// beside a constant that drives it: then it leaves `steadied` counts RMS.
    pub fn after(self, data: &Data, base: Errors, steadied: f64) -> Self {
        let lost = base.fitted.min(steadied) / spread(data);
        if self.window_s.is_some() {
            return self;
        }
        if !base.at_floor() && !moves_both_ways(data) {
            return Span {
                window_s: usual(data),
                reason: "the motor turns one way only: a small change of its friction is never taken back"
                    .to_owned(),
            };
        }
        if lost < LOST {
            return self;
        }
        Span {
            window_s: usual(data),
            reason: format!(
                "over the whole recording the linear motor strays by {:.0} % of the motion: a controller or a \
                 changing load moved it more than the voltage alone",
                100.0 * lost
            ),
        }
    }
}

/// Whether a twentieth of the travel at least goes against the prevailing direction.
pub fn moves_both_ways(data: &Data) -> bool {
    together_move_both_ways(data, data)
}

/// The same of two recordings of one motor together: each may go one way only, if it is not the same one.
pub fn together_move_both_ways(data: &Data, held_out: &Data) -> bool {
    let (own, other) = (ways(data), ways(held_out));
    (own.0 || other.0) && (own.1 || other.1)
}

/// Whether a recording moves forward, and whether backward, for more than a twentieth of its travel.
fn ways(data: &Data) -> (bool, bool) {
    let travel = data.steps().fold((0.0, 0.0), |(forward, backward), step| {
        (forward + step.max(0.0), backward + (-step).max(0.0))
    });
    let (forward, backward): (f64, f64) = travel;
    let least = AGAINST * (forward + backward);
    (forward > least, backward > least)
}

fn usual(data: &Data) -> Option<f64> {
    Some(Span::usual_window_s(data))
}

/// Standard deviation of the readings about the mean of their recording, counts: how far apart recordings lie is no motion.
fn spread(data: &Data) -> f64 {
    let squares = data.recordings.ranges().map(|range| {
        let counts = &data.counts[range];
        let mean = counts.iter().sum::<f64>() / counts.len().max(1) as f64;
        counts.iter().map(|c| (c - mean).powi(2)).sum::<f64>()
    });
    let mean = squares.sum::<f64>() / data.len().max(1) as f64;
    mean.sqrt().max(f64::MIN_POSITIVE)
}

/// RMS error in counts that the reading's own noise makes of a right model in windows: that of the reading,
/// that of the angle at the start, and that of the speed at the start, which carries on for as long as the
/// motor's time constant lets it.
pub fn floor_counts(data: &Data, horizon: &Horizon, machine: &Machine<f64>) -> f64 {
    let Horizon::Windows(windows) = horizon else {
        return FLOOR_RMS_COUNTS;
    };
    let noise = noise_counts(data);
    // What the start angle keeps of a reading's noise.
    let start = if data.quantised {
        1.0
    } else {
        own_part(data.state_half_width())
    };
    let slowest = machine.response().a1;
    let mut squares = 0.0;
    for window in windows {
        let first = window.range.start;
        let speed = noise * slope_gain(data, first);
        for k in window.range.clone() {
            let t = data.time_s[k] - data.time_s[first];
            let carried = if slowest.is_finite() && slowest > 0.0 {
                -slowest * libm::expm1(-t / slowest)
            } else {
                t
            };
            squares += (1.0 + start) * noise * noise + (speed * carried).powi(2);
        }
    }
    let samples: usize = windows.iter().map(|window| window.range.len()).sum();
    (squares / samples.max(1) as f64).sqrt()
}

/// Standard deviation of the slope at sample `k` for noise of one count, 1/s.
fn slope_gain(data: &Data, k: usize) -> f64 {
    let half = data.state_half_width();
    let Range {
        start: from,
        end: to,
    } = data.recordings.around(k, half);
    let n = (to - from) as f64;
    let mean = (from..to).map(|j| data.time_s[j]).sum::<f64>() / n;
    let squares: f64 = (from..to).map(|j| (data.time_s[j] - mean).powi(2)).sum();
    1.0 / squares.sqrt().max(f64::MIN_POSITIVE)
}

/// The part of its own point's noise that the middle of a parabola through `2·half + 1` even points follows.
fn own_part(half: usize) -> f64 {
    let n = (2 * half + 1) as f64;
    3.0 * (3.0 * n * n - 7.0) / (4.0 * n * (n * n - 4.0))
}

/// Noise of a reading, counts RMS: that of rounding, or what local parabolas leave.
pub fn noise_counts(data: &Data) -> f64 {
    if data.quantised {
        return FLOOR_RMS_COUNTS;
    }
    let side = SPEED_HALF_WIDTH;
    if data.len() <= 2 * side {
        return FLOOR_RMS_COUNTS;
    }
    let own = own_part(side);
    let middles = side..data.len() - side;
    let count = middles.len() as f64;
    let squares: f64 = middles
        .map(|k| {
            let points = (k - side..=k + side).map(|j| {
                (
                    data.time_s[j] - data.time_s[k],
                    data.counts[j] - data.counts[k],
                )
            });
            local_parabola(points).0.powi(2)
        })
        .sum();
    (squares / count / (1.0 - own)).sqrt()
}
