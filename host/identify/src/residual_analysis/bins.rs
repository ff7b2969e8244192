//! Missing volts against one quantity, as the mean in each of a few bins.

use crate::fit::scores::EquationResidual;
use servoid_engine::problem::Data;
use shared::motor::Machine;
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// What the missing volts are drawn against.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Speed, by direction, rad/s.
    Speed,
    /// Command, V.
    Voltage,
    /// Current as the voltage across the resistance, V, from command and speed.
    Current,
    /// Time since the start, s; volts against the motion.
    Time,
    /// Time since the motion last reversed, s; volts against the motion.
    Reversal,
}

impl Against {
    /// All of them.
    pub const ALL: [Against; 5] = [
        Against::Speed,
        Against::Voltage,
        Against::Current,
        Against::Time,
        Against::Reversal,
    ];

    /// Its name in JSON and in sentences, and its unit.
    pub fn name(self) -> (&'static str, &'static str) {
        match self {
            Against::Speed => ("speed", "rad/s"),
            Against::Voltage => ("voltage", "V"),
            Against::Current => ("current", "V across the winding"),
            Against::Time => ("time", "s"),
            Against::Reversal => ("time_since_reversal", "s"),
        }
    }

    /// Its unit where the command is in a unit of this symbol.
    pub fn unit(self, command: &'static str) -> &'static str {
        match self {
            Against::Voltage | Against::Current if command != "V" => command,
            _ => self.name().1,
        }
    }

    /// Whether the volts are counted against the motion, instead of against forward motion.
    pub fn turned(self) -> bool {
        matches!(self, Against::Time | Against::Reversal)
    }
}

/// The mean in one bin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bin {
    /// Least value of the quantity.
    pub low: f64,
    /// Greatest value.
    pub high: f64,
    /// Mean of the missing volts, V: a torque against forward motion (or, against time, against the motion)
    /// counts positive.
    pub mean_v: f64,
    /// Its standard error with as many samples as are independent, V.
    pub error_v: f64,
    /// Samples.
    pub samples: usize,
}

/// Missing volts against one quantity.
#[derive(Clone, Debug)]
pub struct Map {
    /// The quantity.
    pub against: Against,
    /// Share of the variance beyond the encoder's own that the bins explain, less what they would by chance.
    pub share: f64,
    /// The part of that variance that is left by the maps before it, and explained by this one: over all maps these sum to what
    /// they explain together. Zero where the map is not beyond chance. Time and the time since a reversal come last.
    pub own_share: f64,
    /// Whether they explain more than bins do by chance once in a thousand.
    pub beyond_chance: bool,
    /// Samples that count as independent.
    pub effective_samples: f64,
    /// From low to high.
    pub bins: Vec<Bin>,
}

/// Bins of a quantity; of the speed in each direction.
const BINS: usize = 9;
const SPEED_BINS: usize = 5;
/// Slower than this part of the fastest counts as rest.
pub const REST: f64 = 0.01;
/// Fewest samples that say anything.
const FEWEST: usize = 100;
/// Correlations are summed over at most so many samples, evenly picked.
const PICKED: usize = 4000;
/// A map that explains less than this part of what a perfect model would show says nothing.
const NOTICED: f64 = 0.1;
/// Chance at which a share is believed.
const CHANCE: f64 = 1e-3;

