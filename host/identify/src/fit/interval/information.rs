//! Gradient and curvature of the likelihood in everything that is estimated: the unknowns, a shift of each recording whose start angle
//! is free, and the logarithm of the noise, in this order.

use super::cell::Cell;
use crate::fit::sensitivity::{SEGMENTS, Sensitivity};
use crate::fit::uncertainty::{Uncertainty, likely};
use nalgebra::{DMatrix, DVector};
use servoid_engine::problem::{FitProblem, StartAngle, Structure};

/// Which recordings have a free start angle.
pub struct Shifts {
    free: Vec<bool>,
}

impl Shifts {
    pub fn of(problem: &FitProblem<'_>, values: &[f64]) -> Self {
        let needs_angle = problem.structure.candidate(values).needs_angle();
        let free = problem.start_angle == StartAngle::Free;
        // Where effects depend on the angle, the first recording's start angle is an unknown of the model.
        let one = |recording: usize| free && (recording > 0 || !needs_angle);
        Shifts {
            free: (0..problem.data.recordings.count()).map(one).collect(),
        }
    }

    /// Place of a recording's shift among the shifts.
    pub fn place(&self, recording: usize) -> Option<usize> {
        self.free[recording].then(|| self.free[..recording].iter().filter(|free| **free).count())
    }

    fn count(&self) -> usize {
        self.free.iter().filter(|free| **free).count()
    }
}

/// Sums over the readings.
pub struct Information {
    pub shifts: Shifts,
    /// Lower triangle of the curvature, then all of it.
    curvature: DMatrix<f64>,
    /// Gradient of each time segment.
    gradients: Vec<DVector<f64>>,
    segment: usize,
    /// What a bound holds.
    held: Vec<bool>,
}

impl Information {
    pub fn new(shifts: Shifts, unknowns: usize, samples: usize) -> Self {
        let all = unknowns + shifts.count() + 1;
        Information {
            shifts,
            curvature: DMatrix::zeros(all, all),
            gradients: vec![DVector::zeros(all); SEGMENTS],
            segment: samples.div_ceil(SEGMENTS).max(1),
            held: vec![false; all],
        }
    }

    /// Adds the readings from sample `from` on, with their columns of the Jacobian.
    pub fn add(
        &mut self,
        problem: &FitProblem<'_>,
        from: usize,
        columns: &[Vec<f64>],
        cells: &[Cell],
    ) {
        let unknowns = columns.len();
        let noise = self.held.len() - 1;
        for (recording, range) in problem.data.recordings.ranges().enumerate() {
            let own = range.start.max(from)..range.end.min(from + cells.len());
            let shift = self.shifts.place(recording).map(|place| unknowns + place);
            for k in own {
                let cell = &cells[k - from];
                let gradient = &mut self.gradients[k / self.segment];
                for (i, column) in columns.iter().enumerate() {
                    let slope = column[k - from];
                    gradient[i] += cell.slope * slope;
                    let curved = cell.curvature * slope;
                    for (j, other) in columns[..=i].iter().enumerate() {
                        self.curvature[(i, j)] += curved * other[k - from];
                    }
                    if let Some(shift) = shift {
                        self.curvature[(shift, i)] += curved;
                    }
                    self.curvature[(noise, i)] += cell.mixed * slope;
                }
                if let Some(shift) = shift {
                    gradient[shift] += cell.slope;
                    self.curvature[(shift, shift)] += cell.curvature;
                    self.curvature[(noise, shift)] += cell.mixed;
                }
                gradient[noise] += cell.noise_slope;
                self.curvature[(noise, noise)] += cell.noise_curvature;
            }
        }
    }

    /// Holds what stands at a bound that the likelihood would cross. The sums are complete then.
    pub fn hold(&mut self, structure: &Structure, values: &[f64], least_noise: bool) {
        self.curvature.fill_upper_triangle_with_lower_triangle();
        let gradient = self.gradient();
        for (k, (unknown, value)) in structure.unknowns.iter().zip(values).enumerate() {
            let (low, high) = unknown.range;
            self.held[k] = low >= high
                || (*value <= low && gradient[k] > 0.0)
                || (*value >= high && gradient[k] < 0.0);
        }
        let noise = self.held.len() - 1;
        self.held[noise] = least_noise && gradient[noise] > 0.0;
        // Away from the minimum the likelihood may not curve with the noise.
        let size = self.gradients.len() as f64;
        if self.curvature[(noise, noise)] <= 0.0 {
            self.curvature[(noise, noise)] = size.max(gradient[noise].abs());
        }
    }

    pub fn is_finite(&self) -> bool {
        let gradients = self.gradients.iter().flat_map(DVector::iter);
        self.curvature
            .iter()
            .chain(gradients)
            .all(|x| x.is_finite())
    }

    fn gradient(&self) -> DVector<f64> {
        self.gradients.iter().sum()
    }

    /// A gradient without what is held.
    fn without_held(&self, mut gradient: DVector<f64>) -> DVector<f64> {
        for k in (0..self.held.len()).filter(|&k| self.held[k]) {
            gradient[k] = 0.0;
        }
        gradient
    }

    /// The curvature of what is not held; a one in the diagonal for what is, so that it stays.
    fn free_curvature(&self) -> DMatrix<f64> {
        let mut curvature = self.curvature.clone();
        for k in (0..self.held.len()).filter(|&k| self.held[k]) {
            curvature.row_mut(k).fill(0.0);
            curvature.column_mut(k).fill(0.0);
            curvature[(k, k)] = 1.0;
        }
        curvature
    }

    /// A damped step, and by how much it promises to raise the logarithm of the likelihood. `None` where the damping is too small.
    pub fn step(&self, damping: f64) -> Option<(DVector<f64>, f64)> {
        let gradient = self.without_held(self.gradient());
        let curvature = self.free_curvature();
        let scales = curvature
            .diagonal()
            .map(|x| if x > 0.0 { x.sqrt() } else { 1.0 });
        let mut scaled = DMatrix::from_fn(scales.len(), scales.len(), |i, k| {
            curvature[(i, k)] / (scales[i] * scales[k])
        });
        for k in 0..scales.len() {
            scaled[(k, k)] += damping;
        }
        let step = -scaled.cholesky()?.solve(&gradient.component_div(&scales));
        let step = step.component_div(&scales);
        let promised = -0.5 * gradient.dot(&step);
        step.iter()
            .all(|x| x.is_finite())
            .then_some((step, promised))
    }

    /// The covariance of everything that is estimated.
    pub fn uncertainty(&self, effective_samples: f64) -> Uncertainty {
        let gradients = self.gradients.iter().cloned();
        let sums = Sensitivity {
            squares: self.free_curvature(),
            gradients: gradients.map(|g| self.without_held(g)).collect(),
            redrawn: Vec::new(),
        };
        likely(&sums, effective_samples)
    }
}
