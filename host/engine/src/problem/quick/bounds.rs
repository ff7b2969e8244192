//! Two numbers between which a sum of magnitudes lies, from a run in single precision: sixteen samples to a register where
//! there are eight otherwise, and half the memory to read.
//!
//! An error is taken from small numbers only: the model's line less that which the readings were counted from, the
//! transient, and what is left of the reading ([`rebased`](super::rebased)). With magnitudes `B` of the line, `W` of its
//! rise over a stride, `R` of what is left of the readings and `Z` of the transient's two terms, and `u` the part of a number
//! that is lost when it is rounded (N. J. Higham, *Accuracy and Stability of Numerical Algorithms*, 2.2, 3.1):
//!
//! ```text
//! x₁ = B + W             B, W rounded before, x₁ after     u(B + W) + u(B + W)
//! x₂ = x₁ − R            what R lost is known              u(B + W + R)
//! x₃ = x₂ + a·p          a, p rounded, the product, x₃     3u|a·p| + u(B + W + R + |a·p|)
//! x₄ = x₃ + b·q          b, q rounded, the product, x₄     3u|b·q| + u(B + W + R + Z)
//! ```
//!
//! which is no more than `5u(B + W) + 3u·R + 5u·Z`, but for terms of `u²`. A lane's sum over a block has at most as many
//! additions as the block has strides, and a few more make one number of all lanes, each losing a part `u` of sums that are
//! no larger than the last.

use super::rebased::{ROUNDING, Rebased};
use super::sum::SETTLED_COUNTS;
use super::{BLOCK, Block, Piece, SLACK};
use crate::lanes::{LANES, SINGLES, Singles, Token, Work, work};
use crate::problem::held::{Held, STRIDE, STRIDES};
use crate::problem::settling::{ANGLE_ERROR_COUNTS, Path, Settling};
use std::ops::RangeInclusive;

/// Registers to a stride.
const ROWS: usize = STRIDE / SINGLES;
/// Roundings of an error, each of them of no more than all magnitudes together: five, and room for terms of `u²`.
const OF_ERROR: f64 = 6.0 * ROUNDING;
/// Of a block's sum: a stride's addition each, those across rows and lanes, and room for terms of `u²`.
const OF_SUM: f64 = (BLOCK.div_ceil(STRIDE) + 8) as f64 * ROUNDING;
/// Roundings in double precision of angles in counts, on either side: the line's, a stride's rise at a time, and the
/// readings' above their own.
const OF_ANGLE: f64 = 64.0 * f64::EPSILON;

/// A path whose sum is to be bounded.
pub(super) struct Bounds<'s> {
    /// The readings by block.
    pub(super) rebased: &'s [Rebased],
    /// The motor.
    pub(super) held: &'s Held,
    /// What it tends to.
    pub(super) settling: &'s Settling,
    /// Where commands are held,
    pub(super) blocks: &'s [Block],
    /// and the motor's path there.
    pub(super) pieces: &'s [Piece],
}

impl Bounds<'_> {
    /// The least and the greatest that the sum of magnitudes may be, as the run in double precision has it. `None` where there
    /// are no lanes, or what is summed does not fit single precision.
    pub(super) fn of_magnitudes(&self) -> Option<RangeInclusive<f64>> {
        let [least, most] = work(Bounding(self))??;
        (least.is_finite() && most.is_finite()).then_some(least..=most)
    }
}

struct Bounding<'r, 's>(&'r Bounds<'s>);

impl Work for Bounding<'_, '_> {
    type Output = Option<[f64; 2]>;

    #[inline(always)]
    fn run<T: Token, const M: usize>(self) -> Option<[f64; 2]> {
        let run = self.0;
        let zero = Singles::<T, M>::zero();
        let [by_current, by_speed] = run.settling.ahead();
        let motion = Motion {
            ahead: [
                rows(zero, &singles(by_current)),
                rows(zero, &singles(by_speed)),
            ],
            most: run.settling.most(),
            at_strides: run.settling.at_strides(run.held),
        };
        let (mut least, mut most) = (0.0, 0.0);
        let pieces = run.pieces.iter().zip(run.rebased);
        for ((piece, rebased), block) in pieces.zip(run.blocks) {
            let path = run.settling.path(&piece.place, block.command)?;
            let (sum, off) = run.block(block.range.len(), path, rebased, &motion);
            // A NaN stays one.
            least += (sum - off) * (1.0 - SLACK);
            most += (sum + off) * (1.0 + SLACK);
        }
        Some([least, most])
    }
}

#[inline(always)]
fn singles(stride: &[f64; STRIDE]) -> [f32; STRIDE] {
    let mut singles = [0.0; STRIDE];
    for (single, x) in singles.iter_mut().zip(stride) {
        *single = *x as f32;
    }
    singles
}

/// A stride in lanes like others.
#[inline(always)]
fn rows<T: Token, const M: usize>(
    like: Singles<T, M>,
    stride: &[f32; STRIDE],
) -> [Singles<T, M>; ROWS] {
    let (rows, _) = stride.as_chunks::<SINGLES>();
    [like.each_like(rows[0]), like.each_like(rows[1])]
}

/// A motor's transients.
struct Motion<T: Token, const M: usize> {
    /// At each of the samples of a stride, by current and by speed at its start.
    ahead: [[Singles<T, M>; ROWS]; 2],
    /// Largest magnitudes of these.
    most: [f64; 2],
    /// Current and speed at the start of each stride.
    at_strides: [[[f64; STRIDES]; 2]; 2],
}

/// What the strides of a block begin with.
struct Begins {
    /// The model's line above that of the readings, counts.
    line: [f32; STRIDES],
    /// Current and speed less where they tend to.
    off: [[f32; STRIDES]; 2],
    /// Sum of the bounds of their transients, counts.
    transients: f64,
}

