//! The blocks of a recording: consecutive samples under one command.

use super::zero_order_hold::{LinearState, STRIDE, STRIDES};
use crate::data::Data;
use std::ops::Range;

/// Least average number of samples for which a command must stay constant.
const MEAN_HOLD: usize = 2 * STRIDE;
/// Most samples in a block.
pub(super) const BLOCK: usize = STRIDE * STRIDES;
/// Rounding error of a whole cost, relative to the cost.
pub(super) const COST_ROUNDING: f64 = 1e-9;

/// Samples under one command.
pub(super) struct Block {
    /// The samples.
    pub(super) range: Range<usize>,
    /// The command, per unit.
    pub(super) command: f64,
    /// Sum of the readings, counts.
    pub(super) readings: f64,
}

/// A model at one block.
pub(super) struct BlockPath {
    /// State at the block's first sample.
    pub(super) start: LinearState,
    /// Lower bound of the block's cost.
    pub(super) lower_bound: f64,
}

/// Splits the data into blocks; `None` where the command changes too often for that to pay.
pub(super) fn blocks(data: &Data) -> Option<Vec<Block>> {
    let mut blocks = Vec::new();
    let (mut from, mut stretches) = (0, 0);
    while from < data.len() {
        let command = data.command[from];
        let held = data.command[from..].iter().take_while(|c| **c == command);
        let to = from + held.count().max(1);
        for begin in (from..to).step_by(BLOCK) {
            let range = begin..(begin + BLOCK).min(to);
            blocks.push(Block {
                readings: data.counts[range.clone()].iter().sum(),
                command,
                range,
            });
        }
        stretches += 1;
        from = to;
    }
    (data.len() >= MEAN_HOLD * stretches).then_some(blocks)
}
