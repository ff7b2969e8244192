//! What a linear motor does while its command is held, at any sample, without the samples before.
//!
//! The state less where it tends to, `d`, then obeys `d(k+1) = (I + E)·d(k)`, so that the angle is a line and a
//! transient, `θ(k) = level + slope·k + z(k)` with `z = P·d` and `P = T·E⁻¹`, `T` being what a step's angle takes of
//! the state. Transients `s` samples apart obey
//!
//! ```text
//! z(k+s) = tr·z(k) − det·z(k−s)
//! ```
//!
//! with trace and determinant of `(I + E)^s` (Cayley, Hamilton). So two products give an angle, whatever the modes,
//! equal and complex ones too, and neighbouring samples do not wait for each other. Sums of the transient over
//! samples follow from its ends: `Σ z = P·E⁻¹·(d(end) − d(start))`.
//!
//! All of it comes from the increments of the model's own step.

use shared::model::Increments;

/// Samples from a transient to the one that follows from it.
pub const STRIDE: usize = 32;
/// Strides that are looked ahead.
pub const STRIDES: usize = 16;
/// Doublings from a step to the longest map, of which shorter paths are put together.
const DOUBLINGS: usize = 12;
/// Which of them is a stride.
const OF_STRIDE: usize = STRIDE.ilog2() as usize;
/// Error of an angle that is allowed, counts. A motor whose modes are so slow that rounding might add up to more
/// is left to plain steps.
pub(super) const ANGLE_ERROR_COUNTS: f64 = 1e-7;

type Pair = [f64; 2];
type Matrix = [Pair; 2];

fn dot(a: Pair, b: Pair) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn times(a: &Matrix, x: Pair) -> Pair {
    [dot(a[0], x), dot(a[1], x)]
}

/// Row by matrix.
fn across(x: Pair, a: &Matrix) -> Pair {
    [
        x[0] * a[0][0] + x[1] * a[1][0],
        x[0] * a[0][1] + x[1] * a[1][1],
    ]
}

fn plus(a: Pair, b: Pair) -> Pair {
    [a[0] + b[0], a[1] + b[1]]
}

fn determinant(a: &Matrix) -> f64 {
    a[0][0] * a[1][1] - a[0][1] * a[1][0]
}

/// Increments of twice as many steps: `2·E + E²`, which keeps the digits of slow ones.
fn twice(e: &Matrix) -> Matrix {
    let doubled = |k: usize| {
        let squared = across(e[k], e);
        [2.0 * e[k][0] + squared[0], 2.0 * e[k][1] + squared[1]]
    };
    [doubled(0), doubled(1)]
}

/// A linear motor, ready to be held.
pub struct Held {
    increments: Increments,
    /// `E` of 1, 2, 4 … steps.
    maps: [Matrix; DOUBLINGS],
    /// Inverse of the first.
    inverse: Matrix,
    /// Transient by state.
    transient: Pair,
    /// Sum of the transient by state.
    summed: Pair,
    /// Transient after each of the samples of a stride by the state at its start.
    ahead: [[f64; STRIDE]; 2],
    /// Largest magnitude of each of these.
    most: Pair,
    /// Trace and determinant of the map of a stride.
    pub trace: f64,
    /// See [`trace`](Self::trace).
    pub determinant: f64,
    /// What a rounding of the transient grows to, at most.
    growth: f64,
}

/// Where a motor is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Current and speed, per unit.
    pub state: Pair,
    /// Angle, counts.
    pub angle: f64,
}

/// What a held command makes of a motor: its angle as a line and a transient.
#[derive(Clone, Copy, Debug)]
pub struct Path {
    /// Where the line begins, counts.
    pub level: f64,
    /// How it rises with each sample, counts.
    pub slope: f64,
    /// Where the state tends to.
    rest: Pair,
    /// The state less that, at the start.
    pub off: Pair,
}

impl Held {
    /// `None` for motors that do not settle.
    pub fn new(increments: Increments) -> Option<Self> {
        let e = increments.state;
        let det = determinant(&e);
        let inverse = [
            [e[1][1] / det, -e[0][1] / det],
            [-e[1][0] / det, e[0][0] / det],
        ];
        let mut maps = [e; DOUBLINGS];
        for k in 1..DOUBLINGS {
            maps[k] = twice(&maps[k - 1]);
        }
        let of_stride = maps[OF_STRIDE];
        let by_trace = of_stride[0][0] + of_stride[1][1];
        let gap = determinant(&of_stride);
        let determinant = 1.0 + by_trace + gap;
        // Both modes within the unit circle; infinities and NaN are not.
        let settles = gap > 0.0 && determinant < 1.0 && 2.0 + by_trace + determinant > -1.0;
        if !(settles && det.abs() > f64::MIN_POSITIVE) {
            return None;
        }
        let transient = across(increments.angle, &inverse);
        // Sum of the stride's impulse response: exact for real modes, a bound for complex ones.
        let growth = 1.0 / gap.min((1.0 - determinant.max(0.0).sqrt()).powi(2));
        let mut held = Held {
            increments,
            maps,
            inverse,
            transient,
            summed: across(transient, &inverse),
            ahead: [[0.0; STRIDE]; 2],
            most: [0.0; 2],
            trace: 2.0 + by_trace,
            determinant,
            growth,
        };
        held.look_ahead();
        Some(held)
    }

