//! The cost of a linear motor in closed form, for recordings whose command is constant for long stretches.
//!
//! A *block* is up to 512 samples under one command. The zero-order-hold response (`zero_order_hold`) gives the
//! motor's state at the start of each block and the sum of the angles in it, in some ten multiplications. Then:
//!
//! 1. A block costs at least the magnitude of the sum of its errors. The sum over the blocks is a lower bound of the
//!    cost. A search that only compares costs rejects most candidates by it, with the same decisions.
//! 2. Otherwise the errors of each block are summed, eight samples at a time in lanes (`sum`). Where the transient has
//!    died away only a line is left (`settling`).
//!
//! The result equals the cost of [`FitProblem`] within rounding (`host/tests/quick_costs.rs`).

mod blocks;
mod errors;
mod settling;
mod sum;
mod zero_order_hold;

use crate::problem::FitProblem;
use crate::problem::residuals::reading_shift;
use crate::problem::tangent::TangentBuilder;
use crate::simulation::{Candidate, Horizon, StartAngle, whole};
use crate::solve::{Compressed, Objective, Tangent};
use blocks::{BLOCK, Block, BlockPath, COST_ROUNDING, blocks};
use errors::{Motion, errors};
use shared::cost::Cost;
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::model::Increments;
use sum::{Floored, Plain, Squares, Sum};
use zero_order_hold::{AngleSum, HoldResponse, LinearState, StrideAngles};

/// Rounding error of a block's sum, relative to the sum of the magnitudes of its terms.
const SUM_ROUNDING: f64 = 64.0 * f64::EPSILON;
/// Error of one angle, counts, from a transient that is left out once it has died away, and from rounding of the line.
const TRUNCATION_COUNTS: f64 = 1e-9;

/// A fit problem whose cost is computed in blocks where that is possible, and sample by sample where it is not.
pub struct BlockCost<'a> {
    problem: &'a FitProblem<'a>,
    /// The blocks; `None` where the cost must be computed sample by sample.
    blocks: Option<Vec<Block>>,
}

impl<'a> BlockCost<'a> {
    /// Splits the data into blocks.
    ///
    /// That needs a linear model, samples at equal intervals, a bridge that never opens, the whole recording as the
    /// horizon, and commands that stay constant for 64 samples on average. Absolute costs need a known start angle;
    /// the interval cost has no closed form.
    pub fn new(problem: &'a FitProblem<'a>) -> Self {
        let data = problem.data;
        let summed = match problem.cost {
            Cost::Absolute { .. } => problem.start_angle == StartAngle::Known,
            Cost::Squared => true,
            Cost::Interval { .. } => false,
        };
        let even = data.lengths == [1.0]
            && !data.coasts()
            && !data.recordings.are_several()
            && problem.horizon == Horizon::Whole;
        let apt = summed && even && problem.structure.effects.is_empty();
        let blocks = apt.then(|| blocks(data)).flatten();
        BlockCost { problem, blocks }
    }

    /// Whether costs are computed in blocks.
    pub fn helps(&self) -> bool {
        self.blocks.is_some()
    }

    /// The cost of a model, in the unit of the problem's cost; infinite where the model cannot run.
    pub fn cost_of(&self, candidate: &Candidate) -> f64 {
        self.cost_of_within(candidate, f64::INFINITY)
    }

    fn cost_of_within(&self, candidate: &Candidate, limit: f64) -> f64 {
        self.closed_form_cost(candidate, limit)
            .unwrap_or_else(|| self.problem.cost_of(candidate))
    }

    /// The motor's response, its state at the start of each block, and the lower bound of the cost (without its
    /// weight). Stops at the block at which the bound exceeds `limit`. `None` where the model must be run sample by
    /// sample.
    // Inlined: the response is large, and a call would copy it.
    #[inline(always)]
    fn path(
        &self,
        candidate: &Candidate,
        limit: f64,
    ) -> Option<(HoldResponse, Vec<BlockPath>, f64)> {
        let blocks = self.blocks.as_ref()?;
        let problem = self.problem;
        let data = problem.data;
        // A model that cannot run is reported by the sum sample by sample.
        let discretisation = problem.method.discretisation;
        let step = Increments::of(&candidate.machine, &data.units, discretisation).ok()?;
        let hold = HoldResponse::new(&step)?;
        let segment = whole(data, candidate, problem.start_angle);
        let start = LinearState {
            state: [0.0, segment.speed / data.units.speed],
            angle: segment.angle + reading_shift(data),
        };
        let (paths, least) = self.paths(blocks, &hold, start, limit);
        Some((hold, paths, least))
    }

    /// The cost if it is at most `limit`, else a number above `limit`; `None` where it must be summed sample by
    /// sample.
    fn closed_form_cost(&self, candidate: &Candidate, limit: f64) -> Option<f64> {
        let problem = self.problem;
        let data = problem.data;
        let limit = limit / problem.weight;
        let (hold, paths, least) = self.path(candidate, limit)?;
        if least * (1.0 - COST_ROUNDING) > limit {
            return Some(least * problem.weight);
        }
        let run = Sum {
            data,
            hold: &hold,
            blocks: self.blocks.as_ref()?,
            paths: &paths,
            least,
            limit,
        };
        let sum = match problem.cost {
            Cost::Absolute { model_floored } => {
                if model_floored {
                    run.of(Floored)[0]
                } else {
                    run.of(Plain)[0]
                }
            }
            _ => {
                let [squares, errors] = run.of(Squares);
                match problem.start_angle {
                    StartAngle::Known => squares,
                    // About their mean: the best start.
                    StartAngle::Free => (squares - errors * errors / data.len() as f64).max(0.0),
                }
            }
        };
        sum.is_finite().then_some(sum * problem.weight)
    }