impl<T: Token, const M: usize> Motion<T, M> {
    /// Those of a block that begins with a line and a state.
    #[inline(always)]
    fn begins(&self, line: Line, [current, speed]: [f64; 2]) -> Begins {
        let mut begins = Begins {
            line: line.at_strides(),
            off: [[0.0; STRIDES]; 2],
            transients: 0.0,
        };
        for ((by, off), most) in self.at_strides.iter().zip(&mut begins.off).zip(self.most) {
            let mut sum = 0.0;
            for k in 0..STRIDES {
                let x = by[0][k] * current + by[1][k] * speed;
                off[k] = x as f32;
                sum += x.abs();
            }
            begins.transients += most * sum;
        }
        begins
    }
}

/// The model's line above that of a block's readings: at the first sample, and what it rises by with each, counts.
#[derive(Clone, Copy)]
struct Line {
    begin: f64,
    rise: f64,
}

impl Line {
    /// Where each stride begins.
    #[inline(always)]
    fn at_strides(self) -> [f32; STRIDES] {
        let mut at = [0.0; STRIDES];
        for (k, at) in at.iter_mut().enumerate() {
            *at = (self.begin + self.rise * (k * STRIDE) as f64) as f32;
        }
        at
    }

    /// What it rises by up to each sample of a stride.
    #[inline(always)]
    fn ramp(self) -> [f32; STRIDE] {
        let mut ramp = [0.0; STRIDE];
        for (k, ramp) in ramp.iter_mut().enumerate() {
            *ramp = (self.rise * k as f64) as f32;
        }
        ramp
    }
}

/// The magnitudes of a block's errors, a stride at a time.
struct Strides<'r, T: Token, const M: usize> {
    ramp: [Singles<T, M>; ROWS],
    ahead: &'r [[Singles<T, M>; ROWS]; 2],
    begins: Begins,
}

impl<T: Token, const M: usize> Strides<'_, T, M> {
    /// Those of a stride, with the transient or without it.
    #[inline(always)]
    fn magnitudes<const MOVING: bool>(
        &self,
        stride: usize,
        left: &[f32; STRIDE],
    ) -> [Singles<T, M>; ROWS] {
        let zero = self.ramp[0];
        let line = zero.like(self.begins.line[stride]);
        let left = rows(zero, left);
        let current = zero.like(self.begins.off[0][stride]);
        let speed = zero.like(self.begins.off[1][stride]);
        let mut magnitudes = left;
        for row in 0..ROWS {
            let mut error = (line + self.ramp[row]) - left[row];
            if MOVING {
                error = error
                    .plus_product(self.ahead[0][row], current)
                    .plus_product(self.ahead[1][row], speed);
            }
            magnitudes[row] = error.abs();
        }
        magnitudes
    }

    /// Their sum over so many samples.
    #[inline(always)]
    fn sum<const MOVING: bool>(&self, left: &[[f32; STRIDE]], samples: usize) -> f32 {
        let mut sums = [self.ramp[0].like(0.0); ROWS];
        let (strides, part) = left.split_at((samples / STRIDE).min(STRIDES));
        for (stride, left) in strides.iter().take(STRIDES).enumerate() {
            let magnitudes = self.magnitudes::<MOVING>(stride, left);
            for row in 0..ROWS {
                sums[row] = sums[row] + magnitudes[row];
            }
        }
        if let [left] = part {
            // Less than a stride: what is behind it does not count.
            let mut counts = [0.0; STRIDE];
            counts[..samples % STRIDE].fill(1.0);
            let counts = rows(sums[0], &counts);
            let magnitudes = self.magnitudes::<MOVING>(strides.len(), left);
            for row in 0..ROWS {
                sums[row] = sums[row].plus_product(magnitudes[row], counts[row]);
            }
        }
        (sums[0] + sums[1]).sum()
    }
}

impl Bounds<'_> {
    /// A block's sum, and how far off it may be.
    #[inline(always)]
    fn block<T: Token, const M: usize>(
        &self,
        samples: usize,
        path: Path,
        rebased: &Rebased,
        motion: &Motion<T, M>,
    ) -> (f64, f64) {
        let Path {
            level: begin,
            slope,
            off,
        } = path;
        let line = Line {
            begin: begin - rebased.level,
            rise: slope - rebased.slope,
        };
        let settled = self.settling.largest(off) < SETTLED_COUNTS;
        let off = if settled { [0.0; 2] } else { off };
        let strides = Strides {
            ramp: rows(motion.ahead[0][0], &line.ramp()),
            ahead: &motion.ahead,
            begins: motion.begins(line, off),
        };
        let sum = f64::from(if settled {
            strides.sum::<false>(&rebased.left, samples)
        } else {
            strides.sum::<true>(&rebased.left, samples)
        });
        let count = samples as f64;
        let end = line.begin + line.rise * count;
        let widest = line.begin.abs().max(end.abs()) + (line.rise * STRIDE as f64).abs();
        let transients = strides.begins.transients * STRIDE as f64;
        let sizes = (widest + rebased.most) * count + transients;
        let angle = begin.abs().max((begin + slope * count).abs()) + rebased.farthest;
        let doubles = (OF_ANGLE * angle + 2.0 * ANGLE_ERROR_COUNTS) * count;
        let off = OF_ERROR * sizes + rebased.lost + doubles;
        (sum, off + OF_SUM * sum)
    }
}

const _: () = assert!(ROWS == 2 && STRIDE == 2 * SINGLES && SINGLES == 2 * LANES);
const _: () = assert!(BLOCK == STRIDES * STRIDE);
