//! Several candidates run along the data at a time, in the lanes of vector registers.
//!
//! Candidates of one group share every choice of the arithmetic: where a part of a step must be halved for one of
//! them it is halved for all. So a lane may be a little finer than the same candidate run alone; bitwise the same
//! where no such choice arises.

use super::course::{Course, Leg, Manner};
use super::data::Data;
use super::simulate::{Candidate, Method, Simulation};
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
pub struct Run<'a> {
    /// The data.
    pub data: &'a Data,
    /// Discretisation and parts.
    pub method: Method,
    /// What moves them.
    pub manner: Manner<'a>,
}

impl Run<'_> {
    /// By how much the errors of each of the `others` differ from those of `here`, all run over their `legs` and
    /// `centred`. `None` where a model cannot run.
    pub fn changes(
        &self,
        here: &Candidate,
        others: &[Candidate],
        legs: impl Fn(&Candidate) -> Vec<Leg>,
        centred: impl Fn(&Candidate, &mut [f64]),
    ) -> Vec<Option<Vec<f64>>> {
        let mut changes: Vec<Option<Vec<f64>>> = vec![None; others.len()];
        // Each group has a lane for what it is compared with.
        for group in groups(others, LANES - 1) {
            let candidates: Vec<Candidate> = std::iter::once(*here)
                .chain(group.iter().map(|&k| others[k]))
                .collect();
            let mut errors = self.errors(&candidates, &legs);
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
        legs: &impl Fn(&Candidate) -> Vec<Leg>,
    ) -> Vec<Option<Vec<f64>>> {
        let ready: Vec<Option<(Simulation<'_>, Vec<Leg>)>> = candidates
            .iter()
            .map(|candidate| {
                let simulation = Simulation::new(self.data, candidate, self.method).ok()?;
                Some((simulation, legs(candidate)))
            })
            .collect();
        let able: Vec<&(Simulation<'_>, Vec<Leg>)> = ready.iter().flatten().collect();
        if let Some(mut errors) = self.abreast(&able) {
            let mut errors = errors.drain(..);
            return ready
                .iter()
                .map(|ready| ready.as_ref().and_then(|_| errors.next()))
                .collect();
        }
        ready
            .iter()
            .map(|ready| {
                let (simulation, legs) = ready.as_ref()?;
                Some(simulation.errors(self.manner, legs))
            })
            .collect()
    }

    /// `None` where they cannot be run abreast, or had better not.
    fn abreast(&self, able: &[&(Simulation<'_>, Vec<Leg>)]) -> Option<Vec<Vec<f64>>> {
        let fits = (FEWEST..=LANES).contains(&able.len());
        if !fits || self.data.lengths.len() > MOST_LENGTHS {
            return None;
        }
        work(Together { run: self, able }).flatten()
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

/// Candidates to be run abreast; lanes that are left over repeat the first one.
struct Together<'t, 'a> {
    run: &'t Run<'a>,
    able: &'t [&'t (Simulation<'a>, Vec<Leg>)],
}

impl Together<'_, '_> {
    /// One of something for each lane.
    fn each<'s, A>(&'s self, of: impl Fn(&'s (Simulation<'_>, Vec<Leg>)) -> A) -> [A; LANES] {
        std::array::from_fn(|lane| of(self.able.get(lane).unwrap_or(&self.able[0])))
    }
}

/// Samples that are handed over at a time.
const SOME: usize = 64;

/// Writes what the lanes saw at the samples of a `range`, less the readings, to each candidate's errors.
fn hand_over(
    sights: &[[f64; LANES]],
    readings: &[f64],
    range: Range<usize>,
    errors: &mut [Vec<f64>],
) {
    for (lane, errors) in errors.iter_mut().enumerate() {
        let readings = &readings[range.clone()];
        for ((error, sights), reading) in errors[range.clone()].iter_mut().zip(sights).zip(readings)
        {
            *error = sights[lane] - reading;
        }
    }
}

impl Work for Together<'_, '_> {
    type Output = Option<Vec<Vec<f64>>>;

    #[inline(always)]
    fn run<T: Token, const M: usize>(self) -> Self::Output {
        let data = self.run.data;
        let models: Vec<Model<Lanes<T, M>>> = (0..data.lengths.len())
            .map(|length| Model::abreast(self.each(|(simulation, _)| &simulation.models()[length])))
            .collect::<Option<_>>()?;
        let course = Course {
            data,
            models: &models,
        };
        let mut errors = vec![vec![0.0; data.len()]; self.able.len()];
        // Samples are handed over some at a time: one by one, eight places would be written to by turns.
        let mut some = [[0.0; LANES]; SOME];
        for (index, leg) in self.able[0].1.iter().enumerate() {
            let states = self.each(|(simulation, legs)| simulation.begin(&legs[index]));
            let state = State::<Lanes<T, M>>::abreast(states.each_ref())?;
            let (first, end) = (leg.range.start, leg.range.end);
            course.run(
                self.run.manner,
                state,
                leg.range.clone(),
                #[inline(always)]
                |k, sight| {
                    let place = (k - first) % SOME;
                    some[place] = sight.each();
                    if place + 1 == SOME || k + 1 == end {
                        hand_over(&some, &data.counts, k - place..k + 1, &mut errors);
                    }
                },
            );
        }
        Some(errors)
    }
}
