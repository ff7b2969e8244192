//! The cost of a linear motor whose commands are held for long: many samples at a time, and no more of them than
//! show that the cost is above a limit.
//!
//! Samples side by side in lanes go through [`held`](super::held)'s recurrence. Where the transient has died away
//! only the line is left. Before, a bound from sums alone: no block of samples costs less than its errors' sum, and
//! that follows from the block's ends. Whoever only compares costs loses nothing by it. Sums in single precision come
//! with bounds, between which the cost lies.

mod bounds;
mod errors;
mod rebased;
mod sum;

use super::compress::Compress;
use super::cost::reading_shift;
use super::course::legs;
use super::data::Data;
use super::held::{Held, Path, Place, STRIDE};
use super::simulate::Candidate;
use super::{FitProblem, Horizon, StartAngle};
use crate::solve::{Compressed, Objective, Tangent};
use bounds::Bounds;
use errors::errors;
use rebased::Rebased;
use shared::cost::Cost;
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::model::{Increments, Plan};
use std::ops::{Range, RangeInclusive};
use sum::{Floored, Plain, Squares, Sum};

/// Fewest samples that a command must be held for, on average.
const HELD: usize = 2 * STRIDE;
/// Samples of a block.
const BLOCK: usize = 512;
/// Rounding of a sum of a block, as a part of what is added up.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// The same of a whole cost.
const SLACK: f64 = 1e-9;

/// A problem with a quicker cost.
pub struct Quick<'a> {
    problem: &'a FitProblem<'a>,
    /// Where it can be had: on even samples, driven throughout by commands that are held.
    blocks: Option<Vec<Block>>,
    /// The readings of the blocks in single precision, where magnitudes are summed.
    rebased: Vec<Rebased>,
}

/// Samples under one command.
struct Block {
    range: Range<usize>,
    command: f64,
    /// Whether the command was another before.
    begins: bool,
    /// Sum of the readings.
    readings: f64,
}

/// A block of a motor's path.
struct Piece {
    path: Path,
    /// Samples from the path's start to the block's.
    after: usize,
    /// The state less where it tends to, at the block's start.
    off: [f64; 2],
    /// The block costs no less.
    least: f64,
}

impl<'a> Quick<'a> {
    /// Looks for commands that are held.
    pub fn new(problem: &'a FitProblem<'a>) -> Self {
        let data = problem.data;
        let summed = match problem.cost {
            Cost::Absolute { .. } => problem.start_angle == StartAngle::Known,
            Cost::Squared => true,
            Cost::Interval { .. } => false,
        };
        let even = data.lengths == [1.0] && !data.coasts() && problem.horizon == Horizon::Whole;
        let apt = summed && even && problem.structure.effects.is_empty();
        let blocks = apt.then(|| blocks(data)).filter(|blocks| {
            let stretches = blocks.iter().filter(|block| block.begins).count();
            data.len() >= HELD * stretches
        });
        let magnitudes = problem.cost
            == Cost::Absolute {
                model_floored: false,
            };
        let rebased = blocks
            .iter()
            .filter(|_| magnitudes)
            .flatten()
            .map(|block| Rebased::new(block, &data.counts))
            .collect();
        Quick {
            problem,
            blocks,
            rebased,
        }
    }

    /// Whether costs are quicker here than sample by sample.
    pub fn helps(&self) -> bool {
        self.blocks.is_some()
    }

    /// The cost of a model; infinite where it cannot run.
    pub fn cost_of(&self, candidate: &Candidate) -> f64 {
        self.cost_of_within(candidate, f64::INFINITY)
    }

    /// What the cost of a model lies between, from sums in single precision; `None` where there are none such: only
    /// magnitudes of errors are summed so, and only of motors that settle.
    // Searches do not ask for them: half of the time goes into the path, which both sums need, and the other sum
    // stops as soon as it is above the limit.
    pub fn bounds_of(&self, candidate: &Candidate) -> Option<RangeInclusive<f64>> {
        if self.rebased.is_empty() {
            return None;
        }
        let (held, pieces, _) = self.course(candidate, f64::INFINITY)?;
        let bounds = Bounds {
            rebased: &self.rebased,
            held: &held,
            blocks: self.blocks.as_ref()?,
            pieces: &pieces,
        };
        let bounds = bounds.of_magnitudes()?;
        let weight = self.problem.weight;
        Some(bounds.start() * weight..=bounds.end() * weight)
    }

    fn cost_of_within(&self, candidate: &Candidate, limit: f64) -> f64 {
        self.held(candidate, limit)
            .unwrap_or_else(|| self.problem.cost_of(candidate))
    }

    /// The motor and its path, as far as needed to see that the cost, without its weight, is above `limit`; and what it
    /// costs at least. `None` where it must be run sample by sample.
    fn course(&self, candidate: &Candidate, limit: f64) -> Option<(Held, Vec<Piece>, f64)> {
        let blocks = self.blocks.as_ref()?;
        let problem = self.problem;
        let data = problem.data;
        // A model that cannot run says so where it is summed sample by sample.
        let plan = Plan {
            discretisation: problem.method.discretisation,
            ..Plan::linear(candidate.machine, data.units)
        };
        let held = Held::new(Increments::new(&plan).ok()?)?;
        let [leg] = &legs(data, candidate, &problem.horizon, problem.start_angle)[..] else {
            return None;
        };
        let start = Place {
            state: [0.0, leg.speed / data.units.speed],
            angle: leg.angle + reading_shift(data),
        };
        let (pieces, least) = self.pieces(blocks, &held, start, limit)?;
        Some((held, pieces, least))
    }

