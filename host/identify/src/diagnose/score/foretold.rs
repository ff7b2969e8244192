//! What a smooth function of the command and the predicted motion foretells of the innovations: where it foretells nothing, no physics
//! of this motor alone is missing. Its inputs must be known before the reading: measured motion holds the very noise that is to be
//! foretold.
//!
//! A ridge regression (A. E. Hoerl and R. W. Kennard, *Technometrics* 12, 55, 1970), cross-validated by interleaved blocks of time.

use super::gains::Filter;
use super::readings::Readings;
use super::settings::{
    BLOCKS, FALLING, FEWEST_READINGS, FOLDS, ORDERS, RIDGE, SINCE_REVERSAL_S, SLOW,
};
use crate::likelihood::HUBER;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// How much is foretold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foretold {
    /// Part of the innovations' variance; below zero where chance foretells worse than nothing.
    pub share: f64,
    /// The inputs that foretell most alone, if they foretell anything: `speed`, `direction`, `acceleration`, `command`, `reversal`,
    /// `angle`, `load` or `time`.
    pub from: Option<&'static str>,
}

/// What is foretold of the innovations `errors`, counts, one a reading. `None` where there are too few readings in motion.
pub fn foretold(readings: &Readings<'_>, filter: &Filter, errors: &[f64]) -> Option<Foretold> {
    let rows = rows(readings, filter, errors);
    if rows.target.len() < FEWEST_READINGS {
        return None;
    }
    let all: Vec<&Vec<f64>> = rows
        .groups
        .iter()
        .flat_map(|(_, columns)| columns)
        .collect();
    let share = crossed(&all, &rows)?;
    let alone = rows.groups.iter().filter_map(|(name, columns)| {
        let columns: Vec<&Vec<f64>> = columns.iter().collect();
        Some((crossed(&columns, &rows)?, *name))
    });
    let most = alone.max_by(|a, b| a.0.total_cmp(&b.0));
    Some(Foretold {
        share,
        from: most.filter(|(share, _)| *share > 0.0).map(|(_, name)| name),
    })
}

