//! Orders of the angle at which a torque repeats, read off the equation's residual.
//!
//! The error of a simulation as a function of the order has a narrow valley at each order that is there,
//! so a descent must start in the right one.

use crate::fit::scores::{EquationResidual, equation_residuals};
use crate::problem::{Candidate, Data};

/// Highest order that is looked for.
pub const HIGHEST: usize = 128;
/// Filter time of the equation's residual, sample intervals.
pub const FILTER_SAMPLES: f64 = 3.0;
/// A line is taken where it turns by less than this many radians within the filter's time; faster ones
/// are worn away by it.
const FASTEST: f64 = 0.35;
/// Fewest samples slow enough for a line to count.
const FEWEST: f64 = 200.0;

/// A line of the spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Waves a revolution.
    pub order: usize,
    /// Amplitude of `cos(kθ)`, V.
    pub cosine: f64,
    /// Amplitude of `sin(kθ)`, V.
    pub sine: f64,
    /// Part of the residual's square that it explains where it can be seen.
    pub explains: f64,
}

impl Line {
    /// Amplitude, V.
    pub fn amplitude(&self) -> f64 {
        self.cosine.hypot(self.sine)
    }

    /// Angle of the shaft, rad, at which the first wave is highest, as a part of the wave: `atan2(sine,
    /// cosine)`.
    pub fn phase(&self) -> f64 {
        self.sine.atan2(self.cosine)
    }
}

/// The strongest lines in what the model's equation leaves unexplained, strongest first.
pub fn lines(data: &Data, candidate: &Candidate) -> Vec<Line> {
    let time = FILTER_SAMPLES * data.units.interval;
    let residuals = equation_residuals(data, candidate, time);
    let residuals = without_friction(residuals);
    lines_of(data, &residuals, time)
}

/// The lines of residuals that were filtered with `time` (s), strongest first.
pub fn lines_of(data: &Data, residuals: &[EquationResidual], time: f64) -> Vec<Line> {
    // Positions within the revolution, not since the start.
    let first = data.centre(0) / data.units.counts_per_rev * core::f64::consts::TAU;
    let mut sums = vec![[0.0f64; 4]; HIGHEST + 1];
    for r in residuals {
        let (sine, cosine) = (r.angle + first).sin_cos();
        let (mut c, mut s) = (1.0, 0.0);
        let reach = FASTEST / (r.speed.abs() * time).max(1e-9);
        for sums in sums
            .iter_mut()
            .take(HIGHEST.min(reach as usize) + 1)
            .skip(1)
        {
            (c, s) = (c * cosine - s * sine, s * cosine + c * sine);
            sums[0] += r.volts * c;
            sums[1] += r.volts * s;
            sums[2] += r.volts * r.volts;
            sums[3] += 1.0;
        }
    }
    let mut lines: Vec<Line> = sums
        .iter()
        .enumerate()
        .skip(1)
        .filter(|(_, sums)| sums[3] > FEWEST && sums[2] > 0.0)
        .map(|(order, [c, s, squares, n])| {
            let (cosine, sine) = (2.0 * c / n, 2.0 * s / n);
            Line {
                order,
                cosine,
                sine,
                explains: 0.5 * n * (cosine * cosine + sine * sine) / squares,
            }
        })
        .collect();
    lines.sort_by(|a, b| b.explains.total_cmp(&a.explains));
    lines
}

/// Takes the mean of each direction of motion off, so that friction does not hide the lines.
fn without_friction(mut residuals: Vec<EquationResidual>) -> Vec<EquationResidual> {
    for forward in [true, false] {
        let of = |r: &&EquationResidual| (r.speed > 0.0) == forward;
        let count = residuals.iter().filter(of).count();
        let mean = residuals.iter().filter(of).map(|r| r.volts).sum::<f64>() / count.max(1) as f64;
        for r in residuals.iter_mut().filter(|r| (r.speed > 0.0) == forward) {
            r.volts -= mean;
        }
    }
    residuals
}
