//! Response of the linear motor to a command that is held constant (zero-order hold), at any later sample, without the
//! samples between.
//!
//! With the state `x` (current, speed) at the first sample and the command `c`, all per unit, the angle `k` samples later is
//!
//! ```text
//! θ(k) = θ(0) + a(k)·x + α(k)·c        counts
//! ```
//!
//! What `n` samples add to the state, to the angle and to the sum of the angles has the same form. Doubling `n`
//! (`2·E + E²` for the state, where `E` is the matrix exponential less one) costs a few products. Nothing is divided and
//! no large numbers cancel, so slow, equal and complex modes keep their digits. All of it comes from the increments of
//! the model's own step ([`Increments`]).
//!
//! Where the motor settles, `settling` needs less.

use shared::model::Increments;

/// Samples of a stride: their angles are computed from one state.
pub const STRIDE: usize = 32;
/// Strides in the longest span.
pub const STRIDES: usize = 16;
/// Strides of a group: their first states are computed from one state, one to a lane.
pub const STARTS: usize = 8;
/// Number of spans: of 1, 2, 4 … samples.
const SPANS: usize = (STRIDE * STRIDES).ilog2() as usize + 1;
/// Index of the span of a stride.
const STRIDE_SPAN: usize = STRIDE.ilog2() as usize;
/// Index of the span of a group.
const GROUP_SPAN: usize = STRIDE_SPAN + STARTS.ilog2() as usize;

type PerStart = [f64; STARTS];
pub(super) type Pair = [f64; 2];
pub(super) type Matrix = [Pair; 2];

#[inline(always)]
pub(super) fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

#[inline(always)]
pub(super) fn times(a: &Matrix, x: Pair) -> Pair {
    [dot(a[0], x), dot(a[1], x)]
}

/// Row by matrix.
#[inline(always)]
pub(super) fn row_times(x: Pair, a: &Matrix) -> Pair {
    [
        x[0] * a[0][0] + x[1] * a[1][0],
        x[0] * a[0][1] + x[1] * a[1][1],
    ]
}

#[inline(always)]
pub(super) fn plus(a: Pair, b: Pair) -> Pair {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn determinant(a: &Matrix) -> f64 {
    a[0][0] * a[1][1] - a[0][1] * a[1][0]
}

/// What a number of samples under a held command adds.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Number of samples.
    pub samples: f64,
    /// To the state, by state and by command.
    pub state: Matrix,
    /// See [`state`](Self::state).
    pub state_by_command: Pair,
    /// To the angle, counts.
    pub angle: Pair,
    /// See [`angle`](Self::angle).
    pub angle_by_command: f64,
    /// To the sum of their angles above the first one's, counts.
    sum: Pair,
    sum_by_command: f64,
}

impl Span {
    fn of_step(step: &Increments) -> Self {
        Span {
            samples: 1.0,
            state: step.state,
            state_by_command: step.state_by_command,
            angle: step.angle,
            angle_by_command: step.angle_by_command,
            sum: [0.0; 2],
            sum_by_command: 0.0,
        }
    }

    /// The span of twice as many samples. The second half starts where the first one ends: `2·E + E²` keeps the digits
    /// of slow modes.
    #[inline(always)]
    fn doubled(&self) -> Self {
        let e = &self.state;
        let doubled = |row: Pair| {
            let further = row_times(row, e);
            [2.0 * row[0] + further[0], 2.0 * row[1] + further[1]]
        };
        let by = self.state_by_command;
        let pushed = |row: Pair, push: f64| 2.0 * push + dot(row, by);
        let sum = doubled(self.sum);
        Span {
            samples: 2.0 * self.samples,
            state: [doubled(e[0]), doubled(e[1])],
            state_by_command: [pushed(e[0], by[0]), pushed(e[1], by[1])],
            angle: doubled(self.angle),
            angle_by_command: pushed(self.angle, self.angle_by_command),
            sum: [
                sum[0] + self.samples * self.angle[0],
                sum[1] + self.samples * self.angle[1],
            ],
            sum_by_command: pushed(self.sum, self.sum_by_command)
                + self.samples * self.angle_by_command,
        }
    }

    /// The state after the span.
    #[inline(always)]
    pub fn advance(&self, LinearState { state, angle }: LinearState, command: f64) -> LinearState {
        // In this order: the next span waits for the state.
        let by = self.state_by_command.map(|by| by * command);
        LinearState {
            state: plus(plus(state, by), times(&self.state, state)),
            angle: angle + (dot(self.angle, state) + self.angle_by_command * command),
        }
    }

    /// Sum of the angles of the span's samples.
    #[inline(always)]
    fn angle_sum(&self, LinearState { state, angle }: LinearState, command: f64) -> AngleSum {
        let level = self.samples * angle;
        let [by_current, by_speed] = self.sum;
        let rises = [
            by_current * state[0],
            by_speed * state[1],
            self.sum_by_command * command,
        ];
        let [current, speed, driven] = rises.map(f64::abs);
        AngleSum {
            sum: level + ((rises[0] + rises[1]) + rises[2]),
            terms: level.abs() + ((current + speed) + driven),
        }
    }
}

/// Response of a linear motor to a held command, over spans of 1, 2, 4 … samples.
pub struct HoldResponse {
    spans: [Span; SPANS],
}

/// State of the linear motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearState {
    /// Current and speed, per unit.
    pub state: Pair,
    /// Angle, counts.
    pub angle: f64,
}

