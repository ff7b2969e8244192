//! Sensitivities of the error by differences: a centre and two displaced models run side by side along a trace.

use super::Arithmetic;
use super::evaluation::{Room, Runs, explained};
use crate::trace::Trace;

/// Blocks in which a trace is summed. What a model lacks leaves an error that lasts, so that the scatter of whole blocks, and not of single
/// readings, tells how far estimates may be off.
pub(super) const BLOCKS: usize = 16;

/// Products of the error and of both differences, summed along the trace.
#[derive(Clone, Copy, Debug)]
pub(super) struct Differences {
    pub(super) at: usize,
    /// Periods in a block.
    length: usize,
    /// Sums in each block: of the error and of both differences, and of the error times each.
    blocks: [[f32; 5]; BLOCKS],
    /// Sums of the differences' products, the upper triangle row by row.
    squares: [f32; 3],
    /// The same in the present block: a sum of sums rounds less than one long sum.
    block: [f32; 3],
}

/// About the means, because the start within a count is not known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Products {
    /// Of the error with each difference.
    pub slopes: [f32; 2],
    /// Of the differences, the upper triangle row by row.
    pub squares: [f32; 3],
    /// Of the slopes of the blocks with each other, in the same order.
    pub scatter: [f32; 3],
}

impl Differences {
    /// Not begun: all zeros.
    pub(super) const EMPTY: Self = Differences {
        at: 0,
        length: 0,
        blocks: [[0.0; 5]; BLOCKS],
        squares: [0.0; 3],
        block: [0.0; 3],
    };

    /// Begins along a trace of so many periods.
    pub(super) fn begin(&mut self, periods: usize) {
        *self = Differences {
            length: periods.div_ceil(BLOCKS).max(1),
            ..Self::EMPTY
        };
    }

    /// Runs the models side by side along about `samples` periods in all; returns how many they ran, or what they cost.
    pub(super) fn run<S: Arithmetic>(
        &mut self,
        runs: &mut Runs<S>,
        trace: &Trace<'_>,
        samples: u32,
    ) -> u32 {
        let to = (self.at + samples as usize / 3 + 1).min(trace.len());
        let from = self.at;
        let extra = |runs: &mut Runs<S>| -> u32 {
            let models = runs.iter_mut().filter_map(Room::model);
            models.map(|run| run.extra()).sum()
        };
        let before = extra(runs);
        for k in from..to {
            self.step(runs, trace.duties[k], trace.steps[k]);
            if self.used(from) + extra(runs) - before >= samples {
                break;
            }
        }
        self.used(from) + extra(runs) - before
    }

    /// Runs the models along one period.
    pub(super) fn step<S: Arithmetic>(&mut self, runs: &mut Runs<S>, duty: i16, step: i16) {
        let mut errors = [0.0f32; 3];
        for (run, error) in runs.iter_mut().filter_map(Room::model).zip(&mut errors) {
            run.step(duty, step);
            *error = run.error();
        }
        self.add(errors);
    }

    /// Adds a period, at whose end the models had these errors.
    pub(super) fn add(&mut self, [e, a, b]: [f32; 3]) {
        let (a, b) = (a - e, b - e);
        if let Some(block) = self.blocks.get_mut(self.at / self.length.max(1)) {
            for (sum, term) in block.iter_mut().zip([e, a, b, e * a, e * b]) {
                *sum += term;
            }
        }
        for (sum, term) in self.block.iter_mut().zip([a * a, a * b, b * b]) {
            *sum += term;
        }
        self.at += 1;
        if self.at.is_multiple_of(self.length.max(1)) {
            self.end_block();
        }
    }

    fn end_block(&mut self) {
        for (sum, block) in self.squares.iter_mut().zip(&mut self.block) {
            *sum += *block;
            *block = 0.0;
        }
    }

    /// Periods of three models since `from`.
    fn used(&self, from: usize) -> u32 {
        3 * (self.at - from) as u32
    }

    /// The products. If the mean error is more than the start can explain, the start stays at the end of its range and the cost has no other
    /// mean to take off.
    pub(super) fn products(&mut self) -> Products {
        self.end_block();
        let mut sums = [0.0; 3];
        for block in &self.blocks {
            for (sum, part) in sums.iter_mut().zip(block) {
                *sum += part;
            }
        }
        let [e, a, b] = sums;
        let periods = self.at.max(1) as f32;
        let mean = e / periods;
        let start = explained(mean);
        let part = if start == mean { 1.0 / periods } else { 0.0 };
        let (mean_a, mean_b) = (a * part, b * part);
        let mut products = Products::default();
        let mut left = self.at;
        for block in &self.blocks {
            let here = self.length.min(left);
            left -= here;
            let [e, a, b, ea, eb] = *block;
            let about = |mean: f32, sum: f32, by_error: f32| {
                by_error - start * sum - mean * (e - start * here as f32)
            };
            let slopes = [about(mean_a, a, ea), about(mean_b, b, eb)];
            let [x, y] = slopes;
            for (sum, slope) in products.slopes.iter_mut().zip(slopes) {
                *sum += slope;
            }
            for (sum, term) in products.scatter.iter_mut().zip([x * x, x * y, y * y]) {
                *sum += term;
            }
        }
        let [aa, ab, bb] = self.squares;
        products.squares = [aa - a * mean_a, ab - a * mean_b, bb - b * mean_b];
        products
    }
}
