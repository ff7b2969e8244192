//! A fitted motor predicts a recording that it has not seen, period by period, as a device drives it.
//!
//! Beside it run two motors that are displaced in gain over time constant and in the time constant, all else as the fitted recording wants it
//! then. So one step of Gauss and Newton's method tells, at the end, which gain and time constant the new recording would have.

use super::covariance::Covariance;
use super::differences::Differences;
use super::evaluation::{Runs, build};
use super::motor::Motor;
use super::{Arithmetic, MOST, Point, Space};
use crate::scalar::Real;
use heapless::Deque;
use serde::{Deserialize, Serialize};

/// How well a fitted motor predicts what it has not seen.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Predicted {
    /// Mean squared error, counts².
    pub mean_square: f32,
    /// Over so many periods.
    pub periods: u32,
    /// RMS of the error that grows in a window, mostly of 50 ms, as a part of that of one who takes it that the speed stays; not a number where none could be seen.
    pub by_persistence: f32,
    /// By which part the gain would differ by this recording.
    pub gain: f32,
    /// By which part the time constant would.
    pub time_constant: f32,
}

/// Largest error over a window as a part of that of one who takes it that the speed stays, of a motor that predicts.
const MOST_BY_PERSISTENCE: f32 = 0.5;

impl Predicted {
    /// Whether it predicts much better than one who takes it that the speed stays.
    pub fn beats_persistence(&self) -> bool {
        self.by_persistence <= MOST_BY_PERSISTENCE
    }
}

/// A displacement moves the reading by about this, counts RMS …
const VISIBLE: f32 = 1.0;
/// … or by this part of the error that the fit left.
const ROUGH: f32 = 0.3;
/// Longest displacement, of the cube's edge: three percent of an ordinary range of logarithms.
const LONGEST: f32 = 0.003;

/// Periods that may wait: where the shaft stops or starts, three models together take longer than a small core's period. As many as there is
/// room for in what the search needs.
const WAITING: usize = 256;

/// What predicts: a fitted motor and the two displaced ones. All that a device keeps of a fit to tell later whether its motor is still that one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Predictors {
    motors: [Motor; 3],
    /// What each displacement adds to the logarithms of gain and time constant.
    adds: [[f32; 2]; 2],
}

impl Predictors {
    /// Of nothing: all zeros.
    pub const NONE: Self = Predictors {
        motors: [Motor::NONE; 3],
        adds: [[0.0; 2]; 2],
    };

    /// Of the motor at `best`, which left `least` counts² of its recording of `fitted` periods.
    pub(super) fn of(
        space: &Space,
        best: &Point,
        covariance: &Covariance,
        least: f32,
        fitted: usize,
    ) -> Self {
        let mut predictors = Predictors {
            motors: [space.motor(best); 3],
            adds: [[0.0; 2]; 2],
        };
        for (k, adds) in predictors.adds.iter_mut().enumerate() {
            // The fit's standard deviation of the coordinate is the move that adds σ² to the sum of squares.
            let mut axis = [0.0; MOST];
            axis[k] = 1.0;
            let std = covariance.curvature_std(&axis);
            let seen = Real::sqrt(least / fitted.max(1) as f32);
            let visible = VISIBLE.max(ROUGH * Real::sqrt(least));
            let moved = if seen > 0.0 {
                std * visible / seen
            } else {
                LONGEST
            }
            .min(LONGEST);
            let along = covariance.along(k);
            let mut x = *best;
            for (j, (x, by)) in x.iter_mut().zip(along).enumerate() {
                *x += moved * by;
                if j > 1 {
                    *x = x.clamp(0.0, 1.0);
                }
            }
            predictors.motors[k + 1] = space.motor(&x);
            for (of, add) in adds.iter_mut().enumerate() {
                *add = space.gradient(of, best)[k] * moved / space.value(of, best);
            }
        }
        predictors
    }
}

/// A prediction under way.
#[derive(Clone, Debug)]
pub(super) struct Prediction {
    differences: Differences,
    /// Duties and steps of the periods that the models have yet to run, and how many of the models have run the first of them.
    waiting: Deque<(i16, i16), WAITING>,
    turn: usize,
    /// There was no room for a period: it and those after it are not predicted.
    ended: bool,
    errors: [f32; 3],
    /// See [`Predictors`].
    adds: [[f32; 2]; 2],
    window: Window,
}

