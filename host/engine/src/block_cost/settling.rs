//! The angle of a settling motor under a held command: a line and a transient that dies away.
//!
//! The deviation `d` of the state from its steady value obeys `d(k+1) = (I + E)·d(k)`. So `θ(k) = level + slope·k + z(k)`
//! with `z = P·d` and `P = T·E⁻¹`, where `T` is what a step adds to the angle by the state.

use super::zero_order_hold::{
    HoldResponse, LinearState, Matrix, Pair, StrideAngles, determinant, dot, row_times, times,
};

/// Largest allowed rounding error of an angle, counts. Slow modes make line and transient large numbers of opposite
/// sign; where their difference may have lost more than this, the split is not used.
const ANGLE_ERROR_COUNTS: f64 = 1e-7;
/// Rounding error of line and transient, relative to the transient.
const ROUNDINGS: f64 = 64.0 * f64::EPSILON;

/// A motor whose transients die away.
pub struct Settling {
    /// Inverse of a step's increments.
    inverse: Matrix,
    /// What a step adds to the state and to the angle, by command.
    by_command: (Pair, f64),
    /// To the angle, by state.
    angle: Pair,
    /// Transient by state.
    transient: Pair,
    /// Largest magnitude of the transient at any sample of a stride, by each part of the state at its start.
    most: Pair,
}

/// The angle under a held command as a line and a transient.
#[derive(Clone, Copy, Debug)]
pub struct LineAndTransient {
    /// The line at the first sample, counts.
    pub level: f64,
    /// Rise of the line with each sample, counts.
    pub slope: f64,
    /// Deviation of the state from its steady value, at the start.
    pub deviation: Pair,
}

impl Settling {
    /// `None` for a motor without a steady state.
    #[inline(always)]
    pub fn new(hold: &HoldResponse, ahead: &StrideAngles) -> Option<Self> {
        let step = hold.step();
        let e = step.state;
        let det = determinant(&e);
        if det.is_nan() || det.abs() <= f64::MIN_POSITIVE {
            return None;
        }
        let inverse = [
            [e[1][1] / det, -e[0][1] / det],
            [-e[1][0] / det, e[0][0] / det],
        ];
        let transient = row_times(step.angle, &inverse);
        let mut settling = Settling {
            inverse,
            by_command: (step.state_by_command, step.angle_by_command),
            angle: step.angle,
            transient,
            most: [0.0; 2],
        };
        let tables = ahead.by_state.iter().zip(&mut settling.most);
        for ((table, largest), transient) in tables.zip(transient) {
            // Eight by eight, which the processor does at once.
            let mut most = [0.0; 8];
            let (rows, _) = table.as_chunks::<8>();
            for row in rows {
                for (ahead, most) in row.iter().zip(&mut most) {
                    let x = (ahead + transient).abs();
                    *most = if x > *most { x } else { *most };
                }
            }
            *largest = most.into_iter().fold(0.0, f64::max);
        }
        Some(settling)
    }

    /// Line and transient from a state under a command; `None` where rounding would show.
    #[inline(always)]
    pub fn path(&self, from: &LinearState, command: f64) -> Option<LineAndTransient> {
        let (state_by, angle_by) = self.by_command;
        let rest = times(&self.inverse, state_by.map(|by| by * command)).map(|x| -x);
        let off = [from.state[0] - rest[0], from.state[1] - rest[1]];
        let terms = (self.transient[0] * off[0]).abs() + (self.transient[1] * off[1]).abs();
        // A NaN is not below it either.
        (ROUNDINGS * terms < ANGLE_ERROR_COUNTS).then(|| LineAndTransient {
            level: from.angle - dot(self.transient, off),
            slope: dot(self.angle, rest) + angle_by * command,
            deviation: off,
        })
    }

    /// Upper bound of the transient at any sample of a stride that starts with a deviation, counts.
    #[inline(always)]
    pub fn transient_bound(&self, off: Pair) -> f64 {
        (self.most[0] * off[0]).abs() + (self.most[1] * off[1]).abs()
    }
}
