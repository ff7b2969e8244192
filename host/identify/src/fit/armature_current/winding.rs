//! What the current says as the winding's: resistance and back-EMF constant, whatever torques there are.
//!
//! ```text
//! L·di/dt = u − R·i − Kb·ω                                    V
//! ```
//!
//! Over a sample interval `h` with the voltage held, `E = exp(−h·R/L)`:
//! `i(h) − E·i(0) = (1 − E)/R·(u − Kb·ω̃)`, where `ω̃` is the speed's mean weighted by `exp(−(h − s)·R/L)`: a straight line
//! over the interval at `L/R − h·E/(1 − E)` before its end. The speed is the encoder's; all are averaged over as many intervals
//! as make the encoder's rounding small beside the motion.

use super::decay::{Row, electrical};
use super::plane::Plane;
use crate::fit::physical::Estimate;
use servoid_engine::problem::{Candidate, Data};
use servoid_io::channel::Measured;
use servoid_io::recording::Drive;
use shared::effects::Place;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::f64::consts::TAU;

/// Variance of the speed's rounding errors, as a part of the speed's own, up to which it counts as known.
const ROUNDED: f64 = 1e-4;
/// Fewest and most intervals that are averaged: within one the voltage may not be held as the log has it.
const SHORTEST: usize = 8;
const LONGEST: usize = 256;
/// The average is so many electrical time constants long, so that it hardly matters how well that one is known.
const TIME_CONSTANTS: f64 = 10.0;
/// Straight speeds within an interval are no better than this, relative.
const LEAST: f64 = 0.005;
/// A resistance whose standard error is so large a part of it says nothing.
const UNKNOWN: f64 = 0.3;

/// Resistance and back-EMF constant.
#[derive(Clone, Copy)]
pub struct Winding {
    /// Ω.
    pub resistance: Estimate,
    /// V·s/rad.
    pub kb: Estimate,
}

/// Resistance and back-EMF constant. `None` where something stands between the command and the winding, and where the current says
/// little.
pub fn winding_evidence(data: &Data, model: &Candidate) -> Option<Winding> {
    let measured = data
        .measured
        .get(Measured::Current)
        .filter(|_| data.drive == Drive::Voltage)?;
    let between = |place: Place| matches!(place, Place::Drive | Place::Winding);
    if (model.effects.iter()).any(|(kind, _)| between(kind.description().place)) {
        return None;
    }
    let speeds = speeds(data);
    // The current's own: in the motion torques that the model lacks hide it.
    let electrical = electrical(&rows(data, measured, &speeds), data.units.interval)?;
    let long = TIME_CONSTANTS * electrical.value / data.units.interval;
    let all = intervals(data, measured, &speeds, electrical.value);
    let counts = std::iter::successors(Some(SHORTEST), |count| Some(2 * count));
    let count = counts
        .take_while(|&count| count <= LONGEST)
        .filter(|&count| count as f64 >= long)
        .find(|&count| rounding(data, count) < ROUNDED * variance(&averaged(&all, count)))?;
    let [mut resistance, mut kb] = regressed(&averaged(&all, count), rounding(data, count))?;
    // The electrical time constant is not known for certain: the motion may tell another one.
    let off =
        electrical.value + libm::hypot(electrical.std, electrical.value - model.machine.electrical);
    let there = averaged(&intervals(data, measured, &speeds, off), count);
    let there = regressed(&there, rounding(data, count))?;
    for (estimate, there) in [&mut resistance, &mut kb].into_iter().zip(there) {
        estimate.std = libm::hypot(estimate.std, there.value - estimate.value);
    }
    resistance.std = libm::hypot(resistance.std, LEAST * resistance.value);
    (resistance.std < UNKNOWN * resistance.value && kb.value > 0.0)
        .then_some(Winding { resistance, kb })
}

/// One sample interval, or the mean of several: what the equation holds of, each over `1 − E`.
#[derive(Clone, Copy, Default)]
struct Interval {
    /// V.
    volts: f64,
    /// rad/s.
    speed: f64,
    /// `(i(h) − E·i(0))/(1 − E)`, A.
    current: f64,
}

