//! Every term, and every pair of terms, of the library.

use super::blocks::Blocks;
use super::equation::Equation;
use super::judge::Judge;
use super::term::{Place, Term};
use nalgebra::DVector;
use rayon::prelude::*;

/// Pairs that leave least of the fitted recording, of which more is asked.
const PAIRS: usize = 200;

/// The library's columns on both recordings, of those terms that are distinct from the model's own parameters.
pub struct Search<'a> {
    equation: &'a Equation<'a>,
    terms: &'a [Term],
    /// Whether a term's columns are.
    distinct: Vec<bool>,
    /// Columns of each term.
    columns: Vec<Vec<usize>>,
    fitted: Blocks,
    held: Blocks,
}

/// Terms by their place in the library, and the squares that they leave of what they do not see.
#[derive(Clone, Debug)]
pub struct Found {
    /// Places in the library.
    pub terms: Vec<usize>,
    /// Mean squares left of blocks and of the held-out recording.
    pub left: f64,
}

impl<'a> Search<'a> {
    /// Computes all columns.
    pub fn new(judge: &'a Judge<'_>, terms: &'a [Term]) -> Self {
        let (fitted, held): (Vec<_>, Vec<_>) = terms
            .par_iter()
            .map(|term| (judge.fitted.columns(term), judge.held.columns(term)))
            .unzip();
        let distinct = fitted.par_iter();
        let distinct = distinct.map(|columns: &Vec<Vec<f64>>| judge.fitted.are_distinct(columns));
        let distinct = distinct.collect();
        let mut next = 0;
        let columns = terms.iter().map(|term| {
            let from = next;
            next += term.amplitudes.len();
            (from..next).collect()
        });
        let columns = columns.collect();
        let fitted: Vec<&[f64]> = fitted.iter().flatten().map(Vec::as_slice).collect();
        let held: Vec<&[f64]> = held.iter().flatten().map(Vec::as_slice).collect();
        Search {
            equation: &judge.fitted,
            terms,
            distinct,
            columns,
            fitted: Blocks::new(&judge.fitted, &fitted),
            held: Blocks::new(&judge.held, &held),
        }
    }

    /// The columns of terms beside the model's own, with their coefficients; `None` where they leave no motor.
    fn regression(&self, terms: &[usize]) -> Option<(Vec<usize>, DVector<f64>)> {
        let columns: Vec<usize> = terms
            .iter()
            .flat_map(|&t| self.columns[t].clone())
            .collect();
        let used = self.fitted.with(&columns);
        let by = self.fitted.coefficients(&used)?;
        let leaves_a_motor = self.equation.leaves_a_motor(by.as_slice());
        leaves_a_motor.then_some((used, by))
    }

    fn left(&self, terms: &[usize]) -> Option<f64> {
        let (used, by) = self.regression(terms)?;
        let crossed = self.fitted.left_out(&used)? / self.fitted.rows as f64;
        let held = self.held.left(&used, &by) / self.held.rows as f64;
        let left = crossed + held;
        left.is_finite().then_some(left)
    }

    fn judged(&self, sets: Vec<Vec<usize>>) -> Vec<Found> {
        let judged = sets.into_par_iter().filter_map(|terms| {
            let left = self.left(&terms)?;
            Some(Found { terms, left })
        });
        let mut found: Vec<Found> = judged.collect();
        found.sort_by(|a, b| a.left.total_cmp(&b.left));
        found
    }

    /// Every term, the best first.
    pub fn single(&self) -> Vec<Found> {
        let new = |&t: &usize| self.distinct[t] && !self.terms[t].is_in_the_catalogue();
        let terms = (0..self.terms.len()).filter(new);
        self.judged(terms.map(|t| vec![t]).collect())
    }

    /// The best pairs of those that may stand together, the best first.
    pub fn pairs(&self) -> Vec<Found> {
        let n = self.terms.len();
        let mut pairs: Vec<(f64, usize, usize)> = (0..n)
            .into_par_iter()
            .filter(|&a| self.distinct[a])
            .flat_map_iter(|a| {
                let others = (a + 1..n).filter(|&b| self.distinct[b]);
                let others = others.filter(move |&b| together(&self.terms[a], &self.terms[b]));
                others.filter_map(move |b| {
                    let (used, by) = self.regression(&[a, b])?;
                    Some((self.fitted.left(&used, &by), a, b))
                })
            })
            .collect();
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        pairs.truncate(PAIRS);
        self.judged(pairs.into_iter().map(|(_, a, b)| vec![a, b]).collect())
    }
}

/// Whether two terms may stand in one law. What the catalogue has stands beside a law in the model, but for the constant part of a
/// friction that depends on the angle, which is never negative.
fn together(a: &Term, b: &Term) -> bool {
    // Pairs with each place of the revolution would be as many as all others.
    if a.bump.is_some() || b.bump.is_some() {
        return false;
    }
    let friction = a.is_dry() && b.is_dry() && (a.order.is_some() || b.order.is_some());
    if (a.is_in_the_catalogue() || b.is_in_the_catalogue()) && !friction {
        return false;
    }
    let states = match (a.memory, b.memory) {
        (Some(a), Some(b)) => a.distance == b.distance,
        _ => true,
    };
    // A law has one state.
    let remembers = |term: &Term| term.memory.is_some() || term.load.remembers();
    let states =
        states && !(a.load.remembers() && remembers(b) || b.load.remembers() && remembers(a));
    let both = |place| a.place == place && b.place == place;
    states && (both(Place::Torque) || both(Place::Voltage))
}
