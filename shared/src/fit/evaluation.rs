//! One candidate along the trace, so many samples at a time.

use super::{Arithmetic, Point, Space};
use crate::model::{Motion, Rigid};
use crate::scalar::{ErrorValue, Readable, Scalar};
use crate::trace::Trace;

/// Samples between two looks at the bound.
const BLOCK: usize = 64;

/// Largest mean error that where the shaft stood within a count can explain, counts.
const UNKNOWN_START: f64 = 0.5;

type ErrorOf<S> = <<S as Scalar>::Angle as Readable<S>>::Error;

/// Room for as many models as ever run side by side.
pub(super) type Runs<S> = [Option<Evaluation<S>>; 3];

/// Puts the motor at `x` into `slot`; says whether there is one. Out of line, so that its copies of a model stand on the
/// stack no longer than it runs.
#[inline(never)]
pub(super) fn build<S: Arithmetic>(
    slot: &mut Option<Evaluation<S>>,
    space: &Space,
    x: &Point,
    bound: f32,
) -> bool {
    *slot = space
        .model::<S>(x)
        .ok()
        .map(|model| Evaluation::new(model, bound));
    slot.is_some()
}

/// A rigid motor that follows a trace from standstill, and how far it strays.
///
/// Its cost is the variance of the error: where within a count the shaft stood at the start is not known, so a constant
/// difference does not count.
#[derive(Clone, Copy, Debug)]
pub struct Evaluation<S: Arithmetic> {
    model: Rigid<S>,
    motion: Motion<S>,
    /// Reading, relative to that at the start.
    count: i32,
    at: usize,
    sum: ErrorOf<S>,
    squares: ErrorOf<S>,
    /// Mean square above which the candidate does not matter.
    bound: f32,
    result: Option<f32>,
}

impl<S: Arithmetic> Evaluation<S> {
    /// At the start of the trace; gives up as soon as its cost must exceed `bound`.
    pub fn new(model: Rigid<S>, bound: f32) -> Self {
        Evaluation {
            model,
            motion: Motion::default(),
            count: 0,
            at: 0,
            sum: Default::default(),
            squares: Default::default(),
            bound,
            result: None,
        }
    }

    /// Runs along at most about `samples` of the trace; returns how many it ran.
    pub fn run(&mut self, trace: &Trace<'_>, samples: u32) -> u32 {
        let len = trace.len();
        let mut ran = 0;
        while self.result.is_none() && ran < samples {
            let from = self.at;
            let to = (from + BLOCK).min(len);
            for k in from..to {
                self.step(trace.duties[k], trace.steps[k]);
            }
            self.at = to;
            ran += (to - from) as u32;
            // The sum about the mean of what was seen only grows, so it may be compared before the end.
            let so_far = self.spread(to.max(1) as f64);
            let excessive = so_far > f64::from(self.bound) * len as f64;
            if to == len || excessive {
                self.result = Some((so_far / len.max(1) as f64) as f32);
            }
        }
        ran
    }

    /// Mean squared error, counts², once it is known (or known to exceed the bound).
    pub fn result(&self) -> Option<f32> {
        self.result
    }

    /// One period: the duty acts, the count is read at its end.
    #[inline(always)]
    pub fn step(&mut self, duty: i16, step: i16) {
        let open = duty == crate::trace::OPEN;
        let command = S::from_q15(if open { 0 } else { duty });
        self.model.step(&mut self.motion, command, open);
        self.count = self.count.wrapping_add(i32::from(step));
        let error = self.error();
        self.sum = self.sum + error;
        self.squares = self.squares + error.squared();
    }

    /// Counts by which the model is ahead of the reading now.
    #[inline(always)]
    pub fn error(&self) -> ErrorOf<S> {
        self.motion.angle.minus(self.count)
    }

    /// Mean squared error over the `periods` stepped so far, counts².
    pub fn mean_square(&self, periods: u32) -> f32 {
        let periods = f64::from(periods.max(1));
        (self.spread(periods) / periods) as f32
    }

    /// Sum of the squared errors about their mean, as far as that can be a matter of where the shaft stood.
    fn spread(&self, periods: f64) -> f64 {
        let sum = self.sum.to_f64();
        let mean = (sum / periods).clamp(-UNKNOWN_START, UNKNOWN_START);
        self.squares.to_f64() - mean * (sum + sum - mean * periods)
    }
}