    /// The cost, or more than `limit` where that is less; `None` where it must be summed sample by sample.
    fn held(&self, candidate: &Candidate, limit: f64) -> Option<f64> {
        let problem = self.problem;
        let data = problem.data;
        let limit = limit / problem.weight;
        let (held, pieces, least) = self.course(candidate, limit)?;
        if least * (1.0 - SLACK) > limit {
            return Some(least * problem.weight);
        }
        let run = Sum {
            data,
            held: &held,
            blocks: self.blocks.as_ref()?,
            pieces: &pieces,
            least,
            limit,
        };
        let sum = match problem.cost {
            Cost::Absolute { model_floored } => {
                if model_floored {
                    run.of(Floored)?[0]
                } else {
                    run.of(Plain)?[0]
                }
            }
            _ => {
                let [squares, errors] = run.of(Squares)?;
                match problem.start_angle {
                    StartAngle::Known => squares,
                    // About their mean: the best start.
                    StartAngle::Free => (squares - errors * errors / data.len() as f64).max(0.0),
                }
            }
        };
        sum.is_finite().then_some(sum * problem.weight)
    }

    /// The pieces of a motor's path, as far as needed to see that the cost is above `limit`, and the least cost.
    fn pieces(
        &self,
        blocks: &[Block],
        held: &Held,
        start: Place,
        limit: f64,
    ) -> Option<(Vec<Piece>, f64)> {
        let mut pieces: Vec<Piece> = Vec::with_capacity(blocks.len());
        let mut total = 0.0;
        let (mut place, mut path, mut off, mut after) = (start, None, [0.0; 2], 0);
        for block in blocks {
            if block.begins {
                if let Some(path) = &path {
                    place = held.end(path, after, off);
                }
                let next = held.path(&place, block.command)?;
                (off, after) = (next.off, 0);
                path = Some(next);
            }
            let current = path?;
            let samples = block.range.len();
            let to = held.on(off, samples);
            let least = self.least(block, held, &current, after, off, to);
            total += least;
            pieces.push(Piece {
                path: current,
                after,
                off,
                least,
            });
            if total * (1.0 - SLACK) > limit {
                break;
            }
            (off, after) = (to, after + samples);
        }
        Some((pieces, total))
    }

    /// A block costs at least this: its errors' sum, however they are spread.
    fn least(
        &self,
        block: &Block,
        held: &Held,
        path: &Path,
        after: usize,
        off: [f64; 2],
        to: [f64; 2],
    ) -> f64 {
        let Cost::Absolute { model_floored } = self.problem.cost else {
            return 0.0;
        };
        let samples = block.range.len() as f64;
        let places = samples * (after as f64 + 0.5 * (samples - 1.0));
        let (transients, terms) = held.sum(off, to);
        let (levels, rises) = (path.level * samples, path.slope * places);
        let sum = levels + rises + transients - block.readings;
        let terms = terms + levels.abs() + rises.abs() + block.readings.abs();
        // Rounded down, an error is less by up to one.
        let above = if model_floored { sum - samples } else { sum };
        (above.max(-sum) - ROUNDING * terms).max(0.0)
    }
}

impl Objective for Quick<'_> {
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

impl Quick<'_> {
    fn candidate(&self, x: &[f64]) -> Candidate {
        let structure = &self.problem.structure;
        structure.candidate(&structure.values(x))
    }

    /// The tangent at a model; `None` where a model must be run sample by sample.
    fn held_tangent(&self, candidates: &[Candidate]) -> Option<Tangent> {
        let problem = self.problem;
        let courses: Vec<(Held, Vec<Piece>, f64)> = candidates
            .iter()
            .map(|candidate| self.course(candidate, f64::INFINITY))
            .collect::<Option<_>>()?;
        let zero = (problem.start_angle == StartAngle::Known).then_some(FLOOR_OFFSET_COUNTS);
        let mut compress = Compress::new(candidates.len() - 1, zero);
        let mut some = vec![[0.0; BLOCK]; candidates.len()];
        for (number, block) in self.blocks.as_ref()?.iter().enumerate() {
            let readings = &problem.data.counts[block.range.clone()];
            for ((held, pieces, _), some) in courses.iter().zip(&mut some) {
                errors(held, &pieces[number], readings, &mut some[..readings.len()]);
            }
            let (here, others) = some.split_at_mut(1);
            let here = &here[0][..readings.len()];
            let changes = others.iter_mut().map(|change| {
                for (change, here) in change.iter_mut().zip(here) {
                    *change -= here;
                }
                &change[..here.len()]
            });
            compress.add(here, &changes.collect::<Vec<_>>());
        }
        compress.tangent()
    }
}

impl Compressed for Quick<'_> {
    fn squares_and_cost(&self, x: &[f64]) -> Option<(f64, f64)> {
        match self.held(&self.candidate(x), f64::INFINITY) {
            Some(cost) => Some((cost / self.problem.weight, cost)),
            None => self.problem.squares_and_cost(x),
        }
    }

    fn tangent(&self, x: &[f64], moved: &[Vec<f64>]) -> Option<Tangent> {
        let points = std::iter::once(x).chain(moved.iter().map(|x| &x[..]));
        let candidates: Vec<Candidate> = points.map(|x| self.candidate(x)).collect();
        let tangent = self.held_tangent(&candidates);
        tangent.or_else(|| self.problem.tangent(x, moved))
    }
}

fn blocks(data: &Data) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut from = 0;
    while from < data.len() {
        let command = data.command[from];
        let held = data.command[from..].iter().take_while(|c| **c == command);
        let to = from + held.count().max(1);
        for begin in (from..to).step_by(BLOCK) {
            let range = begin..(begin + BLOCK).min(to);
            blocks.push(Block {
                readings: data.counts[range.clone()].iter().sum(),
                command,
                begins: begin == from,
                range,
            });
        }
        from = to;
    }
    blocks
}
