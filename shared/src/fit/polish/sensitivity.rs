//! Sensitivities of the error by differences: the centre and two displaced models run side by side along the trace.

use crate::fit::Arithmetic;
use crate::fit::evaluation::{Room, Runs, explained};
use crate::trace::Trace;

/// Products of the error and of both differences, summed along the trace.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Differences {
    pub(super) at: usize,
    /// Sums of the error and of both differences; of the error times each; and of the differences' products, the upper triangle
    /// row by row.
    sums: [f32; 8],
    /// The same since the last whole block.
    block: [f32; 8],
}

/// Periods in a block, which is summed by itself first: a sum of sums rounds less than one long sum.
const BLOCK: usize = 32;

impl Differences {
    /// Not begun: all zeros.
    pub(super) const EMPTY: Self = Differences {
        at: 0,
        sums: [0.0; 8],
        block: [0.0; 8],
    };

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
            self.at = k + 1;
            let mut errors = [0.0f32; 3];
            for (run, error) in runs.iter_mut().filter_map(Room::model).zip(&mut errors) {
                run.step(trace.duties[k], trace.steps[k]);
                *error = run.error();
            }
            let [e, a, b] = errors;
            let (a, b) = (a - e, b - e);
            let terms = [e, a, b, e * a, e * b, a * a, a * b, b * b];
            for (sum, term) in self.block.iter_mut().zip(terms) {
                *sum += term;
            }
            if (k + 1).is_multiple_of(BLOCK) || k + 1 == trace.len() {
                for (sum, block) in self.sums.iter_mut().zip(&mut self.block) {
                    *sum += *block;
                    *block = 0.0;
                }
            }
            if self.used(from) + extra(runs) - before >= samples {
                break;
            }
        }
        self.used(from) + extra(runs) - before
    }

    /// Periods of three models since `from`.
    fn used(&self, from: usize) -> u32 {
        3 * (self.at - from) as u32
    }

    /// Products about the means, because the start within a count is not known. If the mean error is more than the start can
    /// explain, the start stays at the end of its range and the cost has no other mean to take off.
    pub(super) fn products(&self) -> [f32; 5] {
        let [e, a, b, ea, eb, aa, ab, bb] = self.sums;
        let mut part = 1.0 / self.at.max(1) as f32;
        let mean = e * part;
        let start = explained(mean);
        if start != mean {
            part = 0.0;
        }
        [
            ea - start * a,
            eb - start * b,
            aa - a * a * part,
            ab - a * b * part,
            bb - b * b * part,
        ]
    }
}