impl Map {
    /// The map of `residuals`, of whose variance `noise` (V²) is the encoder's. `None` where there is too little.
    pub fn new(
        against: Against,
        data: &Data,
        machine: &Machine<f64>,
        residuals: &[EquationResidual],
        noise: f64,
    ) -> Option<Map> {
        let mut points = points(against, data, machine, residuals);
        if points.len() < FEWEST {
            return None;
        }
        let mean = points.iter().map(|p| p.volts).sum::<f64>() / points.len() as f64;
        let fastest = points.iter().fold(0.0f64, |m, p| m.max(p.x.abs()));
        let bin_of = edges(against, &points, fastest);
        let mut sums = vec![(0usize, 0.0, f64::INFINITY, f64::NEG_INFINITY); bin_of.count()];
        for p in &points {
            let sum = &mut sums[bin_of.index(p.x)];
            *sum = (sum.0 + 1, sum.1 + p.volts, sum.2.min(p.x), sum.3.max(p.x));
        }
        // What the bins explain and what they leave.
        let n = points.len() as f64;
        let (mut between, mut within) = (0.0, 0.0);
        for p in &mut points {
            let sum = &sums[bin_of.index(p.x)];
            let level = sum.1 / sum.0 as f64;
            between += (level - mean).powi(2);
            within += (p.volts - level).powi(2);
            p.volts -= level;
        }
        // The mean itself is missing voltage too.
        let explained = between / n + mean * mean;
        let used = sums.iter().filter(|sum| sum.0 > 0).count() as f64;
        let left: Vec<f64> = points.iter().map(|p| p.volts).collect();
        let effective = independent(&left).max(used + 2.0);
        let by_chance = used * within / n / (effective - used);
        let beyond = (explained + within / n - noise)
            .max(explained)
            .max(f64::MIN_POSITIVE);
        let ratio = explained / used / (within / n / (effective - used)).max(f64::MIN_POSITIVE);
        let law = FisherSnedecor::new(used, effective - used).ok();
        // Volts beyond all numbers have no chance that could be told.
        let law = law.filter(|_| ratio.is_finite());
        let chance = law.map_or(1.0, |law| law.sf(ratio));
        let per_sample = (within / n).sqrt();
        Some(Map {
            against,
            share: ((explained - by_chance) / beyond).clamp(0.0, 1.0),
            own_share: 0.0,
            beyond_chance: chance < CHANCE && explained > NOTICED * noise,
            effective_samples: effective,
            bins: sums
                .iter()
                .filter(|sum| sum.0 > 0)
                .map(|&(samples, total, low, high)| Bin {
                    low,
                    high,
                    mean_v: total / samples as f64,
                    error_v: per_sample / (samples as f64 * effective / n).max(1.0).sqrt(),
                    samples,
                })
                .collect(),
        })
    }
}

/// Tells each of `maps` what it explains of what the ones before leave, as parts of the variance beyond the encoder's `noise`, V². Speed,
/// voltage and current come first, as they stand in the list; time and the time since a reversal tell what those do not.
pub fn decompose(
    maps: &mut [Map],
    data: &Data,
    machine: &Machine<f64>,
    residuals: &[EquationResidual],
    noise: f64,
) {
    let whole = mean_square(residuals);
    let beyond = (whole - noise).max(f64::MIN_POSITIVE);
    let mut rest = residuals.to_vec();
    let mut left = 1.0f64;
    for map in in_turn(maps) {
        let Some(again) = Map::new(map.against, data, machine, &rest, noise) else {
            continue;
        };
        let before = mean_square(&rest);
        again.take_out(data, machine, &mut rest);
        // The encoder's part is explained by chance alone, and no share of what is missing.
        map.own_share = ((before - mean_square(&rest)) / beyond).clamp(0.0, left);
        left -= map.own_share;
    }
}

/// The maps that are beyond chance, in the order in which they explain.
fn in_turn(maps: &mut [Map]) -> Vec<&mut Map> {
    let mut some: Vec<&mut Map> = maps.iter_mut().filter(|map| map.beyond_chance).collect();
    some.sort_by_key(|map| map.against.turned());
    some
}

/// Mean of the squares of the missing volts, V².
pub fn mean_square(residuals: &[EquationResidual]) -> f64 {
    let squares: f64 = residuals.iter().map(|r| r.volts * r.volts).sum();
    squares / residuals.len().max(1) as f64
}

impl Map {
    /// Subtracts the mean of its bin from each residual.
    fn take_out(&self, data: &Data, machine: &Machine<f64>, residuals: &mut [EquationResidual]) {
        for point in points(self.against, data, machine, residuals) {
            let bin = self.bins.partition_point(|bin| bin.high < point.x);
            let Some(bin) = self.bins.get(bin) else {
                continue;
            };
            let residual = &mut residuals[point.index];
            let sign = if self.against.turned() {
                residual.speed.signum()
            } else {
                1.0
            };
            residual.volts -= bin.mean_v * sign;
        }
    }
}

