//! Every term, and every pair of terms, of the library.

use super::blocks::Blocks;
use super::judge::Judge;
use super::term::{Place, Term};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Pairs that leave least of the fitted recording, of which more is asked.
const PAIRS: usize = 200;

/// The library's columns on both recordings, of those terms that are distinct from the linear motor.
pub struct Search<'a> {
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
    pub fn new(judge: &Judge<'_>, terms: &'a [Term]) -> Self {
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
            terms,
            distinct,
            columns,
            fitted: Blocks::new(&judge.fitted, &fitted),
            held: Blocks::new(&judge.held, &held),
        }
    }

    fn left(&self, terms: &[usize]) -> Option<f64> {
        let columns: Vec<usize> = terms
            .iter()
            .flat_map(|&t| self.columns[t].clone())
            .collect();
        let used = self.fitted.with(&columns);
        let by = self.fitted.coefficients(&used)?;
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
        let terms = (0..self.terms.len()).filter(|&t| self.distinct[t]);
        self.judged(terms.map(|t| vec![t]).collect())
    }

    /// The best pairs of those that may stand together, the best first.
    pub fn pairs(&self) -> Vec<Found> {
        let projected = Projected::new(&self.fitted);
        let n = self.terms.len();
        let mut pairs: Vec<(f64, usize, usize)> = (0..n)
            .into_par_iter()
            .filter(|&a| self.distinct[a])
            .flat_map_iter(|a| {
                let projected = &projected;
                let others = (a + 1..n).filter(|&b| self.distinct[b]);
                let others = others.filter(move |&b| together(&self.terms[a], &self.terms[b]));
                others.map(move |b| {
                    let columns = self.columns[a].iter().chain(&self.columns[b]);
                    (projected.gain(columns), a, b)
                })
            })
            .collect();
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        pairs.truncate(PAIRS);
        self.judged(pairs.into_iter().map(|(_, a, b)| vec![a, b]).collect())
    }
}

/// Whether two terms may stand in one law.
fn together(a: &Term, b: &Term) -> bool {
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

/// Sums of products of the terms' columns and the missing volts, with what the model's own columns take of them taken out.
struct Projected {
    products: DMatrix<f64>,
    target: DVector<f64>,
}

impl Projected {
    fn new(blocks: &Blocks) -> Self {
        let (own, size) = (blocks.own, blocks.all.nrows());
        let mut all = blocks.all.clone();
        // Gauss's elimination of the model's own columns, the largest left each time.
        let mut left: Vec<usize> = (0..own).collect();
        let whole: Vec<f64> = (0..size).map(|k| all[(k, k)].max(1e-300)).collect();
        while !left.is_empty() {
            let part = |k: usize| all[(k, k)] / whole[k];
            let best = (0..left.len()).max_by(|&a, &b| part(left[a]).total_cmp(&part(left[b])));
            let Some(pivot) = best.map(|at| left.swap_remove(at)) else {
                break;
            };
            if part(pivot) < 1e-8 {
                break;
            }
            let row: Vec<f64> = (0..size).map(|j| all[(pivot, j)]).collect();
            let over = 1.0 / row[pivot];
            for j in 0..size {
                let by = row[j] * over;
                for k in 0..size {
                    all[(k, j)] -= row[k] * by;
                }
            }
        }
        let terms = size - own - 1;
        // Unit columns; those that the model's own can make have no gain.
        let scale = |t: usize| {
            let k = own + 1 + t;
            if all[(k, k)] > 1e-6 * whole[k] {
                1.0 / all[(k, k)].sqrt()
            } else {
                0.0
            }
        };
        Projected {
            products: DMatrix::from_fn(terms, terms, |a, b| {
                let ridge = if a == b { 1e-6 } else { 0.0 };
                all[(own + 1 + a, own + 1 + b)] * scale(a) * scale(b) + ridge
            }),
            target: DVector::from_fn(terms, |a, _| all[(own + 1 + a, own)] * scale(a)),
        }
    }

    /// By how much some columns together lower the squares.
    fn gain<'c>(&self, columns: impl Iterator<Item = &'c usize>) -> f64 {
        let columns: Vec<usize> = columns.copied().collect();
        let n = columns.len();
        let matrix = DMatrix::from_fn(n, n, |a, b| self.products[(columns[a], columns[b])]);
        let right = DVector::from_fn(n, |a, _| self.target[columns[a]]);
        let solved = matrix.cholesky().map(|c| c.solve(&right));
        solved.map_or(0.0, |by| by.dot(&right))
    }
}
