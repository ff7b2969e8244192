//! Several candidates run along the data at a time, in the lanes of vector registers.
//!
//! Candidates of one group share every choice of the arithmetic: where a part of a step must be halved for one of
//! them it is halved for all. So a lane may be a little finer than the same candidate run alone; bitwise the same
//! where no such choice arises.

use super::candidate::{Candidate, Method};
use super::propagator::{Mode, Propagator};
use super::segment::Segment;
use super::single::Simulation;
use crate::data::Data;
use crate::lanes::{LANES, Lanes, Token, Work, work};
use shared::effects::Kind;
use shared::model::{Model, State};
use shared::scalar::Abreast;
use std::ops::Range;

/// Fewest candidates that are worth lanes of their own.
const FEWEST: usize = 3;
/// Most lengths of sample intervals, each of which wants a model of its own.
const MOST_LENGTHS: usize = 32;

/// How candidates are run.
pub struct Batch<'a> {
    /// The data.
    pub data: &'a Data,
    /// Discretisation and parts.
    pub method: Method,
    /// What moves them.
    pub mode: Mode<'a>,
}

impl Batch<'_> {
    /// By how much the errors of each of the `others` differ from those of `here`, all run over their `segments` and
    /// `centred`. `None` where a model cannot run.
    pub fn changes(
        &self,
        here: &Candidate,
        others: &[Candidate],
        segments: impl Fn(&Candidate) -> Vec<Segment>,
        centred: impl Fn(&Candidate, &mut [f64]),
    ) -> Vec<Option<Vec<f64>>> {
        let mut changes: Vec<Option<Vec<f64>>> = vec![None; others.len()];
        // Each group has a lane for what it is compared with.
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

    /// Model minus reading of at most [`LANES`] candidates at every sample, counts; abreast if that can be.
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

    /// The same changes, and the errors of `here` that they are changes of, only handed over, some samples at a time, and not
    /// centred. False, and nothing is called, where they cannot be run abreast.
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
        // Where each one's changes are: its group and its lane there.
        let mut seats = vec![(0, 0); others.len()];
        for (group, places) in places.iter().enumerate() {
            for (lane, &k) in places.iter().enumerate() {
                seats[k] = (group, 1 + lane);
            }
        }
        let mut sink = |range: Range<usize>, rows: &[Rows]| {
            let samples = range.len();
            let changes: Vec<&[f64]> = seats
                .iter()
                .map(|&(group, lane)| &rows[group][lane][..samples])
                .collect();
            each(&rows[0][0][..samples], &changes);
        };
        let run = Together {
            run: self,
            groups: &groups,
            less: Less::OfFirst,
            sink: &mut sink,
        };
        work(run).flatten().is_some()
    }

    /// Whether so many are worth running abreast.
    fn suits(&self, candidates: usize) -> bool {
        candidates >= FEWEST && self.data.lengths.len() <= MOST_LENGTHS
    }

    /// `None` where they cannot be run abreast, or had better not.
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
        let run = Together {
            run: self,
            groups: &[able.to_vec()],
            less: Less::Reading,
            sink: &mut sink,
        };
        work(run).flatten()?;
        Some(errors)
    }
}

/// Places of the candidates in groups of at most `most` that have the same effects.
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

/// Samples that are handed over at a time: one by one, eight places would be written to by turns.
const SOME: usize = 128;

/// What the encoders of the candidates in the lanes see at some samples, counts.
type Sights = [[f64; LANES]; SOME];

/// A row of differences for each candidate in the lanes, counts.
type Rows = [[f64; SOME]; LANES];

/// What is taken from what a lane sees.
#[derive(Clone, Copy, PartialEq)]
enum Less {
    /// The reading.
    Reading,
    /// The reading in the first lane; what the first lane sees in the others.
    OfFirst,
}

impl Less {
    /// Turns what the lanes saw at some samples into a row for each of them.
    #[inline(always)]
    fn rows<T: Token, const M: usize>(self, sights: &Sights, readings: &[f64], rows: &mut Rows) {
        let mut read = [0.0; SOME];
        read[..readings.len()].copy_from_slice(readings);
        // What is left over of the last square is of no sample.
        for square in 0..readings.len().div_ceil(LANES) {
            let at = square * LANES;
            let mut some = [[0.0; LANES]; LANES];
            some.copy_from_slice(&sights[at..at + LANES]);
            let mut seen = Lanes::<T, M>::transposed(some);
            let mut reading = [0.0; LANES];
            reading.copy_from_slice(&read[at..at + LANES]);
            let reading = Lanes::from(reading);
            let less = match self {
                Less::Reading => reading,
                Less::OfFirst => seen[0],
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

/// Candidates to be run abreast in groups; lanes that are left over repeat a group's first one.
struct Together<'t, 'a> {
    run: &'t Batch<'a>,
    groups: &'t [Vec<&'t (Simulation<'a>, Vec<Segment>)>],
    less: Less,
    /// Takes the rows of each group's lanes at a range of samples. All of the model is compiled in around it: once.
    sink: &'t mut dyn FnMut(Range<usize>, &[Rows]),
}

/// One of something for each lane of a group.
fn each<'s, 't, 'a, A>(
    group: &'s [&'t (Simulation<'a>, Vec<Segment>)],
    of: impl Fn(&'t (Simulation<'a>, Vec<Segment>)) -> A,
) -> [A; LANES] {
    std::array::from_fn(|lane| of(group.get(lane).unwrap_or(&group[0])))
}

impl Work for Together<'_, '_> {
    /// `None` where they are too different.
    type Output = Option<()>;

    #[inline(always)]
    fn run<T: Token, const M: usize>(self) -> Self::Output {
        let data = self.run.data;
        let models = |group: &Vec<_>| -> Option<Vec<Model<Lanes<T, M>>>> {
            (0..data.lengths.len())
                .map(|k| Model::abreast(each(group, |(simulation, _)| &simulation.models()[k])))
                .collect()
        };
        let models: Vec<_> = self.groups.iter().map(models).collect::<Option<_>>()?;
        let mut sights: Sights = [[0.0; LANES]; SOME];
        let mut rows: Vec<Rows> = vec![[[0.0; SOME]; LANES]; self.groups.len()];
        for (index, segment) in self.groups[0][0].1.iter().enumerate() {
            let begin = |group: &Vec<_>| {
                let states = each(
                    group,
                    |(simulation, segments): &(Simulation<'_>, Vec<Segment>)| {
                        simulation.begin(&segments[index])
                    },
                );
                State::<Lanes<T, M>>::abreast(states.each_ref())
            };
            let mut states: Vec<_> = self.groups.iter().map(begin).collect::<Option<_>>()?;
            for from in segment.range.clone().step_by(SOME) {
                let range = from..(from + SOME).min(segment.range.end);
                let readings = &data.counts[range.clone()];
                for ((state, models), rows) in states.iter_mut().zip(&models).zip(&mut rows) {
                    let propagator = Propagator { data, models };
                    *state = propagator.run(
                        self.run.mode,
                        *state,
                        range.clone(),
                        #[inline(always)]
                        |k, sight| sights[k - from] = sight.each(),
                    );
                    self.less.rows::<T, M>(&sights, readings, rows);
                }
                (self.sink)(range, &rows);
            }
        }
        Some(())
    }
}