/// Inputs and target at the readings in motion.
struct Rows {
    target: Vec<f64>,
    block: Vec<usize>,
    groups: Vec<(&'static str, Vec<Vec<f64>>)>,
}

/// The predicted motion at one reading.
struct Seen {
    place: usize,
    speed: f64,
    acceleration: f64,
    angle: f64,
    command: f64,
    since_reversal: f64,
    time: f64,
}

fn rows(readings: &Readings<'_>, filter: &Filter, errors: &[f64]) -> Rows {
    let seen = seen(readings, filter, errors);
    let fastest = largest(seen.iter().map(|s| s.speed));
    let hardest = largest(seen.iter().map(|s| s.acceleration));
    let highest = largest(seen.iter().map(|s| s.command));
    let duration = readings.data.duration_s().max(f64::MIN_POSITIVE);
    let column = |of: &dyn Fn(&Seen) -> f64| -> Vec<f64> { seen.iter().map(of).collect() };
    let speed = |s: &Seen| s.speed / fastest;
    let direction = |s: &Seen| libm::tanh(speed(s) / SLOW);
    let acceleration = |s: &Seen| (s.acceleration / hardest).clamp(-1.0, 1.0);
    let command = |s: &Seen| s.command / highest;
    let falling = |s: &Seen, part: f64| libm::exp(-(speed(s) / part).powi(2));
    let mut falls = Vec::new();
    for part in FALLING {
        falls.push(column(&|s| falling(s, part)));
        falls.push(column(&|s| direction(s) * falling(s, part)));
    }
    let polynomial: [&dyn Fn(&Seen) -> f64; 4] = [
        &speed,
        &|s| speed(s).abs(),
        &|s| speed(s) * speed(s).abs(),
        &|s| speed(s).powi(3),
    ];
    falls.extend(polynomial.map(column));
    let reversal = SINCE_REVERSAL_S
        .iter()
        .flat_map(|seconds| {
            let decayed = move |s: &Seen| libm::exp(-s.since_reversal / seconds);
            [column(&|s| decayed(s) * direction(s)), column(&decayed)]
        })
        .collect();
    let angles = (1..=ORDERS)
        .flat_map(|order| {
            let turned = move |s: &Seen| f64::from(order) * s.angle;
            [
                column(&|s| libm::sin(turned(s))),
                column(&|s| libm::cos(turned(s))),
            ]
        })
        .collect();
    let groups = vec![
        ("direction", vec![column(&direction)]),
        ("speed", falls),
        (
            "acceleration",
            vec![
                column(&acceleration),
                column(&|s| acceleration(s).abs()),
                column(&|s| acceleration(s) * direction(s)),
            ],
        ),
        (
            "command",
            vec![column(&command), column(&|s| libm::tanh(command(s) / SLOW))],
        ),
        ("reversal", reversal),
        ("angle", angles),
        (
            "load",
            vec![
                column(&|s| direction(s) * libm::sin(s.angle).abs()),
                column(&|s| direction(s) * libm::cos(s.angle).abs()),
            ],
        ),
        (
            "time",
            vec![
                column(&|s| s.time / duration),
                column(&|s| (s.time / duration).powi(2)),
            ],
        ),
    ];
    let block = |s: &Seen| (s.time / duration * BLOCKS as f64) as usize % FOLDS;
    let standardised = |s: &Seen| {
        let deviation = filter.variances[s.place].sqrt();
        (errors[s.place] / deviation).clamp(-HUBER, HUBER)
    };
    Rows {
        target: seen.iter().map(standardised).collect(),
        block: seen.iter().map(block).collect(),
        groups,
    }
}

/// The observer's predicted motion at the readings in motion.
fn seen(readings: &Readings<'_>, filter: &Filter, errors: &[f64]) -> Vec<Seen> {
    let data = readings.data;
    let radians = TAU / data.units.counts_per_rev;
    let mut all = Vec::new();
    for own in &readings.recordings {
        let (mut speed_before, mut direction, mut reversed) = (0.0, 0.0, f64::NEG_INFINITY);
        let fastest = data.units.speed;
        for place in own.clone().skip(1) {
            let (sample, before) = (readings.samples[place], readings.samples[place - 1]);
            let elapsed = data.time_s[sample] - data.time_s[before];
            let predicted = |k: usize| data.centre(readings.samples[k]) + errors[k];
            let corrected =
                predicted(place - 1) - filter.corrections[place - 1].angle * errors[place - 1];
            let speed = (predicted(place) - corrected) * radians / elapsed;
            if speed.abs() > SLOW * fastest && speed.signum() != direction {
                (direction, reversed) = (speed.signum(), data.time_s[sample]);
            }
            if readings.weights[place] > 0.5 {
                all.push(Seen {
                    place,
                    speed,
                    acceleration: (speed - speed_before) / elapsed,
                    angle: predicted(place) * radians,
                    command: data.command[before],
                    since_reversal: data.time_s[sample] - reversed,
                    time: data.time_s[sample],
                });
            }
            speed_before = speed;
        }
    }
    all
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    let largest = values.fold(0.0f64, |most, value| most.max(value.abs()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// Part of the target's squares that the columns, and those of the reading before, foretell in blocks that they were not fitted on.
fn crossed(columns: &[&Vec<f64>], rows: &Rows) -> Option<f64> {
    let n = rows.target.len();
    let width = 2 * columns.len();
    let value = |row: usize, at: usize| columns[at / 2][row.saturating_sub(at % 2)];
    let mut matrix = DMatrix::from_fn(n, width, value);
    for mut column in matrix.column_iter_mut() {
        let mean = column.mean();
        let deviation = column.variance().sqrt().max(f64::EPSILON);
        column.iter_mut().for_each(|v| *v = (*v - mean) / deviation);
    }
    let target = DVector::from_column_slice(&rows.target);
    let of_fold: Vec<(DMatrix<f64>, DVector<f64>)> = (0..FOLDS)
        .map(|fold| {
            let own: Vec<usize> = (0..n).filter(|&row| rows.block[row] == fold).collect();
            (matrix.select_rows(&own), target.select_rows(&own))
        })
        .collect();
    let (mut left, mut all) = (0.0, 0.0);
    for fold in 0..FOLDS {
        let mut normal = DMatrix::identity(width, width) * RIDGE;
        let mut right = DVector::zeros(width);
        let others = || of_fold.iter().enumerate().filter(|(k, _)| *k != fold);
        let readings: usize = others().map(|(_, (_, y))| y.len()).sum();
        let mean = others().map(|(_, (_, y))| y.sum()).sum::<f64>() / readings.max(1) as f64;
        for (_, (x, y)) in others() {
            normal += x.transpose() * x;
            right += x.transpose() * y.add_scalar(-mean);
        }
        let weights = normal.cholesky()?.solve(&right);
        let (x, y) = &of_fold[fold];
        let centred = y.add_scalar(-mean);
        left += (&centred - x * weights).norm_squared();
        all += centred.norm_squared();
    }
    let share = 1.0 - left / all;
    share.is_finite().then_some(share)
}