    fn look_ahead(&mut self) {
        [self.ahead[0][0], self.ahead[1][0]] = self.transient;
        let [by_current, by_speed] = &mut self.ahead;
        for (doubling, map) in self.maps.iter().enumerate().take(OF_STRIDE) {
            let known = 1 << doubling;
            let (near, far) = by_current.split_at_mut(known);
            let (near_speed, far_speed) = by_speed.split_at_mut(known);
            for k in 0..known {
                let row = [near[k], near_speed[k]];
                let row = plus(row, across(row, map));
                [far[k], far_speed[k]] = row;
            }
        }
        self.most = self
            .ahead
            .map(|row| row.iter().fold(0.0, |most, x| x.abs().max(most)));
    }

    /// Bound of the transients of a stride that begins in a state, counts.
    #[inline(always)]
    pub fn largest(&self, off: Pair) -> f64 {
        (self.most[0] * off[0]).abs() + (self.most[1] * off[1]).abs()
    }

    /// The path from a place under a command; `None` where rounding may tell.
    pub fn path(&self, from: &Place, command: f64) -> Option<Path> {
        let pushed = self.increments.state_by_command.map(|by| by * command);
        let rest = times(&self.inverse, pushed).map(|x| -x);
        let off = [from.state[0] - rest[0], from.state[1] - rest[1]];
        let terms = (self.transient[0] * off[0]).abs() + (self.transient[1] * off[1]).abs();
        let rounding = 4.0 * f64::EPSILON * terms * self.growth;
        // A NaN is not below it either.
        (rounding < ANGLE_ERROR_COUNTS).then(|| Path {
            level: from.angle - dot(self.transient, off),
            slope: dot(self.increments.angle, rest) + self.increments.angle_by_command * command,
            rest,
            off,
        })
    }

    /// The state less where it tends to, so many samples on.
    pub fn on(&self, off: Pair, samples: usize) -> Pair {
        let (last, longest) = (&self.maps[DOUBLINGS - 1], 1 << (DOUBLINGS - 1));
        let mut off = off;
        for _ in 0..samples / longest {
            off = plus(off, times(last, off));
        }
        let mut rest = samples % longest;
        while rest > 0 {
            off = plus(off, times(&self.maps[rest.trailing_zeros() as usize], off));
            rest &= rest - 1;
        }
        off
    }

    /// Of the state less where it tends to, what its current and its speed have at the start of each of so many strides, by
    /// current and by speed at the start of the first: `[[current by current, by speed], [speed by current, by speed]]`.
    pub fn at_strides(&self) -> [[[f64; STRIDES]; 2]; 2] {
        let mut at = [[[0.0; STRIDES]; 2]; 2];
        (at[0][0][0], at[1][1][0]) = (1.0, 1.0);
        for (doubling, map) in self.maps[OF_STRIDE..].iter().enumerate() {
            let known = 1 << doubling;
            if known >= STRIDES {
                break;
            }
            for [by_current, by_speed] in &mut at {
                for k in 0..known {
                    let row = [by_current[k], by_speed[k]];
                    [by_current[known + k], by_speed[known + k]] = plus(row, across(row, map));
                }
            }
        }
        at
    }

    /// Largest magnitudes in [`ahead`](Self::ahead).
    #[inline(always)]
    pub fn most(&self) -> [f64; 2] {
        self.most
    }

    /// Transient after each of the samples of a stride by the state, less where it tends to, at its start: counts per unit of
    /// current and of speed.
    #[inline(always)]
    pub fn ahead(&self) -> [&[f64; STRIDE]; 2] {
        self.ahead.each_ref()
    }

    /// Where a path ends after so many samples, `off` being its state there.
    pub fn end(&self, path: &Path, samples: usize, off: Pair) -> Place {
        Place {
            state: plus(path.rest, off),
            angle: path.level + path.slope * samples as f64 + dot(self.transient, off),
        }
    }

    /// Sum of the transient from one state of a path to another, and how large what was added up is.
    pub fn sum(&self, from: Pair, to: Pair) -> (f64, f64) {
        let terms = |x: Pair| (self.summed[0] * x[0]).abs() + (self.summed[1] * x[1]).abs();
        (
            dot(self.summed, to) - dot(self.summed, from),
            terms(from) + terms(to),
        )
    }

    /// Transient at each sample of the stride that begins in a state.
    #[inline(always)]
    pub fn transients(&self, off: Pair) -> [f64; STRIDE] {
        // Not `from_fn`, which was not inlined.
        let mut transients = [0.0; STRIDE];
        for (k, transient) in transients.iter_mut().enumerate() {
            *transient = self.ahead[0][k] * off[0] + self.ahead[1][k] * off[1];
        }
        transients
    }
}