    /// The state at the start of each block, up to the block at which the lower bound exceeds `limit`; and that bound.
    fn paths(
        &self,
        blocks: &[Block],
        hold: &HoldResponse,
        start: LinearState,
        limit: f64,
    ) -> (Vec<BlockPath>, f64) {
        let mut paths: Vec<BlockPath> = Vec::with_capacity(blocks.len());
        let (mut motor, mut total) = (start, 0.0);
        for block in blocks {
            let (to, angle_sum) = hold.advance(motor, block.command, block.range.len());
            let least = self.lower_bound(block, angle_sum);
            total += least;
            paths.push(BlockPath {
                start: motor,
                lower_bound: least,
            });
            if total * (1.0 - COST_ROUNDING) > limit {
                break;
            }
            motor = to;
        }
        (paths, total)
    }

    /// Lower bound of a block's cost: `|Σ error| ≤ Σ |error|`, less the rounding.
    fn lower_bound(&self, block: &Block, angles: AngleSum) -> f64 {
        let Cost::Absolute { model_floored } = self.problem.cost else {
            return 0.0;
        };
        let samples = block.range.len() as f64;
        let sum = angles.sum - block.readings;
        let lost =
            SUM_ROUNDING * (angles.terms + block.readings.abs()) + TRUNCATION_COUNTS * samples;
        // Rounding down makes an error smaller by less than one count.
        let above = if model_floored { sum - samples } else { sum };
        (above.max(-sum) - lost).max(0.0)
    }
}

impl Objective for BlockCost<'_> {
    fn dim(&self) -> usize {
        self.problem.dim()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.cost_within(x, f64::INFINITY)
    }

    fn cost_within(&self, x: &[f64], limit: f64) -> f64 {
        self.cost_of_within(&self.candidate(x), limit)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        self.problem.residuals_and_cost(x)
    }

    fn changes(&self, x: &[f64], moved: &[Vec<f64>]) -> Vec<Option<Vec<f64>>> {
        self.problem.changes(x, moved)
    }

    fn compressed(&self) -> Option<&dyn Compressed> {
        self.problem.compressed()?;
        Some(self)
    }

    fn start(&self) -> Option<Vec<f64>> {
        self.problem.start()
    }
}

impl BlockCost<'_> {
    fn candidate(&self, x: &[f64]) -> Candidate {
        let structure = &self.problem.structure;
        structure.candidate_at(x)
    }

    /// Residuals of the first candidate and changes to the others, as a triangle; `None` where one of them must be run
    /// sample by sample.
    fn closed_form_tangent(&self, candidates: &[Candidate]) -> Option<Tangent> {
        let problem = self.problem;
        let motions: Vec<(HoldResponse, Vec<BlockPath>, f64)> = candidates
            .iter()
            .map(|candidate| self.path(candidate, f64::INFINITY))
            .collect::<Option<_>>()?;
        let zero = (problem.start_angle == StartAngle::Known).then_some(FLOOR_OFFSET_COUNTS);
        let mut builder = TangentBuilder::new(candidates.len() - 1, zero);
        let aheads: Vec<StrideAngles> = motions
            .iter()
            .map(|(hold, ..)| hold.stride_angles())
            .collect();
        let mut some = vec![[0.0; BLOCK]; candidates.len()];
        for (number, block) in self.blocks.as_ref()?.iter().enumerate() {
            let readings = &problem.data.counts[block.range.clone()];
            for (((hold, paths, _), ahead), some) in motions.iter().zip(&aheads).zip(&mut some) {
                let motion = Motion {
                    stride: hold.stride(),
                    ahead,
                    command: block.command,
                };
                errors(
                    &motion,
                    paths[number].start,
                    readings,
                    &mut some[..readings.len()],
                );
            }
            let (here, others) = some.split_at_mut(1);
            let here = &here[0][..readings.len()];
            let changes = others.iter_mut().map(|change| {
                for (change, here) in change.iter_mut().zip(here) {
                    *change -= here;
                }
                &change[..here.len()]
            });
            builder.add(here, &changes.collect::<Vec<_>>());
        }
        builder.finish()
    }
}

impl Compressed for BlockCost<'_> {
    fn squares_and_cost(&self, x: &[f64]) -> Option<(f64, f64)> {
        match self.closed_form_cost(&self.candidate(x), f64::INFINITY) {
            Some(cost) => Some((cost / self.problem.weight, cost)),
            None => self.problem.squares_and_cost(x),
        }
    }

    fn tangent(&self, x: &[f64], moved: &[Vec<f64>]) -> Option<Tangent> {
        let points = std::iter::once(x).chain(moved.iter().map(|x| &x[..]));
        let candidates: Vec<Candidate> = points.map(|x| self.candidate(x)).collect();
        let tangent = self.closed_form_tangent(&candidates);
        tangent.or_else(|| self.problem.tangent(x, moved))
    }
}