/// A residual against a quantity.
pub(super) struct Point {
    /// Place among the residuals.
    index: usize,
    /// The quantity.
    pub(super) x: f64,
    /// Missing volts, against the motion where those are counted so.
    pub(super) volts: f64,
}

/// The residuals against a quantity, where it is defined.
pub(super) fn points(
    against: Against,
    data: &Data,
    machine: &Machine<f64>,
    residuals: &[EquationResidual],
) -> Vec<Point> {
    let slow = REST * data.units.speed;
    let (mut forward, mut since) = (0.0, 0.0);
    let mut points = Vec::with_capacity(residuals.len());
    for (index, r) in residuals.iter().enumerate() {
        let now = data.time_s[r.sample];
        if r.speed.abs() > slow && r.speed.signum() != forward {
            // The first motion is no reversal.
            since = now;
            forward = r.speed.signum();
        }
        let x = match against {
            Against::Speed => r.speed,
            Against::Voltage => r.command,
            Against::Current => r.command - machine.kb * r.speed,
            Against::Time => now,
            Against::Reversal => now - since,
        };
        if against.turned() && r.speed.abs() <= slow {
            continue;
        }
        let volts = if against.turned() {
            r.volts * r.speed.signum()
        } else {
            r.volts
        };
        points.push(Point { index, x, volts });
    }
    points
}

/// Upper edges of all bins but the last.
struct Edges(Vec<f64>);

impl Edges {
    fn count(&self) -> usize {
        self.0.len() + 1
    }

    fn index(&self, x: f64) -> usize {
        self.0.partition_point(|edge| *edge < x)
    }
}

/// Bins that hold equally many samples each; of the speed in each direction, with one for rest between them; of
/// time equally long ones.
fn edges(against: Against, points: &[Point], fastest: f64) -> Edges {
    let mut sorted: Vec<f64> = points.iter().map(|p| p.x).collect();
    sorted.sort_by(f64::total_cmp);
    let mut edges = match against {
        Against::Time => {
            let end = sorted.last().copied().unwrap_or(0.0);
            (1..BINS).map(|k| end * k as f64 / BINS as f64).collect()
        }
        Against::Speed => {
            let slow = REST * fastest;
            let back = sorted.partition_point(|x| *x < -slow);
            let ahead = sorted.partition_point(|x| *x <= slow);
            let mut edges = quantiles(&sorted[..back], SPEED_BINS);
            edges.extend([-slow, slow]);
            edges.extend(quantiles(&sorted[ahead..], SPEED_BINS));
            edges
        }
        _ => quantiles(&sorted, BINS),
    };
    edges.dedup();
    Edges(edges)
}

fn quantiles(sorted: &[f64], bins: usize) -> Vec<f64> {
    if sorted.is_empty() {
        return Vec::new();
    }
    (1..bins).map(|k| sorted[sorted.len() * k / bins]).collect()
}

/// Samples divided by the sum of their autocorrelation as far as it is positive (Geyer, *Statistical Science*
/// 7(4), 1992).
pub(super) fn independent(volts: &[f64]) -> f64 {
    let stride = volts.len().div_ceil(PICKED).max(1);
    let picked: Vec<f64> = volts.iter().copied().step_by(stride).collect();
    let n = picked.len();
    let square: f64 = picked.iter().map(|x| x * x).sum();
    if square <= 0.0 {
        return n as f64;
    }
    let mut sum = 0.0;
    for lag in 1..n / 2 {
        let product: f64 = picked.iter().zip(&picked[lag..]).map(|(a, b)| a * b).sum();
        let correlation = product / square;
        if correlation <= 0.05 {
            break;
        }
        sum += correlation;
    }
    n as f64 / (1.0 + 2.0 * sum)
}
