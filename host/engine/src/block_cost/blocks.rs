//! The blocks of a recording: samples under one command.

use super::zero_order_hold::{LinearState, STRIDE, STRIDES};
use crate::data::Data;
use std::ops::Range;

/// Fewest samples that a command must be held for, on average.
const MEAN_HOLD: usize = 2 * STRIDE;
/// Samples of a block.
pub(super) const BLOCK: usize = STRIDE * STRIDES;
/// Rounding of a whole cost, as a part of it.
pub(super) const COST_ROUNDING: f64 = 1e-9;

/// Samples under one command.
pub(super) struct Block {
    /// The samples.
    pub(super) range: Range<usize>,
    /// The command, per unit.
    pub(super) command: f64,
    /// Sum of the readings.
    pub(super) readings: f64,
}

/// A block of a motor's course.
pub(super) struct BlockPath {
    /// Where it begins.
    pub(super) motor: LinearState,
    /// The block costs no less.
    pub(super) least: f64,
}

/// The blocks of data whose commands are held; `None` where they change too often.
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
