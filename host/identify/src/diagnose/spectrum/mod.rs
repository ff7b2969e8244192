//! All the orders of a cogging torque at once. A model holds one; magnets and teeth make several, which are
//! found one by one and then fitted together, by regression on the equation of motion.

pub mod orders;
mod settings;
mod waves;

pub use orders::{Line, lines};
use settings::{MOST, WORTH};

use crate::fit::scores::{EquationResidual, filtered_values};
use nalgebra::{DMatrix, DVector};
use orders::{Filtered, clearest, lines_of, others};
use servoid_engine::problem::{Candidate, Data};

/// The orders of a cogging torque.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// In the order in which they were found, the strongest first.
    pub lines: Vec<Line>,
    /// Part of the drive's RMS about its mean that they leave unexplained, with friction and the linear motor
    /// fitted beside them.
    pub unexplained: f64,
}

/// The orders that explain what the equation of `candidate`, a model without cogging, leaves. They have the
/// sign of a torque against the motion, V.
pub fn spectrum(data: &Data, candidate: &Candidate) -> Spectrum {
    let Filtered {
        time,
        residuals: left,
        ..
    } = clearest(data, candidate);
    let mut columns = beside(&left);
    let mut lines: Vec<Line> = Vec::new();
    let Some((mut solution, mut rest)) = solve(&left, &columns) else {
        return Spectrum {
            lines,
            unexplained: 1.0,
        };
    };
    let others = columns.len();
    while lines.len() < MOST {
        let known: Vec<usize> = lines.iter().map(|line| line.order).collect();
        let next = lines_of(data, &rest, time)
            .into_iter()
            .find(|line| !known.contains(&line.order));
        let Some(next) = next.filter(|line| line.explains > WORTH) else {
            break;
        };
        columns.extend(waves(data, &left, next.order, time));
        let Some((found, still)) = solve(&left, &columns) else {
            break;
        };
        (solution, rest) = (found, still);
        lines.push(next);
    }
    for (line, pair) in lines
        .iter_mut()
        .zip(solution[others.min(solution.len())..].chunks(2))
    {
        if let [cosine, sine] = *pair {
            (line.cosine, line.sine) = (cosine, sine);
        }
    }
    Spectrum {
        unexplained: (squares(&rest) / driven(data, &left, time)).sqrt(),
        lines,
    }
}

/// What is fitted beside the orders.
fn beside(left: &[EquationResidual]) -> Vec<Vec<f64>> {
    let column = |j: usize| left.iter().map(|r| others(r)[j]).collect();
    (0..4).map(column).collect()
}

/// Cosine and sine of the angle's multiple, through the filter that the residual has passed.
fn waves(data: &Data, left: &[EquationResidual], order: usize, time: f64) -> [Vec<f64>; 2] {
    let phase = |k: usize| {
        let turns = (data.centre(k) / data.units.counts_per_rev).rem_euclid(1.0);
        order as f64 * turns * core::f64::consts::TAU
    };
    [libm::cos, libm::sin].map(|wave| {
        let signal: Vec<f64> = (0..data.len()).map(|k| wave(phase(k))).collect();
        let filtered = filtered_values(data, time, &signal);
        left.iter().map(|r| filtered[r.sample]).collect()
    })
}

/// Least squares; gives the coefficients and what they leave.
fn solve(
    left: &[EquationResidual],
    columns: &[Vec<f64>],
) -> Option<(Vec<f64>, Vec<EquationResidual>)> {
    let scales: Vec<f64> = columns
        .iter()
        .map(|column| column.iter().map(|x| x * x).sum::<f64>().sqrt())
        .collect();
    let scaled = |row: usize, j: usize| columns[j][row] / scales[j].max(f64::MIN_POSITIVE);
    let matrix = DMatrix::from_fn(left.len(), columns.len(), scaled);
    let right = DVector::from_iterator(left.len(), left.iter().map(|r| r.volts));
    let normal = matrix.tr_mul(&matrix);
    let solution = normal
        .svd(true, true)
        .solve(&matrix.tr_mul(&right), 1e-12)
        .ok()?;
    let rest = right - &matrix * &solution;
    if !rest.iter().all(|r| r.is_finite()) {
        return None;
    }
    let rest = left.iter().zip(rest.iter());
    let rest = rest.map(|(r, &volts)| EquationResidual { volts, ..*r });
    let solution = solution.iter().zip(&scales);
    Some((
        solution
            .map(|(x, s)| x / s.max(f64::MIN_POSITIVE))
            .collect(),
        rest.collect(),
    ))
}

fn squares(left: &[EquationResidual]) -> f64 {
    left.iter().map(|r| r.volts * r.volts).sum()
}

/// Square of the drive about its mean, at the residuals' samples.
fn driven(data: &Data, left: &[EquationResidual], time: f64) -> f64 {
    let command: Vec<f64> = data.command.iter().map(|v| v * data.units.volts).collect();
    let command = filtered_values(data, time, &command);
    let count = left.len().max(1) as f64;
    let mean = left.iter().map(|r| command[r.sample]).sum::<f64>() / count;
    let squares: f64 = left
        .iter()
        .map(|r| (command[r.sample] - mean).powi(2))
        .sum();
    squares.max(f64::MIN_POSITIVE)
}
