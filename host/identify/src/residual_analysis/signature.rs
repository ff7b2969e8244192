//! The signature of an effect: the volts that the motor asked for without it, against the quantity with which the effect goes, and those
//! that the model with the effect asks for over its own run under the same commands: the catalogue's own equation, states and all.

use super::bins::{Against, Bin, Map, independent, points};
use super::{filter_time, own_volts};
use crate::fit::scores::{EquationResidual, equation_residuals};
use core::f64::consts::TAU;
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use shared::effects::Kind;

/// Share of an effect's volts that its quantity must explain, or it is not drawn.
const TOLD: f64 = 0.3;
/// What is told against the motion counts for this part.
const TURNED: f64 = 0.5;
/// A wave that passes in less than so many filter times is not seen, rad.
const SEEN: f64 = 0.5;
/// Bins of the angle within one wave.
const WAVE_BINS: usize = 16;
/// Points of a curve, at most; of a wave, whose angle is known to a count only, fewer.
const POINTS: usize = 96;
const WAVE_POINTS: usize = 32;
/// Fewest samples of a point.
const FEWEST: usize = 3;

/// What an effect's volts are drawn against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// One of the quantities of the maps.
    Map(Against),
    /// The angle within a wave, of which a revolution has so many, as a part of the wave.
    Wave(usize),
}

/// An effect over the motion of a recording.
#[derive(Clone, Debug)]
pub struct Signature {
    /// The abscissa.
    pub axis: Axis,
    /// What the model without the effect misses, in bins.
    pub bins: Vec<Bin>,
    /// What the effect asks for: abscissa, and V.
    pub curve: Vec<(f64, f64)>,
}

/// The signature of `kind` within `candidate`; `None` where no quantity tells it, as of a delay.
pub fn signature(
    data: &Data,
    candidate: &Candidate,
    kind: Kind,
    method: Method,
) -> Option<Signature> {
    if kind.facts().by_chance {
        return None;
    }
    let time = filter_time(data);
    let missing = equation_residuals(data, &candidate.without(kind), time);
    let own = own_volts(data, candidate, kind, method).ok()?;
    let machine = &candidate.machine;
    let values = candidate
        .effects
        .iter()
        .find_map(|(own, values)| (own == kind).then(|| values.to_vec()))?;
    if let Some(waves) = kind
        .facts()
        .periodic
        .and_then(|order| order.of(&values))
        .filter(|waves| *waves > 0)
    {
        return Some(Signature {
            axis: Axis::Wave(waves),
            bins: wave_bins(&folded(&missing, waves, time)),
            curve: curve(folded(&own, waves, time), WAVE_POINTS),
        });
    }
    let told = |against: Against| {
        let map = Map::new(against, data, machine, &own, 0.0)?;
        // Against the motion everything that brakes is level: that is looked at where nothing else tells.
        let share = map.share * if against.turned() { TURNED } else { 1.0 };
        // A quantity is as good as the first of the list that tells about as much.
        Some((against, (share * 20.0).round()))
    };
    let (against, share) = Against::ALL
        .into_iter()
        .filter_map(told)
        .reduce(|best, next| if next.1 > best.1 { next } else { best })?;
    if share < TOLD * 20.0 {
        return None;
    }
    let own = points(against, data, machine, &own);
    Some(Signature {
        axis: Axis::Map(against),
        bins: Map::new(against, data, machine, &missing, 0.0)?.bins,
        curve: curve(own.into_iter().map(|p| (p.x, p.volts)).collect(), POINTS),
    })
}

/// Angles within a wave, as parts of it, with the volts there, where the shaft is slow enough for the filter.
fn folded(residuals: &[EquationResidual], waves: usize, time: f64) -> Vec<(f64, f64)> {
    let within = |angle: f64| (angle / TAU * waves as f64).rem_euclid(1.0);
    let slow = |r: &&EquationResidual| r.speed.abs() * waves as f64 * time < SEEN;
    residuals
        .iter()
        .filter(slow)
        .map(|r| (within(r.angle), r.volts))
        .collect()
}

fn wave_bins(points: &[(f64, f64)]) -> Vec<Bin> {
    let n = points.len() as f64;
    let mut sums = [(0usize, 0.0); WAVE_BINS];
    let bin_of = |x: f64| ((x * WAVE_BINS as f64) as usize).min(WAVE_BINS - 1);
    for &(x, volts) in points {
        let sum = &mut sums[bin_of(x)];
        *sum = (sum.0 + 1, sum.1 + volts);
    }
    let level = |x: f64| {
        let (count, sum) = sums[bin_of(x)];
        sum / count as f64
    };
    let left: Vec<f64> = points.iter().map(|&(x, volts)| volts - level(x)).collect();
    let per_sample = (left.iter().map(|e| e * e).sum::<f64>() / n).sqrt();
    let effective = independent(&left);
    let used = sums.iter().enumerate().filter(|(_, sum)| sum.0 > 0);
    used.map(|(k, &(samples, sum))| Bin {
        low: k as f64 / WAVE_BINS as f64,
        high: (k + 1) as f64 / WAVE_BINS as f64,
        mean_v: sum / samples as f64,
        error_v: per_sample / (samples as f64 * effective / n).max(1.0).sqrt(),
        samples,
    })
    .collect()
}

/// The median of the volts in equally wide parts of the abscissa.
fn curve(mut points: Vec<(f64, f64)>, parts: usize) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let (low, width) = (first.0, (last.0 - first.0) / parts as f64);
    let part = |x: f64| (((x - low) / width) as usize).min(parts - 1);
    points
        .chunk_by(|a, b| part(a.0) == part(b.0))
        .filter(|part| part.len() >= FEWEST)
        .map(|part| {
            let mut volts: Vec<f64> = part.iter().map(|p| p.1).collect();
            volts.sort_by(f64::total_cmp);
            let x = part.iter().map(|p| p.0).sum::<f64>() / part.len() as f64;
            (x, volts[volts.len() / 2])
        })
        .collect()
}
