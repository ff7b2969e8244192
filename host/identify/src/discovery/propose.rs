//! From library to laws.

use super::judge::{Judge, Trial};
use super::law::Law;
use super::library::library;
use super::likeness::Likeness;
use super::polish::Polish;
use super::search::{Found, Search};
use super::term::Term;
use rayon::prelude::*;
use servoid_engine::problem::{Candidate, Data};

/// Laws of one term whose numbers are polished, and of two.
const SINGLE: usize = 20;
const PAIRS: usize = 10;
/// Laws of one term and of two that are proposed.
const LAWS_OF_ONE: usize = 2;
const LAWS_OF_TWO: usize = 1;
/// Square of a term's correlation with an effect of the catalogue over which that stands beside the other term, and no law of both.
const KNOWN: f64 = 0.98;
/// Part of what one term leaves unexplained that two must explain.
const SECOND_TERM: f64 = 0.3;

/// Proposes laws for what `candidate` lacks: the best of one term, then the best of two if the second is worth its numbers; none where
/// nothing simple explains it.
///
/// A law is believed where it predicts blocks of `data` that it was not fitted on, and `held_out`, which nothing is fitted on. Along
/// the measured motion a second term soon takes up what speeds from counts are in error by, so that simulation has the last word
/// on it.
pub fn propose(data: &Data, held_out: &Data, candidate: &Candidate) -> Vec<Law> {
    let laws = beside(data, held_out, candidate, &[]);
    let best = laws
        .iter()
        .max_by(|a, b| a.explained.total_cmp(&b.explained));
    match best {
        // The current along the motion follows from the motor, which is another one beside the law.
        Some(law) if law.terms.iter().any(Term::sees_the_current) => {
            let again = beside(data, held_out, candidate, &law.terms);
            if again.is_empty() { laws } else { again }
        }
        _ => laws,
    }
}

/// The laws, with the motor that there is beside one that is known already.
fn beside(data: &Data, held_out: &Data, candidate: &Candidate, law: &[Term]) -> Vec<Law> {
    let Some(judge) = Judge::new(data, held_out, candidate, law) else {
        return Vec::new();
    };
    let Some(base) = judge.try_terms(&[]) else {
        return Vec::new();
    };
    let terms = library(data);
    let search = Search::new(&judge, &terms);
    let polish = Polish::new(&judge.fitted);
    let polished = |found: &[Found]| -> Vec<Trial> {
        let polished = found.par_iter().filter_map(|found| {
            let start: Vec<Term> = found.terms.iter().map(|&t| terms[t].clone()).collect();
            judge.try_terms(&polish.polished(&start))
        });
        polished.collect()
    };
    let single = polished(&families(search.single(), &terms, SINGLE));
    let mut believed: Vec<Trial> = single
        .into_iter()
        .filter(|trial| judge.believes(&base, trial, terms.len()))
        .collect();
    sort(&mut believed);
    let pairs = polished(&families(search.pairs(), &terms, PAIRS));
    let tried = terms.len() * terms.len() / 2;
    let pairs = pairs.into_iter().filter(|pair| {
        judge.believes(&base, pair, tried)
            && believed
                .first()
                .is_none_or(|one| explains_more(&judge, one, pair))
    });
    let mut pairs: Vec<Trial> = pairs.collect();
    sort(&mut pairs);
    if believed.is_empty() && pairs.is_empty() {
        return Vec::new();
    }
    let likeness = Likeness::new(&judge.fitted, candidate);
    let known = |term: &Term| {
        let alike = || likeness.of(std::slice::from_ref(term));
        !term.is_in_the_catalogue() && alike().is_some_and(|(_, part)| part > KNOWN)
    };
    let single = believed.into_iter().take(LAWS_OF_ONE);
    let pairs = pairs.into_iter();
    let pairs = pairs.filter(|pair| !pair.terms.iter().any(known));
    let laws = single.chain(pairs.take(LAWS_OF_TWO));
    laws.map(|trial| Law {
        explained: judge.explained(&base, &trial),
        left: trial.held,
        resembles: likeness.of(&trial.terms),
        terms: trial.terms,
    })
    .collect()
}

/// Whether a second term is worth its numbers.
fn explains_more(judge: &Judge<'_>, one: &Trial, two: &Trial) -> bool {
    let part = |before: f64, after: f64, noise: f64| {
        let noise = noise.min(after);
        (before - after) / (before - noise).max(f64::MIN_POSITIVE)
    };
    part(one.held, two.held, judge.held_noise) > SECOND_TERM
        && part(one.crossed, two.crossed, judge.fitted_noise) > SECOND_TERM
}

/// Best first.
fn sort(trials: &mut [Trial]) {
    let independent = trials.iter().map(|trial| trial.independent);
    let independent = independent.fold(10.0, f64::max);
    trials.sort_by(|a, b| a.score(independent).total_cmp(&b.score(independent)));
}

/// The best of each family that differs by its numbers alone.
fn families(found: Vec<Found>, terms: &[Term], most: usize) -> Vec<Found> {
    let mut kept: Vec<Found> = Vec::new();
    for one in found {
        let alike = |other: &Found| {
            let pairs = one.terms.iter().zip(&other.terms);
            pairs.clone().all(|(&a, &b)| terms[a].is_alike(&terms[b]))
        };
        if kept.len() < most && !kept.iter().any(alike) {
            kept.push(one);
        }
    }
    kept
}
