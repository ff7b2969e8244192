//! Models run along the data: one candidate's, or those of several abreast.

use crate::data::Data;
use shared::model::{Model, Seen, State};
use shared::scalar::{Mask, Scalar};
use std::ops::Range;

/// What recordings are run with: the number of one candidate, or of several abreast.
pub trait Number: Scalar<Coefficient = Self, Angle = Self> {}

impl<S: Scalar<Coefficient = S, Angle = S>> Number for S {}

/// What moves a model along.
#[derive(Clone, Copy)]
pub enum Mode<'a> {
    /// It runs freely.
    Free,
    /// It is pulled towards the readings like an observer that forgets an error within so many seconds: what
    /// happens once, such as a slipped detent, does not stay for ever.
    Observer(f64),
    /// Its effects are led along a measured motion.
    SeriesParallel {
        /// One entry an interval.
        seen: &'a [Seen<f64>],
        /// Position within the revolution, one entry a sample.
        turns: &'a [f64],
    },
}

/// The data, and a model for each length of interval in it.
pub struct Propagator<'a, S: Scalar> {
    /// The data.
    pub data: &'a Data,
    /// The models.
    pub models: &'a [Model<S>],
}

impl<S: Number> Propagator<'_, S> {
    /// Runs from a state over the samples of `range`; calls `each` with the sample and what the model's encoder
    /// sees there, counts. Gives the state behind them.
    #[inline(always)]
    pub fn run(
        &self,
        mode: Mode<'_>,
        state: State<S>,
        range: Range<usize>,
        each: impl FnMut(usize, S),
    ) -> State<S> {
        let memory_s = match mode {
            Mode::Free => None,
            Mode::Observer(memory_s) => Some(memory_s),
            Mode::SeriesParallel { seen, turns } => {
                return self.series_parallel(state, range, seen, turns, each);
            }
        };
        self.parallel(state, range, memory_s, each)
    }

    #[inline(always)]
    fn model(&self, k: usize) -> &Model<S> {
        &self.models[self.data.length_of[k] as usize]
    }

    #[inline(always)]
    fn command(&self, k: usize) -> S {
        S::from_f64(self.data.command[k])
    }

    /// Runs freely, or pulled towards the readings with a memory.
    // One loop for both, since all of the model is compiled into it.
    #[inline(always)]
    fn parallel(
        &self,
        mut state: State<S>,
        range: Range<usize>,
        memory_s: Option<f64>,
        mut each: impl FnMut(usize, S),
    ) -> State<S> {
        let mut k = range.start;
        while k < range.end {
            if memory_s.is_none() {
                k = self.glide(&mut state, k..range.end, &mut each);
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
            model.step(&mut state, self.command(k), self.data.is_open(k));
            k += 1;
        }
        state
    }

    /// Runs as long as the shaft only slides on; gives the sample at which more must be looked at.
    #[inline(always)]
    fn glide(
        &self,
        state: &mut State<S>,
        range: Range<usize>,
        each: &mut impl FnMut(usize, S),
    ) -> usize {
        let data = self.data;
        let Some(mut glide) = self.model(range.start).glide(state) else {
            return range.start;
        };
        let length = data.length_of[range.start];
        let mut motion = state.motion;
        // No command equals it.
        let mut command = f64::NAN;
        let mut k = range.start;
        while k < range.end && data.length_of[k] == length && !data.is_open(k) {
            if data.command[k] != command {
                command = data.command[k];
                glide.set(self.command(k));
            }
            let Some(next) = glide.step(&motion) else {
                break;
            };
            each(k, motion.angle);
            motion = next;
            k += 1;
        }
        if k > range.start {
            glide.leave(state, motion);
        }
        k
    }

    /// Pulls a model that sees `sight` at sample `k` towards the reading.
    #[inline(always)]
    fn pull(&self, state: &mut State<S>, k: usize, sight: S, memory_s: f64) {
        let data = self.data;
        let units = &data.units;
        let per_count = units.interval / (memory_s * units.counts_per_unit());
        let off =
            sight - S::from_f64(data.counts[k]) - S::from_f64(data.centre(k) - data.counts[k]);
        // Both poles of the error at 1/memory.
        let share = (data.lengths[data.length_of[k] as usize] * units.interval / memory_s).min(0.5);
        let motion = &mut state.motion;
        motion.angle = motion.angle - S::from_f64(2.0 * share) * off;
        let pulled = motion.speed - S::from_f64(share) * off * S::from_f64(per_count);
        // A shaft that friction holds stays at rest.
        let zero = S::zero();
        let moves = motion.speed.less(zero).or(zero.less(motion.speed));
        motion.speed = S::select(moves, pulled, motion.speed);
    }

    #[inline(always)]
    fn series_parallel(
        &self,
        mut state: State<S>,
        range: Range<usize>,
        seen: &[Seen<f64>],
        turns: &[f64],
        mut each: impl FnMut(usize, S),
    ) -> State<S> {
        for k in range {
            let model = self.model(k);
            each(k, model.reading_at(&state, S::from_f64(turns[k])));
            let seen = Seen {
                turns: S::from_f64(seen[k].turns),
                speed: S::from_f64(seen[k].speed),
                speed_change: S::from_f64(seen[k].speed_change),
            };
            model.lead(&mut state, self.command(k), self.data.is_open(k), &seen);
        }
        state
    }
}
