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

    /// The same changes, and the errors of `here` that they are changes of, only handed over, some samples at a time, and not
    /// centred. False, and nothing is called, where they cannot be run abreast.
    pub fn stream(
        &self,
        here: &Candidate,
        others: &[Candidate],
        legs: impl Fn(&Candidate) -> Vec<Leg>,
        mut each: impl FnMut(&[f64], &[&[f64]]),
    ) -> bool {
        let ready = |candidate: &Candidate| {
            let simulation = Simulation::new(self.data, candidate, self.method).ok()?;
            Some((simulation, legs(candidate)))
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
        let mut errors = vec![[0.0; SOME]; 1 + others.len()];
        let mut sink = |range: Range<usize>, sights: &[Sights]| {
            for (places, sights) in places.iter().zip(sights) {
                for (lane, &k) in places.iter().enumerate() {
                    for (change, sights) in errors[1 + k].iter_mut().zip(sights) {
                        *change = sights[1 + lane] - sights[0];
                    }
                }
            }
            let readings = &self.data.counts[range.clone()];
            for ((error, sights), reading) in errors[0].iter_mut().zip(&sights[0]).zip(readings) {
                *error = sights[0] - reading;
            }
            let some: Vec<&[f64]> = errors.iter().map(|e| &e[..range.len()]).collect();
            each(some[0], &some[1..]);
        };
        let run = Together {
            run: self,
            groups: &groups,
            sink: &mut sink,
        };
        work(run).flatten().is_some()
    }

    /// Whether so many are worth running abreast.
    fn suits(&self, candidates: usize) -> bool {
        candidates >= FEWEST && self.data.lengths.len() <= MOST_LENGTHS
    }

    /// `None` where they cannot be run abreast, or had better not.
    fn abreast(&self, able: &[&(Simulation<'_>, Vec<Leg>)]) -> Option<Vec<Vec<f64>>> {
        if !self.suits(able.len()) || able.len() > LANES {
            return None;
        }
        let data = self.data;
        let mut errors = vec![vec![0.0; data.len()]; able.len()];
        let mut sink = |range: Range<usize>, sights: &[Sights]| {
            hand_over(
                &sights[0],
                &data.counts[range.clone()],
                range.start,
                &mut errors,
            );
        };
        let run = Together {
            run: self,
            groups: &[able.to_vec()],
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
const SOME: usize = 64;

/// What the encoders of the candidates in the lanes see at some samples, counts.
type Sights = [[f64; LANES]; SOME];

/// Writes what the lanes saw, less the readings, to each candidate's errors from a place on.
fn hand_over(sights: &Sights, readings: &[f64], at: usize, errors: &mut [Vec<f64>]) {
    for (lane, errors) in errors.iter_mut().enumerate() {
        let errors = &mut errors[at..at + readings.len()];
        for ((error, sights), reading) in errors.iter_mut().zip(sights).zip(readings) {
            *error = sights[lane] - reading;
        }
    }
}

/// Candidates to be run abreast in groups; lanes that are left over repeat a group's first one.
struct Together<'t, 'a> {
    run: &'t Run<'a>,
    groups: &'t [Vec<&'t (Simulation<'a>, Vec<Leg>)>],
    /// Takes what the lanes of each group see at a range of samples. All of the model is compiled in around it: once.
    sink: &'t mut dyn FnMut(Range<usize>, &[Sights]),
}

/// One of something for each lane of a group.
fn each<'s, 't, 'a, A>(
    group: &'s [&'t (Simulation<'a>, Vec<Leg>)],
    of: impl Fn(&'t (Simulation<'a>, Vec<Leg>)) -> A,
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
        let mut sights = vec![[[0.0; LANES]; SOME]; self.groups.len()];
        for (index, leg) in self.groups[0][0].1.iter().enumerate() {
            let begin = |group: &Vec<_>| {
                let states = each(group, |(simulation, legs): &(Simulation<'_>, Vec<Leg>)| {
                    simulation.begin(&legs[index])
                });
                State::<Lanes<T, M>>::abreast(states.each_ref())
            };
            let mut states: Vec<_> = self.groups.iter().map(begin).collect::<Option<_>>()?;
            for from in leg.range.clone().step_by(SOME) {
                let range = from..(from + SOME).min(leg.range.end);
                for ((state, models), sights) in states.iter_mut().zip(&models).zip(&mut sights) {
                    let course = Course { data, models };
                    *state = course.run(
                        self.run.manner,
                        *state,
                        range.clone(),
                        #[inline(always)]
                        |k, sight| sights[k - from] = sight.each(),
                    );
                }
                (self.sink)(range, &sights);
            }
        }
        Some(())
    }
}
