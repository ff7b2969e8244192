//! The loop over the samples: models run along the data, for one candidate's number or for several in lanes.

use super::horizon::Correction;
use crate::data::Data;
use shared::model::{MeasuredInterval, Model, State};
use shared::scalar::{Mask, Scalar};
use std::ops::Range;

/// A number that models run with: `f64` for one candidate, [`Lanes`](crate::lanes::Lanes) for several.
pub trait Number: Scalar<Coefficient = Self, Angle = Self> {}

impl<S: Scalar<Coefficient = S, Angle = S>> Number for S {}

/// How a model is propagated.
#[derive(Clone, Copy)]
pub enum Mode<'a> {
    /// Parallel model: only the commands drive it (output error).
    Free,
    /// Observer: output injection pulls it towards the readings with both poles of the error at one over so many
    /// seconds, so that a single event, such as a slipped detent, is forgotten.
    Observer(f64),
    /// Observer with gains of its own at each of these samples, in rising order; in between only the commands drive it.
    Corrected(&'a [Correction]),
    /// Series-parallel model: its effects see the measured motion (equation error).
    SeriesParallel {
        /// The measured motion, one entry an interval.
        seen: &'a [MeasuredInterval<f64>],
        /// Measured angle within the revolution, turns, one entry a sample.
        turns: &'a [f64],
    },
}

/// The data, and a model for each length of interval in them.
pub struct Propagator<'a, S: Scalar> {
    /// The data.
    pub data: &'a Data,
    /// The models.
    pub models: &'a [Model<S>],
}

impl<S: Number> Propagator<'_, S> {
    /// Runs from a state over the samples of `range`; calls `each` with the sample's index and the model's encoder angle
    /// there, counts. Returns the state after the range.
    #[inline(always)]
    pub fn run(
        &self,
        mode: Mode<'_>,
        state: State<S>,
        range: Range<usize>,
        each: impl FnMut(usize, S),
    ) -> State<S> {
        let (memory_s, corrections) = match mode {
            Mode::Free => (None, &[][..]),
            Mode::Observer(memory_s) => (Some(memory_s), &[][..]),
            Mode::Corrected(corrections) => {
                let passed = corrections.partition_point(|c| c.sample < range.start);
                (None, &corrections[passed..])
            }
            Mode::SeriesParallel { seen, turns } => {
                return self.series_parallel(state, range, seen, turns, each);
            }
        };
        self.parallel(state, range, memory_s, corrections, each)
    }

    #[inline(always)]
    fn model(&self, k: usize) -> &Model<S> {
        &self.models[self.data.length_of[k] as usize]
    }

    #[inline(always)]
    fn command(&self, k: usize) -> S {
        S::from_f64(self.data.command[k])
    }

    #[inline(always)]
    fn temperature(&self, k: usize) -> S {
        S::from_f64(self.data.temperature(k))
    }

    /// Runs as a parallel model, as an observer where there is a memory, or as one that is corrected at some samples.
    // One loop for all: the whole model is compiled into it.
    #[inline(always)]
    fn parallel(
        &self,
        mut state: State<S>,
        range: Range<usize>,
        memory_s: Option<f64>,
        mut corrections: &[Correction],
        mut each: impl FnMut(usize, S),
    ) -> State<S> {
        let mut k = range.start;
        while k < range.end {
            let (next, rest) = match corrections.split_first() {
                Some((next, rest)) => (Some(next), rest),
                None => (None, corrections),
            };
            let until = next.map_or(range.end, |next| next.sample.min(range.end));
            if memory_s.is_none() && k < until {
                k = self.glide(&mut state, k..until, &mut each);
                if k == range.end {
                    break;
                }
            }
            let model = self.model(k);
            let sight = model.reading(&state);
            each(k, sight);
            if let Some(memory_s) = memory_s {
                self.pull(&mut state, k, sight, memory_s);
            }
            if let Some(correction) = next.filter(|next| next.sample == k) {
                self.correct(&mut state, k, sight, correction);
                corrections = rest;
            }
            state.temperature = self.temperature(k);
            model.step(&mut state, self.command(k), self.data.is_open(k));
            k += 1;
        }
        state
    }

    /// Runs on the fast path for as long as the forces on the shaft stay constant; returns the sample at which the full
    /// step is needed.
    #[inline(always)]
    fn glide(
        &self,
        state: &mut State<S>,
        range: Range<usize>,
        each: &mut impl FnMut(usize, S),
    ) -> usize {
        let data = self.data;
        let Some(mut fast) = self.model(range.start).constant_force(state) else {
            return range.start;
        };
        let length = data.length_of[range.start];
        let mut motion = state.motion;
        // NaN equals no command.
        let mut command = f64::NAN;
        let mut k = range.start;
        while k < range.end && data.length_of[k] == length && !data.is_open(k) {
            if data.command[k] != command {
                command = data.command[k];
                fast.set_command(self.command(k));
            }
            let Some(next) = fast.step(&motion) else {
                break;
            };
            each(k, motion.angle);
            motion = next;
            k += 1;
        }
        if k > range.start {
            fast.store(state, motion);
        }
        k
    }

    /// Output injection at sample `k`, where the model's encoder angle is `sight` counts.
    #[inline(always)]
    fn pull(&self, state: &mut State<S>, k: usize, sight: S, memory_s: f64) {
        let data = self.data;
        let units = &data.units;
        let per_count = units.interval / (memory_s * units.counts_per_unit());
        let off = self.off(k, sight);
        // Both poles of the error at one over the memory.
        let share = (data.lengths[data.length_of[k] as usize] * units.interval / memory_s).min(0.5);
        let motion = &mut state.motion;
        motion.angle = motion.angle - S::from_f64(2.0 * share) * off;
        let pulled = motion.speed - S::from_f64(share) * off * S::from_f64(per_count);
        // A shaft that friction holds stays at rest.
        let zero = S::zero();
        let moves = motion.speed.less(zero).or(zero.less(motion.speed));
        motion.speed = S::select(moves, pulled, motion.speed);
    }

    /// Output injection at sample `k` with the gains of a correction.
    #[inline(always)]
    fn correct(&self, state: &mut State<S>, k: usize, sight: S, correction: &Correction) {
        let off = self.off(k, sight);
        let motion = &mut state.motion;
        motion.angle = motion.angle - S::from_f64(correction.angle) * off;
        motion.speed = motion.speed - S::from_f64(correction.speed) * off;
    }

    /// The model's encoder angle at sample `k`, `sight`, less the measured one, counts.
    #[inline(always)]
    fn off(&self, k: usize, sight: S) -> S {
        let data = self.data;
        sight - S::from_f64(data.counts[k]) - S::from_f64(data.centre(k) - data.counts[k])
    }

    #[inline(always)]
    fn series_parallel(
        &self,
        mut state: State<S>,
        range: Range<usize>,
        seen: &[MeasuredInterval<f64>],
        turns: &[f64],
        mut each: impl FnMut(usize, S),
    ) -> State<S> {
        for k in range {
            let model = self.model(k);
            each(k, model.reading_at(&state, S::from_f64(turns[k])));
            let seen = MeasuredInterval {
                turns: S::from_f64(seen[k].turns),
                speed: S::from_f64(seen[k].speed),
                speed_change: S::from_f64(seen[k].speed_change),
            };
            state.temperature = self.temperature(k);
            model.step_along(&mut state, self.command(k), self.data.is_open(k), &seen);
        }
        state
    }
}
