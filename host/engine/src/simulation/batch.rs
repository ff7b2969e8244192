//! Several candidates run along the data at once, in the lanes of vector registers.
//!
//! Candidates of one batch take every numerical decision together: where a substep must be halved for one of them, it is
//! halved for all. So a lane may be a little finer than the same candidate run alone; where no such decision arises, the
//! bits are the same.

use super::candidate::{Candidate, Method};
use super::propagator::{Mode, Propagator};
use super::segment::Segment;
use super::single::Simulation;
use crate::data::Data;
use crate::lanes::{LANES, Lanes, Token, Work, work};
use shared::effects::Kind;
use shared::model::{Model, State};
use shared::scalar::FromLanes;
use std::ops::Range;

/// Fewest candidates for which lanes are faster than single runs.
const FEWEST: usize = 3;
/// Most lengths of sample intervals: each needs a model of its own.
const MOST_LENGTHS: usize = 32;

/// Data and settings that the candidates share.
pub struct Batch<'a> {
    /// The data.
    pub data: &'a Data,
    /// Discretisation and substeps.
    pub method: Method,
    /// How they are propagated.
    pub mode: Mode<'a>,
}

impl Batch<'_> {
    /// Errors of each of the `others` less those of `here`, counts, one entry a sample. Each candidate runs over its
    /// `segments`; `centred` is applied to its errors first. `None` for a model that cannot run.
    pub fn changes(
        &self,
        here: &Candidate,
        others: &[Candidate],
        segments: impl Fn(&Candidate) -> Vec<Segment>,
        centred: impl Fn(&Candidate, &mut [f64]),
    ) -> Vec<Option<Vec<f64>>> {
        let mut changes: Vec<Option<Vec<f64>>> = vec![None; others.len()];
        // Each group needs a lane for `here`.
        for group in groups(others, LANES - 1) {
            let candidates: Vec<Candidate> = std::iter::once(*here)
                .chain(group.iter().map(|&k| others[k]))
                .collect();
            let mut errors = self.errors(&candidates, &segments);
            for (candidate, errors) in candidates.iter().zip(&mut errors) {
                if let Some(errors) = errors {
                    centred(candidate, errors);
                }
            }
            let mut errors = errors.into_iter();
            let Some(Some(own)) = errors.next() else {
                continue;
            };
            for (k, errors) in group.into_iter().zip(errors) {
                changes[k] = errors.map(|mut errors| {
                    for (error, own) in errors.iter_mut().zip(&own) {
                        *error -= own;
                    }
                    errors
                });
                changes[k] = changes[k]
                    .take()
                    .filter(|c| c.iter().all(|c| c.is_finite()));
            }
        }
        changes
    }

    /// Model minus reading of at most [`LANES`] candidates at every sample, counts; in lanes where possible.
    pub fn errors(
        &self,
        candidates: &[Candidate],
        segments: &impl Fn(&Candidate) -> Vec<Segment>,
    ) -> Vec<Option<Vec<f64>>> {
        let ready: Vec<Option<(Simulation<'_>, Vec<Segment>)>> = candidates
            .iter()
            .map(|candidate| {
                let simulation = Simulation::new(self.data, candidate, self.method).ok()?;
                Some((simulation, segments(candidate)))
            })
            .collect();
        let able: Vec<&(Simulation<'_>, Vec<Segment>)> = ready.iter().flatten().collect();
        if let Some(mut errors) = self.in_lanes(&able) {
            let mut errors = errors.drain(..);
            return ready
                .iter()
                .map(|ready| ready.as_ref().and_then(|_| errors.next()))
                .collect();
        }
        ready
            .iter()
            .map(|ready| {
                let (simulation, segments) = ready.as_ref()?;
                Some(simulation.errors(self.mode, segments))
            })
            .collect()
    }

    /// Calls `each` with the errors of `here` and the changes of all `others`, a range of samples at a time, not centred.
    /// Returns false without a call where they cannot run in lanes.
    pub fn stream(
        &self,
        here: &Candidate,
        others: &[Candidate],
        segments: impl Fn(&Candidate) -> Vec<Segment>,
        mut each: impl FnMut(&[f64], &[&[f64]]),
    ) -> bool {
        let ready = |candidate: &Candidate| {
            let simulation = Simulation::new(self.data, candidate, self.method).ok()?;
            Some((simulation, segments(candidate)))
        };
        let Some(own) = ready(here) else {
            return false;
        };
        let Some(ready) = others.iter().map(ready).collect::<Option<Vec<_>>>() else {
            return false;
        };
        let places = groups(others, LANES - 1);
        if !self.suits(1 + others.len().div_ceil(places.len().max(1))) {
            return false;
        }
        let groups: Vec<Vec<_>> = places
            .iter()
            .map(|places| std::iter::once(&own).chain(places.iter().map(|&k| &ready[k])))
            .map(Iterator::collect)
            .collect();
        // Group and lane of each candidate.
        let mut lane_of = vec![(0, 0); others.len()];
        for (group, places) in places.iter().enumerate() {
            for (lane, &k) in places.iter().enumerate() {
                lane_of[k] = (group, 1 + lane);
            }
        }
        let mut sink = |range: Range<usize>, rows: &[Rows]| {
            let samples = range.len();
            let changes: Vec<&[f64]> = lane_of
                .iter()
                .map(|&(group, lane)| &rows[group][lane][..samples])
                .collect();
            each(&rows[0][0][..samples], &changes);
        };
        let run = LaneRun {
            run: self,
            groups: &groups,
            subtract: Subtract::OfFirst,
            sink: &mut sink,
        };
        work(run).is_some()
    }

    /// Whether so many candidates are faster in lanes.
    fn suits(&self, candidates: usize) -> bool {
        candidates >= FEWEST && self.data.lengths.len() <= MOST_LENGTHS
    }

    /// `None` where they cannot run in lanes, or are faster alone.
    fn in_lanes(&self, able: &[&(Simulation<'_>, Vec<Segment>)]) -> Option<Vec<Vec<f64>>> {
        if !self.suits(able.len()) || able.len() > LANES {
            return None;
        }
        let data = self.data;
        let mut errors = vec![vec![0.0; data.len()]; able.len()];
        let mut sink = |range: Range<usize>, rows: &[Rows]| {
            for (errors, row) in errors.iter_mut().zip(&rows[0]) {
                errors[range.clone()].copy_from_slice(&row[..range.len()]);
            }
        };
        let run = LaneRun {
            run: self,
            groups: &[able.to_vec()],
            subtract: Subtract::Reading,
            sink: &mut sink,
        };
        work(run)?;
        Some(errors)
    }
}

/// Indices of the candidates in groups of at most `most` that have the same effects.
fn groups(candidates: &[Candidate], most: usize) -> Vec<Vec<usize>> {
    let mut groups: Vec<(Vec<Kind>, Vec<usize>)> = Vec::new();
    for (k, candidate) in candidates.iter().enumerate() {
        let kinds: Vec<Kind> = candidate.effects.present().map(|(kind, _)| kind).collect();
        match groups
            .iter_mut()
            .find(|(other, group)| *other == kinds && group.len() < most)
        {
            Some((_, group)) => group.push(k),
            None => groups.push((kinds, vec![k])),
        }
    }
    groups.into_iter().map(|(_, group)| group).collect()
}

/// Samples that are passed on at a time: one by one, the stores would alternate between eight rows.
const CHUNK: usize = 128;

/// Encoder angle of each lane at a chunk of samples, counts.
type Angles = [[f64; LANES]; CHUNK];

/// A row of differences for each lane, counts.
type Rows = [[f64; CHUNK]; LANES];

/// What is subtracted from a lane's encoder angle.
#[derive(Clone, Copy, PartialEq)]
enum Subtract {
    /// The reading.
    Reading,
    /// The reading in the first lane; the first lane's angle in the others.
    OfFirst,
}

impl Subtract {
    /// Transposes the angles into a row of differences for each lane.
    #[inline(always)]
    fn rows<T: Token, const M: usize>(self, angles: &Angles, readings: &[f64], rows: &mut Rows) {
        let mut read = [0.0; CHUNK];
        read[..readings.len()].copy_from_slice(readings);
        // The last tile may reach beyond the last sample.
        for tile in 0..readings.len().div_ceil(LANES) {
            let at = tile * LANES;
            let mut some = [[0.0; LANES]; LANES];
            some.copy_from_slice(&angles[at..at + LANES]);
            let mut seen = Lanes::<T, M>::transposed(some);
            let mut reading = [0.0; LANES];
            reading.copy_from_slice(&read[at..at + LANES]);
            let reading = Lanes::from(reading);
            let less = match self {
                Subtract::Reading => reading,
                Subtract::OfFirst => seen[0],
            };
            seen[0] = seen[0] - reading;
            for seen in &mut seen[1..] {
                *seen = *seen - less;
            }
            for (row, seen) in rows.iter_mut().zip(seen) {
                row[at..at + LANES].copy_from_slice(&seen.each());
            }
        }
    }
}

/// Groups of candidates to be run in lanes; unused lanes repeat a group's first candidate.
struct LaneRun<'t, 'a> {
    run: &'t Batch<'a>,
    groups: &'t [Vec<&'t (Simulation<'a>, Vec<Segment>)>],
    subtract: Subtract,
    /// Receives the rows of each group's lanes at a range of samples. Behind a pointer, so that the model is compiled once.
    sink: &'t mut dyn FnMut(Range<usize>, &[Rows]),
}

/// One value for each lane of a group.
fn each<'s, 't, 'a, A>(
    group: &'s [&'t (Simulation<'a>, Vec<Segment>)],
    of: impl Fn(&'t (Simulation<'a>, Vec<Segment>)) -> A,
) -> [A; LANES] {
    std::array::from_fn(|lane| of(group.get(lane).unwrap_or(&group[0])))
}

impl Work for LaneRun<'_, '_> {
    /// `None` where the candidates' models are too different to share lanes.
    type Output = Option<()>;

    #[inline(always)]
    fn run<T: Token, const M: usize>(self) -> Self::Output {
        let data = self.run.data;
        let models = |group: &Vec<_>| -> Option<Vec<Model<Lanes<T, M>>>> {
            (0..data.lengths.len())
                .map(|k| Model::from_lanes(each(group, |(simulation, _)| &simulation.models()[k])))
                .collect()
        };
        let models: Vec<_> = self.groups.iter().map(models).collect::<Option<_>>()?;
        let mut angles: Angles = [[0.0; LANES]; CHUNK];
        let mut rows: Vec<Rows> = vec![[[0.0; CHUNK]; LANES]; self.groups.len()];
        for (index, segment) in self.groups[0][0].1.iter().enumerate() {
            let begin = |group: &Vec<_>| {
                let states = each(
                    group,
                    |(simulation, segments): &(Simulation<'_>, Vec<Segment>)| {
                        simulation.begin(&segments[index])
                    },
                );
                State::<Lanes<T, M>>::from_lanes(states.each_ref())
            };
            let mut states: Vec<_> = self.groups.iter().map(begin).collect::<Option<_>>()?;
            for from in segment.range.clone().step_by(CHUNK) {
                let range = from..(from + CHUNK).min(segment.range.end);
                let readings = &data.counts[range.clone()];
                for ((state, models), rows) in states.iter_mut().zip(&models).zip(&mut rows) {
                    let propagator = Propagator { data, models };
                    *state = propagator.run(
                        self.run.mode,
                        *state,
                        range.clone(),
                        #[inline(always)]
                        |k, angle| angles[k - from] = angle.each(),
                    );
                    self.subtract.rows::<T, M>(&angles, readings, rows);
                }
                (self.sink)(range, &rows);
            }
        }
        Some(())
    }
}
