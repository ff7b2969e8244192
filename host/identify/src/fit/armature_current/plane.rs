//! Measured current regressed on a voltage and a speed, with a free zero.

use crate::fit::physical::Estimate;
use crate::fit::uncertainty::{few, independent, segments};
use nalgebra::{Matrix3, Vector3};

/// Least part of the squared determinant that three columns of length one must span.
const SPANS: f64 = 1e-12;

/// Current over a voltage and a speed.
pub struct Plane {
    /// Of the voltage, V, and of the speed, rad/s, so that columns are of one size.
    scales: [f64; 2],
    inverse: Matrix3<f64>,
    slopes: Vector3<f64>,
}

impl Plane {
    /// Through the currents that are used. `None` where the columns do not span a plane, and where the current falls with the voltage.
    pub fn through(model: &[(f64, f64)], measured: &[f64], used: &[bool]) -> Option<Self> {
        let size = |of: &dyn Fn(&(f64, f64)) -> f64| {
            let largest = model.iter().map(|at| of(at).abs()).fold(0.0, f64::max);
            if largest > 0.0 { largest } else { 1.0 }
        };
        let scales = [size(&|at| at.0), size(&|at| at.1)];
        let mut squares = Matrix3::zeros();
        let mut products = Vector3::zeros();
        let rows = model.iter().zip(measured).zip(used);
        for ((&at, &i), _) in rows.filter(|&(_, &used)| used) {
            let row = row(at, scales);
            squares += row * row.transpose();
            products += row * i;
        }
        let diagonal: f64 = squares.diagonal().iter().product();
        let spans = squares.determinant() > SPANS * diagonal;
        let inverse = squares.try_inverse().filter(|_| spans)?;
        let slopes = inverse * products;
        (slopes[0] > 0.0 && slopes.iter().all(|slope| slope.is_finite())).then_some(Plane {
            scales,
            inverse,
            slopes,
        })
    }

    /// The current there, A.
    pub fn at(&self, at: (f64, f64)) -> f64 {
        self.slopes.dot(&row(at, self.scales))
    }

    /// By how much errors of the speeds make the slopes too small, where they have this variance in each of `count` rows: the slope
    /// over the voltage, and over the speed (errors in variables; W. A. Fuller, *Measurement Error Models*, 1987, §1.1).
    pub fn attenuation(&self, variance: f64, count: usize) -> [f64; 2] {
        let squares = variance / (self.scales[1] * self.scales[1]) * count as f64;
        let lost = self.inverse * Vector3::new(0.0, squares * self.slopes[1], 0.0);
        [0, 1].map(|k| lost[k] / self.scales[k])
    }

    /// The slopes, with the larger of two standard errors: errors that are correlated over time count once a segment, as for the other
    /// parameters; and where one segment holds all that is known of the slope, each error counts alone.
    pub fn slopes(&self, model: &[(f64, f64)], measured: &[f64], used: &[bool]) -> [Estimate; 2] {
        let errors: Vec<f64> = (0..measured.len())
            .map(|k| {
                if used[k] {
                    measured[k] - self.at(model[k])
                } else {
                    0.0
                }
            })
            .collect();
        let squares: f64 = errors.iter().map(|error| error * error).sum();
        let count = segments(independent(&errors));
        let length = measured.len().div_ceil(count).max(1);
        let mut gradients = vec![Vector3::zeros(); measured.len().div_ceil(length)];
        for (k, error) in errors.iter().enumerate().filter(|&(k, _)| used[k]) {
            gradients[k / length] += row(model[k], self.scales) * *error;
        }
        let middle: Matrix3<f64> = gradients.iter().map(|g| g * g.transpose()).sum();
        let middle = middle * few(gradients.len());
        let sandwich = self.inverse * middle * self.inverse;
        let count = used.iter().filter(|&&used| used).count() as f64;
        let alone = self.inverse * (squares / (count - 3.0).max(1.0));
        [0, 1].map(|k| Estimate {
            value: self.slopes[k] / self.scales[k],
            std: sandwich[(k, k)].max(alone[(k, k)]).sqrt() / self.scales[k],
        })
    }
}

/// A row of the regression.
fn row((volts, speed): (f64, f64), scales: [f64; 2]) -> Vector3<f64> {
    Vector3::new(volts / scales[0], speed / scales[1], 1.0)
}
