//! Errors of a model and of others near it, as they come, compressed to what a least-squares step needs.

use crate::lanes::{LANES, Triangles};
use crate::solve::Tangent;

/// The compression so far.
pub(crate) struct TangentBuilder {
    triangles: Triangles<LANES>,
    /// What residuals are counted from; `None` for their own mean.
    zero: Option<f64>,
    others: usize,
}

impl TangentBuilder {
    /// Of a model and so many others, with residuals about `zero`, or about the mean of each model's own.
    pub(crate) fn new(others: usize, zero: Option<f64>) -> Self {
        // To count from the mean is to be orthogonal to a constant: that is a column before the others.
        let constant = usize::from(zero.is_none());
        TangentBuilder {
            triangles: Triangles::new(constant + 1 + others),
            zero,
            others,
        }
    }

    /// Takes some samples' errors of the model, and by how much those of the others differ.
    pub(crate) fn add(&mut self, here: &[f64], changes: &[&[f64]]) {
        let zero = self.zero.unwrap_or(0.0);
        for from in (0..here.len()).step_by(LANES) {
            let count = LANES.min(here.len() - from);
            // What is left of the last lanes says nothing.
            let mut ones = [0.0; LANES];
            ones[..count].fill(1.0);
            let constant = self.zero.is_none().then_some(ones);
            let some = |values: &[f64]| {
                let mut some = [0.0; LANES];
                some[..count].copy_from_slice(&values[from..from + count]);
                some
            };
            let mut residuals = some(here);
            for (residual, one) in residuals.iter_mut().zip(ones) {
                *residual -= zero * one;
            }
            let changes = changes.iter().map(|values| some(values));
            self.triangles
                .push(constant.into_iter().chain([residuals]).chain(changes));
        }
    }

    /// The tangent; `None` where a number is none.
    pub(crate) fn finish(self) -> Option<Tangent> {
        let constant = usize::from(self.zero.is_none());
        let width = 1 + self.others;
        let whole = self.triangles.together();
        let triangle = whole.view((constant, constant), (width, width));
        let finite = triangle.iter().all(|x| x.is_finite());
        finite.then(|| Tangent {
            triangle: triangle.into_owned(),
            possible: vec![true; self.others],
        })
    }
}
