//! Sums of the errors over all blocks, eight samples at a time in lanes.

use super::blocks::{Block, BlockPath, COST_ROUNDING};
use super::settling::Settling;
use super::zero_order_hold::{HoldResponse, LinearState, STARTS, STRIDE, StrideStarts};
use crate::data::Data;
use crate::lanes::{LANES, Lanes, Token, Work, work};
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::scalar::Scalar;

/// A transient below this is left out, counts.
const SETTLED_COUNTS: f64 = 1e-10;
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

/// The errors of one candidate, to be summed over all blocks.
pub(super) struct Sum<'s> {
    /// The data.
    pub(super) data: &'s Data,
    /// The motor's response.
    pub(super) hold: &'s HoldResponse,
    /// The blocks of the data.
    pub(super) blocks: &'s [Block],
    /// The motor's state at each of them.
    pub(super) paths: &'s [BlockPath],
    /// Lower bound of the whole sum.
    pub(super) least: f64,
    /// The sum stops where it is known to exceed this.
    pub(super) limit: f64,
}

impl Sum<'_> {
    /// The sums.
    pub(super) fn of<C: Summand>(&self, cost: C) -> [f64; 2] {
        work(Summing(self, cost))
    }
}

struct Summing<'r, 's, C>(&'r Sum<'s>, C);

impl<C: Summand> Work for Summing<'_, '_, C> {
    type Output = [f64; 2];

    #[inline(always)]
    fn run<T: Token, const M: usize>(self) -> [f64; 2] {
        let run = self.0;
        let zero = Lanes::<T, M>::default();
        let mut sums = [[zero; 2]; ROWS];
        let ahead = run.hold.stride_angles();
        let motion = Motion {
            zero,
            by_current: rows(zero, &ahead.by_state[0]),
            by_speed: rows(zero, &ahead.by_state[1]),
            by_command: rows(zero, &ahead.by_command),
            begins: GroupStarts::new(zero, &run.hold.stride_starts()),
            settling: Settling::new(run.hold, &ahead),
        };
        let mut rest = run.least;
        for (block, path) in run.blocks.iter().zip(run.paths) {
            let readings = &run.data.counts[block.range.clone()];
            run.block::<T, M, C>(&motion, path.start, block.command, readings, &mut sums);
            rest -= path.lower_bound;
            if C::SUMS == 1 {
                let sum = total(&sums, 0);
                if (sum + rest) * (1.0 - COST_ROUNDING) > run.limit {
                    return [sum + rest, 0.0];
                }
            }
        }
        [total(&sums, 0), total(&sums, 1)]
    }
}