/// The mean speed over each interval in which the bridge drives, rad/s, and its acceleration, rad/s²; those beside the ends of a
/// recording are left out.
fn speeds(data: &Data) -> Vec<Option<(f64, f64)>> {
    let radians = TAU / data.units.counts_per_rev;
    let mean = |k: usize| (data.counts[k + 1] - data.counts[k]) * radians / seconds(data, k);
    let one = |k: usize| {
        let inside = k > 0
            && k + 2 < data.len()
            && !data.recordings.is_first(k)
            && !data.recordings.is_last(k)
            && !data.recordings.is_last(k + 1);
        let open = data.open.as_ref().is_some_and(|open| open[k]);
        let acceleration = |k: usize| (mean(k + 1) - mean(k - 1)) / (2.0 * seconds(data, k));
        (inside && !open).then(|| (mean(k), acceleration(k)))
    };
    (0..data.len()).map(one).collect()
}

fn seconds(data: &Data, k: usize) -> f64 {
    data.time_s[k + 1] - data.time_s[k]
}

/// What the electrical time constant is read from.
fn rows(data: &Data, measured: &[f64], speeds: &[Option<(f64, f64)>]) -> Vec<Option<Row>> {
    let row = |(k, speed): (usize, &Option<(f64, f64)>)| {
        let (mean, acceleration) = (*speed)?;
        let volts = data.command[k] * data.units.volts;
        let at_end = mean + 0.5 * acceleration * seconds(data, k);
        Some((measured[k + 1], [measured[k], volts, at_end]))
    };
    speeds.iter().enumerate().map(row).collect()
}

/// The intervals with this electrical time constant, s.
fn intervals(
    data: &Data,
    measured: &[f64],
    speeds: &[Option<(f64, f64)>],
    electrical: f64,
) -> Vec<Option<Interval>> {
    let one = |(k, speed): (usize, &Option<(f64, f64)>)| {
        let (mean, acceleration) = (*speed)?;
        let seconds = seconds(data, k);
        let exponent = -seconds / electrical.max(f64::MIN_POSITIVE);
        let (decay, rise) = (libm::exp(exponent), -libm::expm1(exponent));
        let before_end = electrical - seconds * decay / rise;
        Some(Interval {
            volts: data.command[k] * data.units.volts,
            speed: mean + acceleration * (0.5 * seconds - before_end),
            current: (measured[k + 1] - decay * measured[k]) / rise,
        })
    };
    speeds.iter().enumerate().map(one).collect()
}

/// Means of `count` neighbours, where all of them are there.
fn averaged(intervals: &[Option<Interval>], count: usize) -> Vec<Interval> {
    let mean = |some: &[Option<Interval>]| {
        let mut sum = Interval::default();
        for one in some {
            let one = (*one)?;
            sum.volts += one.volts / count as f64;
            sum.speed += one.speed / count as f64;
            sum.current += one.current / count as f64;
        }
        Some(sum)
    };
    intervals.chunks_exact(count).filter_map(mean).collect()
}

/// Variance of the rounding errors of a speed over `count` intervals, (rad/s)².
fn rounding(data: &Data, count: usize) -> f64 {
    let counts = if data.quantised {
        FLOOR_RMS_COUNTS
    } else {
        0.0
    };
    let seconds = data.units.interval * count as f64;
    2.0 * (counts * TAU / data.units.counts_per_rev / seconds).powi(2)
}

fn variance(intervals: &[Interval]) -> f64 {
    let count = intervals.len().max(1) as f64;
    let mean = intervals.iter().map(|one| one.speed).sum::<f64>() / count;
    let squares = intervals.iter().map(|one| (one.speed - mean).powi(2));
    squares.sum::<f64>() / count
}

/// Resistance, Ω, and back-EMF constant, V·s/rad, where the speeds have rounding errors of this variance, which widen both.
fn regressed(intervals: &[Interval], rounding: f64) -> Option<[Estimate; 2]> {
    let at: Vec<(f64, f64)> = intervals.iter().map(|one| (one.volts, one.speed)).collect();
    let currents: Vec<f64> = intervals.iter().map(|one| one.current).collect();
    let used = vec![true; currents.len()];
    let plane = Plane::through(&at, &currents, &used)?;
    let [mut over_volts, mut over_speed] = plane.slopes(&at, &currents, &used);
    let lost = plane.attenuation(rounding, currents.len());
    over_volts.std = libm::hypot(over_volts.std, lost[0]);
    over_speed.std = libm::hypot(over_speed.std, lost[1]);
    let resistance = 1.0 / over_volts.value;
    let kb = -over_speed.value * resistance;
    let relative = over_volts.std * resistance;
    Some([
        Estimate {
            value: resistance,
            std: relative * resistance,
        },
        Estimate {
            value: kb,
            std: libm::hypot(over_speed.std * resistance, kb * relative),
        },
    ])
}
