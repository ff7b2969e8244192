//! One candidate run along the data.

use super::candidate::{Candidate, Method};
use super::propagator::{Mode, Propagator};
use super::segment::Segment;
use crate::data::Data;
use crate::lanes::with_vectors;
use shared::error::ModelError;
use shared::model::{MAX_DELAY, Model, Plan, State};
use shared::motor::Machine;
use std::ops::Range;

/// Samples that are run at a time.
const CHUNK: usize = 1024;
/// Sample intervals before a start over which its winding current is computed.
const CURRENT_HISTORY: usize = 64;

/// The models of one candidate, one for each length of interval in the data.
pub struct Simulation<'a> {
    data: &'a Data,
    machine: Machine<f64>,
    models: Vec<Model<f64>>,
}

impl<'a> Simulation<'a> {
    /// Discretises the candidate for each length of interval in the data.
    ///
    /// # Errors
    /// Parameters from which no model can be made.
    pub fn new(data: &'a Data, candidate: &Candidate, method: Method) -> Result<Self, ModelError> {
        data.check_told(candidate.effects.iter().map(|(kind, _)| kind))?;
        Ok(Simulation {
            data,
            machine: candidate.machine,
            models: models(data, candidate, method, 1)?,
        })
    }

    /// Model minus reading, counts, one entry a sample; zero outside the segments.
    pub fn errors(&self, mode: Mode<'_>, segments: &[Segment]) -> Vec<f64> {
        let errors = self.errors_unless(mode, segments, |_| false);
        errors.unwrap_or_default()
    }

    /// As [`errors`](Self::errors); `None` once `give_up`, which is called with each chunk of errors in turn, says so.
    pub fn errors_unless(
        &self,
        mode: Mode<'_>,
        segments: &[Segment],
        mut give_up: impl FnMut(&[f64]) -> bool,
    ) -> Option<Vec<f64>> {
        let mut errors = vec![0.0; self.data.len()];
        for segment in segments {
            let mut state = self.begin(segment);
            for from in segment.range.clone().step_by(CHUNK) {
                let range = from..(from + CHUNK).min(segment.range.end);
                let some = &mut errors[range.clone()];
                state = self.errors_of(mode, state, range, some);
                if give_up(some) {
                    return None;
                }
            }
        }
        Some(errors)
    }

    /// Calls `each` with the errors, a chunk of samples at a time.
    pub fn stream(&self, mode: Mode<'_>, segments: &[Segment], mut each: impl FnMut(&[f64])) {
        let mut errors = [0.0; CHUNK];
        for segment in segments {
            let mut state = self.begin(segment);
            for from in segment.range.clone().step_by(CHUNK) {
                let range = from..(from + CHUNK).min(segment.range.end);
                let some = &mut errors[..range.len()];
                state = self.errors_of(mode, state, range, some);
                each(some);
            }
        }
    }

    /// Writes model minus reading over a range of samples from a state; returns the state after it.
    fn errors_of(
        &self,
        mode: Mode<'_>,
        state: State<f64>,
        range: Range<usize>,
        errors: &mut [f64],
    ) -> State<f64> {
        let state = self.go_on(mode, state, range.clone(), errors);
        for (error, reading) in errors.iter_mut().zip(&self.data.counts[range]) {
            *error -= reading;
        }
        state
    }

    /// Runs over a segment and writes the model's encoder angle at each of its samples, counts.
    pub fn run(&self, mode: Mode<'_>, segment: &Segment, sights: &mut [f64]) {
        let sights = &mut sights[segment.range.clone()];
        self.go_on(mode, self.begin(segment), segment.range.clone(), sights);
    }

    /// As [`run`](Self::run), from a state over a range of samples; returns the state after it.
    fn go_on(
        &self,
        mode: Mode<'_>,
        state: State<f64>,
        range: Range<usize>,
        sights: &mut [f64],
    ) -> State<f64> {
        let from = range.start;
        let propagator = Propagator {
            data: self.data,
            models: &self.models,
        };
        with_vectors(
            #[inline(always)]
            || propagator.run(mode, state, range, |k, sight| sights[k - from] = sight),
        )
    }