/// Errors over windows of time.
#[derive(Clone, Copy, Debug)]
struct Window {
    periods: u32,
    left: u32,
    /// Travel in the last whole window, counts; a window before it is there.
    before: i32,
    ended: u32,
    travelled: i32,
    error: f32,
    /// Sums of squares of the model's error and of persistence's.
    sums: [f32; 2],
}

impl Window {
    const EMPTY: Self = Window {
        periods: 0,
        left: 0,
        before: 0,
        ended: 0,
        travelled: 0,
        error: 0.0,
        sums: [0.0; 2],
    };

    fn step(&mut self, step: i16, error: f32) {
        self.travelled += i32::from(step);
        self.left -= 1;
        if self.left > 0 {
            return;
        }
        self.left = self.periods;
        if self.ended > 0 {
            let by_model = error - self.error;
            let by_persistence = (self.travelled - self.before) as f32;
            self.sums[0] += by_model * by_model;
            self.sums[1] += by_persistence * by_persistence;
        }
        self.ended += 1;
        (self.before, self.travelled, self.error) = (self.travelled, 0, error);
    }
}

impl Prediction {
    pub(super) const EMPTY: Self = Prediction {
        differences: Differences::EMPTY,
        waiting: Deque::new(),
        turn: 0,
        ended: false,
        errors: [0.0; 3],
        adds: [[0.0; 2]; 2],
        window: Window::EMPTY,
    };

    /// Begins a prediction of about so many periods, judged over windows of `window`. Says whether there are such motors.
    // Out of line, for the sake of the stack.
    #[inline(never)]
    pub(super) fn begin<S: Arithmetic>(
        &mut self,
        runs: &mut Runs<S>,
        predictors: &Predictors,
        periods: u32,
        window: u32,
    ) -> bool {
        self.differences.begin(periods as usize);
        self.window = Window {
            periods: window.max(1),
            left: window.max(1),
            ..Window::EMPTY
        };
        self.adds = predictors.adds;
        let mut built = true;
        for (run, motor) in runs.iter_mut().zip(&predictors.motors) {
            built &= build(run, motor, f32::INFINITY);
        }
        built
    }

    /// One period: the duty acted, and the reading is `step` counts further.
    pub(super) fn observe(&mut self, duty: i16, step: i16) {
        self.ended |= self.waiting.is_full();
        if !self.ended {
            let _ = self.waiting.push_back((duty, step));
        }
    }

    /// Runs the models along at most about `samples` periods that wait, all together. Says whether none is left.
    pub(super) fn catch_up<S: Arithmetic>(&mut self, runs: &mut Runs<S>, samples: u32) -> bool {
        let mut used = 0;
        while used < samples && !self.waiting.is_empty() {
            used += self.step(runs);
        }
        self.waiting.is_empty()
    }

    /// Runs the next model along the first period that waits; returns what that cost, in samples.
    fn step<S: Arithmetic>(&mut self, runs: &mut Runs<S>) -> u32 {
        let Some(&(duty, step)) = self.waiting.front() else {
            return 0;
        };
        let mut used = 1;
        if let Some(model) = runs[self.turn].model() {
            model.step(duty, step);
            self.errors[self.turn] = model.error();
            used = model.cost_of_step();
        }
        self.turn += 1;
        if self.turn == runs.len() {
            self.turn = 0;
            self.waiting.pop_front();
            self.differences.add(self.errors);
            self.window.step(step, self.errors[0]);
        }
        used
    }

    /// How well it predicted so far.
    pub(super) fn so_far<S: Arithmetic>(&self, runs: &mut Runs<S>) -> Predicted {
        let periods = self.differences.at as u32;
        let mut differences = self.differences;
        let products = differences.products();
        let ([ea, eb], [aa, ab, bb]) = (products.slopes, products.squares);
        let determinant = aa * bb - ab * ab;
        // In displacements.
        let moves = [
            -(bb * ea - ab * eb) / determinant,
            -(aa * eb - ab * ea) / determinant,
        ];
        let [a, b] = self.adds;
        let by = |k: usize| a[k] * moves[0] + b[k] * moves[1];
        let [by_model, by_persistence] = self.window.sums;
        Predicted {
            mean_square: runs[0]
                .model()
                .map_or(f32::INFINITY, |model| model.mean_square(periods)),
            periods,
            by_persistence: Real::sqrt(by_model / by_persistence),
            gain: by(0),
            time_constant: by(1),
        }
    }
}