/// Sum of the angles of some samples, counts, and the sum of the magnitudes of its terms.
#[derive(Clone, Copy, Debug, Default)]
pub struct AngleSum {
    /// The sum.
    pub sum: f64,
    /// Magnitudes of its terms.
    pub terms: f64,
}

/// Angles of the samples of a stride above that of the first, counts.
#[derive(Clone, Copy)]
pub struct StrideAngles {
    /// By current and by speed at the first.
    pub by_state: [[f64; STRIDE]; 2],
    /// By the command.
    pub by_command: [f64; STRIDE],
}

/// The states at the first samples of the strides of a group, by the state at the start of the first.
pub struct StrideStarts {
    /// To the state, by state and by command.
    pub state: [[PerStart; 2]; 2],
    /// See [`state`](Self::state).
    pub state_by_command: [PerStart; 2],
    /// To the angle, counts.
    pub angle: [PerStart; 2],
    /// See [`angle`](Self::angle).
    pub angle_by_command: PerStart,
}

impl HoldResponse {
    /// `None` for motors whose modes grow.
    // Inlined, as what it makes is large to be handed on.
    #[inline(always)]
    pub fn new(step: &Increments) -> Option<Self> {
        let mut span = Span::of_step(step);
        let spans: [Span; SPANS] = std::array::from_fn(|doubling| {
            if doubling > 0 {
                span = span.doubled();
            }
            span
        });
        let stride = &spans[STRIDE_SPAN].state;
        let by_trace = stride[0][0] + stride[1][1];
        let gap = determinant(stride);
        let determinant = 1.0 + by_trace + gap;
        // Both modes within the unit circle; infinities and NaN are not.
        let settles = gap > 0.0 && determinant < 1.0 && 2.0 + by_trace + determinant > -1.0;
        settles.then_some(HoldResponse { spans })
    }

    /// Span of one sample.
    pub fn step(&self) -> &Span {
        &self.spans[0]
    }

    /// Span of a stride.
    #[inline(always)]
    pub fn stride(&self) -> &Span {
        &self.spans[STRIDE_SPAN]
    }

    /// Span of a group of strides.
    #[inline(always)]
    pub fn group(&self) -> &Span {
        &self.spans[GROUP_SPAN]
    }

    /// The state after `samples` samples, and the sum of their angles.
    #[inline(always)]
    pub fn advance(
        &self,
        from: LinearState,
        command: f64,
        samples: usize,
    ) -> (LinearState, AngleSum) {
        let (mut motor, mut angle_sum) = (from, AngleSum::default());
        let mut go = |span: &Span| {
            let some = span.angle_sum(motor, command);
            angle_sum.sum += some.sum;
            angle_sum.terms += some.terms;
            motor = span.advance(motor, command);
        };
        let longest = SPANS - 1;
        for _ in 0..samples >> longest {
            go(&self.spans[longest]);
        }
        let mut rest = samples % (1 << longest);
        while rest > 0 {
            go(&self.spans[rest.trailing_zeros() as usize]);
            rest &= rest - 1;
        }
        (motor, angle_sum)
    }

    /// The angles in a stride.
    #[inline(always)]
    pub fn stride_angles(&self) -> StrideAngles {
        let mut ahead = StrideAngles {
            by_state: [[0.0; STRIDE]; 2],
            by_command: [0.0; STRIDE],
        };
        for (doubling, span) in self.spans[..STRIDE_SPAN].iter().enumerate() {
            double_table(
                span,
                1 << doubling,
                &mut ahead.by_state,
                &mut ahead.by_command,
                span.angle,
                span.angle_by_command,
            );
        }
        ahead
    }

    /// The states at which the strides of a group start.
    #[inline(always)]
    pub fn stride_starts(&self) -> StrideStarts {
        let none = [0.0; STARTS];
        let mut begins = StrideStarts {
            state: [[none; 2]; 2],
            state_by_command: [none; 2],
            angle: [none; 2],
            angle_by_command: none,
        };
        for (doubling, span) in self.spans[STRIDE_SPAN..GROUP_SPAN].iter().enumerate() {
            let known = 1 << doubling;
            for k in 0..2 {
                let (rows, by) = (&mut begins.state[k], &mut begins.state_by_command[k]);
                double_table(
                    span,
                    known,
                    rows,
                    by,
                    span.state[k],
                    span.state_by_command[k],
                );
            }
            let (rows, by) = (&mut begins.angle, &mut begins.angle_by_command);
            double_table(span, known, rows, by, span.angle, span.angle_by_command);
        }
        begins
    }
}

/// Doubles a table of what so many spans of a length add to something, `added` by state and `driven` by command being what
/// as many of them add as are known: those, and then the others.
#[inline(always)]
fn double_table<const N: usize>(
    span: &Span,
    known: usize,
    [by_current, by_speed]: &mut [[f64; N]; 2],
    by_command: &mut [f64; N],
    added: Pair,
    driven: f64,
) {
    let (current, current_on) = by_current.split_at_mut(known);
    let (speed, speed_on) = by_speed.split_at_mut(known);
    let (command, command_on) = by_command.split_at_mut(known);
    for k in 0..known {
        let row = [current[k], speed[k]];
        let more = row_times(row, &span.state);
        current_on[k] = added[0] + (row[0] + more[0]);
        speed_on[k] = added[1] + (row[1] + more[1]);
        command_on[k] = driven + (command[k] + dot(row, span.state_by_command));
    }
}
