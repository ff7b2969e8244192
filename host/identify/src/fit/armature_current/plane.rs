//! Measured current regressed on a voltage and a speed, with a free zero.

use super::least_squares::LeastSquares;
use crate::fit::physical::Estimate;
use nalgebra::{Matrix3, Vector3};

/// Least part of the squared determinant that three columns of length one must span.
const SPANS: f64 = 1e-12;

/// Current over a voltage and a speed.
pub struct Plane {
    /// Of the voltage, V, and of the speed, rad/s, so that columns are of one size.
    scales: [f64; 2],
    fitted: LeastSquares<3>,
}

impl Plane {
    /// Through the currents that are used. `None` where the columns do not span a plane, and where the current falls with the voltage.
    pub fn through(model: &[(f64, f64)], measured: &[f64], used: &[bool]) -> Option<Self> {
        let size = |of: &dyn Fn(&(f64, f64)) -> f64| {
            let largest = model.iter().map(|at| of(at).abs()).fold(0.0, f64::max);
            if largest > 0.0 { largest } else { 1.0 }
        };
        let scales = [size(&|at| at.0), size(&|at| at.1)];
        let (rows, currents) = rows(model, measured, used, scales);
        let spans = |squares: &Matrix3<f64>| {
            let diagonal: f64 = squares.diagonal().iter().product();
            squares.determinant() > SPANS * diagonal
        };
        let fitted = LeastSquares::through(&rows, &currents, spans)?;
        let slopes = &fitted.slopes;
        let known = slopes[0] > 0.0 && slopes.iter().all(|slope| slope.is_finite());
        known.then_some(Plane { scales, fitted })
    }

    /// The current there, A.
    pub fn at(&self, at: (f64, f64)) -> f64 {
        self.fitted.slopes.dot(&row(at, self.scales))
    }

    /// By how much errors of the speeds make the slopes too small, where they have this variance in each of `count` rows: the slope
    /// over the voltage, and over the speed (errors in variables; W. A. Fuller, *Measurement Error Models*, 1987, §1.1).
    pub fn attenuation(&self, variance: f64, count: usize) -> [f64; 2] {
        let squares = variance / (self.scales[1] * self.scales[1]) * count as f64;
        let lost = self.fitted.inverse * Vector3::new(0.0, squares * self.fitted.slopes[1], 0.0);
        [0, 1].map(|k| lost[k] / self.scales[k])
    }

    /// The slopes, with the larger of two standard errors: errors that are correlated over time count once a segment, as for the other
    /// parameters; and where one segment holds all that is known of the slope, each error counts alone.
    pub fn slopes(&self, model: &[(f64, f64)], measured: &[f64], used: &[bool]) -> [Estimate; 2] {
        let (rows, currents) = rows(model, measured, used, self.scales);
        let errors = self.fitted.errors(&rows, &currents);
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        let sandwich = self.fitted.sandwich(&rows, &errors);
        let count = used.iter().filter(|&&used| used).count() as f64;
        let alone = self.fitted.inverse * (squares / (count - 3.0).max(1.0));
        [0, 1].map(|k| Estimate {
            value: self.fitted.slopes[k] / self.scales[k],
            std: sandwich[(k, k)].max(alone[(k, k)]).sqrt() / self.scales[k],
        })
    }
}

/// The rows of the regression and the currents; zeros for what is not used.
fn rows(
    model: &[(f64, f64)],
    measured: &[f64],
    used: &[bool],
    scales: [f64; 2],
) -> (Vec<Vector3<f64>>, Vec<f64>) {
    let all = model.iter().zip(measured).zip(used);
    all.map(|((&at, &current), &used)| {
        if used {
            (row(at, scales), current)
        } else {
            (Vector3::zeros(), 0.0)
        }
    })
    .unzip()
}

/// A row of the regression.
fn row((volts, speed): (f64, f64), scales: [f64; 2]) -> Vector3<f64> {
    Vector3::new(volts / scales[0], speed / scales[1], 1.0)
}
