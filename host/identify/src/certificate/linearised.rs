//! The readings as inequalities in the unknowns about a point.

use crate::error::Error;
use crate::fit::uncertainty::Uncertainty;
use servoid_engine::problem::FitProblem;

/// An unknown without a standard error is measured in this part of its range.
const PART_OF_RANGE: f64 = 1e-3;
/// A unit is no smaller than this part of the value: below it differences are the arithmetic's.
const PART_OF_VALUE: f64 = 1e-9;
/// Step of the differences, in units.
const STEP: f64 = 0.5;
/// No linear program goes further than so many units at a time.
const FARTHEST: f64 = 1e4;

/// The unit of each unknown: its standard error, so that all are alike.
pub struct Scale {
    /// In the unknown's unit; zero where it is fixed.
    pub units: Vec<f64>,
    /// Whether the start angle is free, a shift of all readings.
    pub shift: bool,
}

impl Scale {
    pub fn new(problem: &FitProblem<'_>, values: &[f64], spread: Option<&Uncertainty>) -> Self {
        let unit = |(k, value): (usize, &f64)| {
            let (low, high) = problem.structure.unknowns[k].range;
            let std = spread.and_then(|s| s.std(k));
            let unit = std.unwrap_or(PART_OF_RANGE * (high - low));
            unit.clamp(0.0, 0.1 * (high - low)).max(if high > low {
                PART_OF_VALUE * value.abs()
            } else {
                0.0
            })
        };
        let candidate = problem.structure.candidate(values);
        Scale {
            units: values.iter().enumerate().map(unit).collect(),
            shift: !candidate.needs_angle(),
        }
    }

    /// The values at a distance of `steps` units from others, within the search ranges.
    pub fn moved(&self, problem: &FitProblem<'_>, values: &[f64], steps: &[f64]) -> Vec<f64> {
        (values.iter().zip(&self.units).zip(steps))
            .zip(&problem.structure.unknowns)
            .map(|(((value, unit), step), unknown)| {
                (value + unit * step).clamp(unknown.range.0, unknown.range.1)
            })
            .collect()
    }

    /// Largest difference between two courses of the angle, counts, about a common shift where one is free.
    pub fn apart(&self, one: &[f64], other: &[f64]) -> f64 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (one, other) in one.iter().zip(other) {
            (low, high) = (low.min(one - other), high.max(one - other));
        }
        if self.shift {
            0.5 * (high - low)
        } else {
            high.max(-low)
        }
    }

    /// How far each unknown may go from `values` within its search range, units.
    pub fn room(&self, problem: &FitProblem<'_>, values: &[f64]) -> Vec<(f64, f64)> {
        (values.iter().zip(&self.units))
            .zip(&problem.structure.unknowns)
            .map(|((value, &unit), unknown)| {
                if unit == 0.0 {
                    return (0.0, 0.0);
                }
                let (low, high) = unknown.range;
                (
                    ((low - value) / unit).clamp(-FARTHEST, 0.0),
                    ((high - value) / unit).clamp(0.0, FARTHEST),
                )
            })
            .collect()
    }
}

/// Distance of the model above each reading's cell edge, counts, and its change with each unknown. A model reproduces the
/// readings whose distance is within 0 and 1.
pub struct Linearised {
    /// The point.
    pub values: Vec<f64>,
    /// At the point.
    pub above: Vec<f64>,
    /// Change per unit of each unknown.
    pub columns: Vec<Vec<f64>>,
}

impl Linearised {
    /// About `values`.
    pub fn about(problem: &FitProblem<'_>, scale: &Scale, values: Vec<f64>) -> Result<Self, Error> {
        let above = above(problem, &values)?;
        let mut columns = Vec::new();
        for k in 0..values.len() {
            let side = |sign: f64| {
                let mut steps = vec![0.0; values.len()];
                steps[k] = sign * STEP;
                scale.moved(problem, &values, &steps)
            };
            let (up, down) = (side(1.0), side(-1.0));
            let width = (up[k] - down[k]) / scale.units[k];
            columns.push(if width > 0.0 {
                let (ahead, behind) = (self::above(problem, &up)?, self::above(problem, &down)?);
                let slope = |(a, b): (&f64, &f64)| (a - b) / width;
                ahead.iter().zip(&behind).map(slope).collect()
            } else {
                vec![0.0; above.len()]
            });
        }
        Ok(Linearised {
            values,
            above,
            columns,
        })
    }

    /// The distances after `steps` units of each unknown and a shift, counts.
    pub fn at(&self, steps: &[f64], shift: f64) -> Vec<f64> {
        let mut all: Vec<f64> = self.above.iter().map(|above| above + shift).collect();
        for (column, &step) in self.columns.iter().zip(steps) {
            if step != 0.0 {
                for (above, slope) in all.iter_mut().zip(column) {
                    *above += slope * step;
                }
            }
        }
        all
    }
}

/// Distance of a model above the lower edge of each reading's cell, counts.
pub fn above(problem: &FitProblem<'_>, values: &[f64]) -> Result<Vec<f64>, Error> {
    let errors = problem.errors(&problem.structure.candidate(values))?;
    if errors.iter().any(|error| !error.is_finite()) {
        return Err(Error::Failed(
            "the model has no finite angle near the fit, so that nothing can be certified"
                .to_owned(),
        ));
    }
    Ok(errors)
}