#[inline(always)]
fn total<T: Token, const M: usize>(sums: &[[Lanes<T, M>; 2]; ROWS], which: usize) -> f64 {
    let all = (sums[0][which] + sums[1][which]) + (sums[2][which] + sums[3][which]);
    let [a, b, c, d, e, f, g, h] = all.each();
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

type Stride<T, const M: usize> = [Lanes<T, M>; ROWS];

/// A stride in lanes.
#[inline(always)]
fn rows<T: Token, const M: usize>(like: Lanes<T, M>, stride: &[f64; STRIDE]) -> Stride<T, M> {
    let (rows, _) = stride.as_chunks::<LANES>();
    [
        like.each_like(rows[0]),
        like.each_like(rows[1]),
        like.each_like(rows[2]),
        like.each_like(rows[3]),
    ]
}

/// A motor's angles within a stride.
struct Motion<T: Token, const M: usize> {
    zero: Lanes<T, M>,
    by_current: Stride<T, M>,
    by_speed: Stride<T, M>,
    by_command: Stride<T, M>,
    begins: GroupStarts<T, M>,
    settling: Option<Settling>,
}

/// The states at which strides start, one to a lane.
struct GroupStarts<T: Token, const M: usize> {
    state: [[Lanes<T, M>; 2]; 2],
    state_by_command: [Lanes<T, M>; 2],
    angle: [Lanes<T, M>; 2],
    angle_by_command: Lanes<T, M>,
}

impl<T: Token, const M: usize> GroupStarts<T, M> {
    #[inline(always)]
    fn new(like: Lanes<T, M>, begins: &StrideStarts) -> Self {
        let two = |[a, b]: [[f64; LANES]; 2]| [like.each_like(a), like.each_like(b)];
        GroupStarts {
            state: [two(begins.state[0]), two(begins.state[1])],
            state_by_command: two(begins.state_by_command),
            angle: two(begins.angle),
            angle_by_command: like.each_like(begins.angle_by_command),
        }
    }

    /// Currents, speeds and angles at the starts of the strides.
    #[inline(always)]
    fn states(&self, LinearState { state, angle }: LinearState, command: f64) -> [[f64; LANES]; 3] {
        let like = self.angle_by_command;
        let (current, speed, command) =
            (like.like(state[0]), like.like(state[1]), like.like(command));
        let from = |x: Lanes<T, M>, by: [Lanes<T, M>; 2], by_command: Lanes<T, M>| {
            let driven = (by_command * command).plus_product(by[0], current);
            (x + driven.plus_product(by[1], speed)).each()
        };
        [
            from(current, self.state[0], self.state_by_command[0]),
            from(speed, self.state[1], self.state_by_command[1]),
            from(like.like(angle), self.angle, self.angle_by_command),
        ]
    }
}

const _: () = assert!(STARTS == LANES);

impl<T: Token, const M: usize> Motion<T, M> {
    /// Adds the errors of a stride from a state to `sums`; `driven` is its angles by the command.
    #[inline(always)]
    fn add<C: Summand>(
        &self,
        driven: &Stride<T, M>,
        LinearState { state, angle }: LinearState,
        readings: &[f64; STRIDE],
        sums: &mut [[Lanes<T, M>; 2]; ROWS],
    ) {
        let readings = rows(self.zero, readings);
        let (angle, current, speed) = (
            self.zero.like(angle),
            self.zero.like(state[0]),
            self.zero.like(state[1]),
        );
        for row in 0..ROWS {
            let error = ((driven[row] + angle) - readings[row])
                .plus_product(self.by_current[row], current)
                .plus_product(self.by_speed[row], speed);
            C::add(error, &mut sums[row]);
        }
    }

    /// Level and slope of the angle, counts and counts a sample, where the transient has died away.
    #[inline(always)]
    fn line(&self, motor: &LinearState, command: f64) -> Option<[f64; 2]> {
        let settling = self.settling.as_ref()?;
        let path = settling.path(motor, command)?;
        (settling.transient_bound(path.deviation) < SETTLED_COUNTS)
            .then_some([path.level, path.slope])
    }
}

impl Sum<'_> {
    #[inline(always)]
    fn block<T: Token, const M: usize, C: Summand>(
        &self,
        motion: &Motion<T, M>,
        mut motor: LinearState,
        command: f64,
        readings: &[f64],
        sums: &mut [[Lanes<T, M>; 2]; ROWS],
    ) {
        let zero = motion.zero;
        let (strides, rest) = readings.as_chunks::<STRIDE>();
        let mut driven = motion.by_command;
        if let Some([level, slope]) = motion.line(&motor, command) {
            let mut line = [0.0; STRIDE];
            for (k, line) in line.iter_mut().enumerate() {
                *line = slope * k as f64;
            }
            driven = rows(zero, &line);
            let rise = slope * STRIDE as f64;
            for (k, stride) in strides.iter().enumerate() {
                let readings = rows(zero, stride);
                let angle = zero.like(level + rise * k as f64);
                for row in 0..ROWS {
                    C::add((driven[row] + angle) - readings[row], &mut sums[row]);
                }
            }
            motor = LinearState {
                state: [0.0; 2],
                angle: level + rise * strides.len() as f64,
            };
        } else {
            let command_in_lanes = zero.like(command);
            for driven in &mut driven {
                *driven = *driven * command_in_lanes;
            }
            for strides in strides.chunks(STARTS) {
                let [currents, speeds, angles] = motion.begins.states(motor, command);
                for (k, stride) in strides.iter().take(STARTS).enumerate() {
                    let motor = LinearState {
                        state: [currents[k], speeds[k]],
                        angle: angles[k],
                    };
                    motion.add::<C>(&driven, motor, stride, sums);
                }
                if strides.len() == STARTS {
                    motor = self.hold.group().advance(motor, command);
                } else {
                    let k = strides.len();
                    motor = LinearState {
                        state: [currents[k], speeds[k]],
                        angle: angles[k],
                    };
                }
            }
        }
        if !rest.is_empty() {
            // Less than a stride: the padding does not count.
            let (mut padded, mut counts) = ([0.0; STRIDE], [0.0; STRIDE]);
            padded[..rest.len()].copy_from_slice(rest);
            counts[..rest.len()].fill(1.0);
            let counts = rows(zero, &counts);
            let mut some = [[zero; 2]; ROWS];
            motion.add::<C>(&driven, motor, &padded, &mut some);
            for row in 0..ROWS {
                for which in 0..C::SUMS {
                    sums[row][which] = sums[row][which] + some[row][which] * counts[row];
                }
            }
        }
    }
}