    /// State at the first sample of a segment.
    pub fn begin(&self, segment: &Segment) -> State<f64> {
        self.start(segment.range.start, segment.angle, segment.speed)
    }

    /// One model for each length of interval in the data.
    pub fn models(&self) -> &[Model<f64>] {
        &self.models
    }

    fn model(&self, k: usize) -> &Model<f64> {
        &self.models[self.data.length_of[k] as usize]
    }

    /// State at sample `k`, where the encoder angle is `angle` counts and the speed `speed` rad/s.
    pub(super) fn start(&self, k: usize, angle: f64, speed: f64) -> State<f64> {
        let mut state = State::at(angle, speed / self.data.units.speed);
        let Some(last) = self.data.len().checked_sub(1) else {
            return state;
        };
        let error = self.model(k.min(last)).reading(&state) - angle;
        state.motion.angle = angle - error;
        state.motion.current = self.current_before(k, speed);
        // Earlier commands may still be delayed.
        for k in self.before(k, MAX_DELAY) {
            let (command, open) = (self.data.command[k], self.data.is_open(k));
            self.model(k).recall(&mut state, command, open);
        }
        state
    }

    /// At most `samples` samples of its recording before `k`.
    fn before(&self, k: usize, samples: usize) -> Range<usize> {
        let first = self.data.recordings.holding(k).start;
        k.saturating_sub(samples).max(first)..k
    }

    /// Per-unit winding current at sample `k` from the commands before it, at a constant speed in rad/s: a motor that was
    /// driven starts with a current as it starts with a speed.
    fn current_before(&self, k: usize, speed: f64) -> f64 {
        let Machine { kb, electrical, .. } = self.machine;
        let volts = self.data.units.volts;
        let mut current = 0.0;
        for j in self.before(k, CURRENT_HISTORY) {
            if self.data.is_open(j) {
                current = 0.0;
                continue;
            }
            let steady = self.data.command[j] - kb * speed / volts;
            let interval = self.data.time_s[j + 1] - self.data.time_s[j];
            current +=
                (steady - current) * -libm::expm1(-interval / electrical.max(f64::MIN_POSITIVE));
        }
        current
    }

    /// Current at each sample as the voltage across the resistance, V, and speed, rad/s, from rest at `angle` counts;
    /// in further recordings from where they begin.
    pub fn currents_and_speeds(&self, angle: f64) -> Vec<(f64, f64)> {
        let mut state = self.start(0, angle, 0.0);
        (0..self.data.len())
            .map(|k| {
                if k > 0 && self.data.recordings.is_first(k) {
                    state = self.start(k, self.data.centre(k), 0.0);
                }
                let volts = state.motion.current * self.data.units.volts;
                let speed = state.motion.speed * self.data.units.speed;
                let model = self.model(k);
                state.temperature = self.data.temperature(k);
                let open = self.data.is_open(k);
                step(model, &mut state, self.data.command[k], open);
                (volts, speed)
            })
            .collect()
    }
}

/// A model for each length of interval in the data, which steps through so many equal parts of it.
pub(super) fn models(
    data: &Data,
    candidate: &Candidate,
    method: Method,
    parts: usize,
) -> Result<Vec<Model<f64>>, ModelError> {
    let model = |length: &f64| {
        let interval = data.units.interval * length / parts as f64;
        Model::new(&Plan {
            machine: candidate.machine,
            effects: candidate.effects,
            units: data.units.with_interval(interval),
            discretisation: method.discretisation,
            substeps: method.substeps,
        })
    };
    data.lengths.iter().map(model).collect()
}

/// One step of a model where no time counts: whoever calls [`Model::step`] has the whole model with all effects compiled into it, a quarter
/// of a megabyte.
#[inline(never)]
pub fn step(model: &Model<f64>, state: &mut State<f64>, command: f64, open: bool) {
    model.step(state, command, open);
}
