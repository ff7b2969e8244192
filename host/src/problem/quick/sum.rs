//! Sums over the samples of a path, side by side in lanes.

use super::{Block, Piece, SLACK};
use crate::lanes::{LANES, Lanes, Token, Work, work};
use crate::problem::data::Data;
use crate::problem::held::{Held, Path, STRIDE};
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::scalar::Scalar;

/// A transient below this many counts is none.
pub(super) const SETTLED_COUNTS: f64 = 1e-10;
/// Lanes to a stride.
const ROWS: usize = STRIDE / LANES;

/// What is summed over the errors, as [`Cost::sample`](shared::cost::Cost::sample) has it.
pub(super) trait Summand: Copy {
    /// Sums to keep.
    const SUMS: usize;
    /// Adds an error to the sums.
    fn add<T: Token, const M: usize>(error: Lanes<T, M>, sums: &mut [Lanes<T, M>; 2]);
}

/// Magnitudes.
#[derive(Clone, Copy)]
pub(super) struct Plain;
/// Magnitudes of errors rounded down.
#[derive(Clone, Copy)]
pub(super) struct Floored;
/// Squares about the middle of a count, and the errors themselves.
#[derive(Clone, Copy)]
pub(super) struct Squares;

impl Summand for Plain {
    const SUMS: usize = 1;
    #[inline(always)]
    fn add<T: Token, const M: usize>(error: Lanes<T, M>, sums: &mut [Lanes<T, M>; 2]) {
        sums[0] = sums[0] + error.magnitude();
    }
}

impl Summand for Floored {
    const SUMS: usize = 1;
    #[inline(always)]
    fn add<T: Token, const M: usize>(error: Lanes<T, M>, sums: &mut [Lanes<T, M>; 2]) {
        sums[0] = sums[0] + error.floor().magnitude();
    }
}

impl Summand for Squares {
    const SUMS: usize = 2;
    #[inline(always)]
    fn add<T: Token, const M: usize>(error: Lanes<T, M>, sums: &mut [Lanes<T, M>; 2]) {
        let error = error - error.like(FLOOR_OFFSET_COUNTS);
        sums[0] = sums[0] + error * error;
        sums[1] = sums[1] + error;
    }
}

/// A path to be summed over.
pub(super) struct Sum<'s> {
    /// The data.
    pub(super) data: &'s Data,
    /// The motor.
    pub(super) held: &'s Held,
    /// Where commands are held,
    pub(super) blocks: &'s [Block],
    /// and the motor's path there.
    pub(super) pieces: &'s [Piece],
    /// All blocks together cost no less.
    pub(super) least: f64,
    /// More than this is as good as any.
    pub(super) limit: f64,
}

impl Sum<'_> {
    /// The sums; `None` where there are no lanes.
    pub(super) fn of<C: Summand>(&self, cost: C) -> Option<[f64; 2]> {
        work(Summing(self, cost))
    }
}

struct Summing<'r, 's, C>(&'r Sum<'s>, C);

impl<C: Summand> Work for Summing<'_, '_, C> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run<T: Token, const M: usize>(self) -> [f64; 2] {
        let run = self.0;
        let mut sums = [[Lanes::<T, M>::default(); 2]; ROWS];
        let mut rest = run.least;
        let mut odd = [0.0; 2];
        for (block, piece) in run.blocks.iter().zip(run.pieces) {
            let readings = &run.data.counts[block.range.clone()];
            run.block::<T, M, C>(piece, readings, &mut sums, &mut odd);
            rest -= piece.least;
            if C::SUMS == 1 {
                let sum = total(&sums, 0) + odd[0];
                if (sum + rest) * (1.0 - SLACK) > run.limit {
                    return [sum + rest, 0.0];
                }
            }
        }
        [total(&sums, 0) + odd[0], total(&sums, 1) + odd[1]]
    }
}

#[inline(always)]
fn total<T: Token, const M: usize>(sums: &[[Lanes<T, M>; 2]; ROWS], which: usize) -> f64 {
    let all = (sums[0][which] + sums[1][which]) + (sums[2][which] + sums[3][which]);
    all.each().iter().sum()
}

/// A stride in lanes like others.
#[inline(always)]
fn rows<T: Token, const M: usize>(
    like: Lanes<T, M>,
    stride: &[f64; STRIDE],
) -> [Lanes<T, M>; ROWS] {
    let (rows, _) = stride.as_chunks::<LANES>();
    [
        like.each_like(rows[0]),
        like.each_like(rows[1]),
        like.each_like(rows[2]),
        like.each_like(rows[3]),
    ]
}

impl Sum<'_> {
    #[inline(always)]
    fn block<T: Token, const M: usize, C: Summand>(
        &self,
        piece: &Piece,
        readings: &[f64],
        sums: &mut [[Lanes<T, M>; 2]; ROWS],
        odd: &mut [f64; 2],
    ) {
        let Path { level, slope, .. } = piece.path;
        let begin = level + slope * piece.after as f64;
        let mut line = [0.0; STRIDE];
        for (k, line) in line.iter_mut().enumerate() {
            *line = begin + slope * k as f64;
        }
        let rise = Lanes::<T, M>::from_f64(slope * STRIDE as f64);
        let mut line = rows(rise, &line);
        let mut now = rows(rise, &self.held.transients(piece.off));
        let (strides, rest) = readings.as_chunks::<STRIDE>();
        if self.held.largest(piece.off) < SETTLED_COUNTS {
            for stride in strides {
                let readings = rows(rise, stride);
                for row in 0..ROWS {
                    C::add(line[row] - readings[row], &mut sums[row]);
                    line[row] = line[row] + rise;
                }
            }
        } else {
            let next = self.held.on(piece.off, STRIDE);
            let mut next = rows(rise, &self.held.transients(next));
            let trace = rise.like(self.held.trace);
            let determinant = rise.like(self.held.determinant);
            for stride in strides {
                let readings = rows(rise, stride);
                for row in 0..ROWS {
                    let error = (line[row] - readings[row]) + now[row];
                    C::add(error, &mut sums[row]);
                    let later = next[row] * trace - now[row] * determinant;
                    (now[row], next[row]) = (next[row], later);
                    line[row] = line[row] + rise;
                }
            }
        }
        if !rest.is_empty() {
            // Less than a stride: all of it in lanes of its own, of which those that are needed count.
            for row in 0..ROWS {
                let angles = (line[row] + now[row]).each();
                for (angle, reading) in angles.iter().zip(rest.iter().skip(row * LANES)) {
                    let mut sum = [Lanes::<T, M>::default(); 2];
                    C::add(Lanes::from_f64(angle - reading), &mut sum);
                    odd[0] += sum[0].each()[0];
                    odd[1] += sum[1].each()[0];
                }
            }
        }
    }
}
