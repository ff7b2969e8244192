//! Residuals of a model and changes to models near it, taken a range of samples at a time and compressed to the triangle
//! of a least-squares step ([`Tangent`]).

use crate::lanes::{LANES, Triangles};
use crate::solve::Tangent;

/// The triangles of the samples so far.
pub(crate) struct TangentBuilder {
    triangles: Triangles<LANES>,
    /// Value that residuals are counted from, counts; `None` for their own mean.
    zero: Option<f64>,
    others: usize,
}

impl TangentBuilder {
    /// For a model and `others` more, with residuals about `zero` counts, or about each model's own mean.
    pub(crate) fn new(others: usize, zero: Option<f64>) -> Self {
        // Subtracting the mean is projecting out a constant column, which comes before the others.
        let constant = usize::from(zero.is_none());
        TangentBuilder {
            triangles: Triangles::new(constant + 1 + others),
            zero,
            others,
        }
    }

    /// Takes the model's errors at some samples, counts, and the changes to the others there.
    pub(crate) fn add(&mut self, here: &[f64], changes: &[&[f64]]) {
        let zero = self.zero.unwrap_or(0.0);
        for from in (0..here.len()).step_by(LANES) {
            let count = LANES.min(here.len() - from);
            // Unused lanes hold zeros.
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

    /// The tangent; `None` where an entry is not finite.
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
