//! The numbers that shape a law, at which the fitted recording is left least of.

use super::blocks::Blocks;
use super::equation::Equation;
use super::term::{Term, Varied};
use crate::golden_section::golden_section;

/// Farthest that a number moves, as a factor.
const REACH: f64 = 2.5;
/// Farthest that an angle moves, rad.
const TURN: f64 = 0.4;
/// Points of a scan before the golden section.
const SCAN: usize = 7;
/// Steps of the golden section.
const STEPS: usize = 9;
/// Rounds over all numbers.
const ROUNDS: usize = 2;

/// The regression beside the model's own columns.
pub struct Polish<'e> {
    equation: &'e Equation<'e>,
}

impl<'e> Polish<'e> {
    /// Of a recording.
    pub fn new(equation: &'e Equation<'e>) -> Self {
        Polish { equation }
    }

    /// Squares that terms leave; infinite where they are no law.
    fn left(&self, terms: &[Term]) -> f64 {
        let columns = terms.iter().flat_map(|term| self.equation.columns(term));
        let columns: Vec<Vec<f64>> = columns.collect();
        if !self.equation.are_distinct(&columns) {
            return f64::INFINITY;
        }
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        let blocks = Blocks::new(self.equation, &columns);
        let used = blocks.with(&(0..columns.len()).collect::<Vec<_>>());
        let by = blocks.coefficients(&used);
        let by = by.filter(|by| self.equation.leaves_a_motor(by.as_slice()));
        by.map_or(f64::INFINITY, |by| blocks.left(&used, &by))
    }

    /// The terms with better numbers.
    pub fn polished(&self, terms: &[Term]) -> Vec<Term> {
        let mut terms = terms.to_vec();
        for round in 0..ROUNDS {
            let part = if round == 0 { 1.0 } else { 0.5 };
            for index in 0..terms.len() {
                for slot in 0..terms[index].shapes().len() {
                    terms = self.along(terms, index, slot, part);
                }
            }
        }
        terms
    }

    /// The terms with a better value of one number, within a part of its reach: of the logarithm of what is varied by factors.
    fn along(&self, terms: Vec<Term>, index: usize, slot: usize, part: f64) -> Vec<Term> {
        type Scale = fn(f64) -> f64;
        let shapes = terms[index].shapes();
        let shape = shapes[slot];
        let (scaled, unscaled, reach): (Scale, Scale, f64) = match shape.varied {
            Varied::Factor => (libm::log, libm::exp, part * libm::log(REACH)),
            Varied::Angle => (|x| x, |x| x, part * TURN),
        };
        let at = |x: f64| -> Vec<Term> {
            let mut moved = terms.clone();
            let mut values: Vec<f64> = shapes.iter().map(|shape| shape.value).collect();
            values[slot] = unscaled(x);
            moved[index] = moved[index].shaped(&values);
            // One state is one: its distance is common.
            if let Some(own) = moved[index].memory {
                for memory in moved.iter_mut().filter_map(|term| term.memory.as_mut()) {
                    memory.distance = own.distance;
                }
            }
            moved
        };
        let here = scaled(shape.value);
        let low = (here - reach).max(scaled(shape.low));
        let high = (here + reach).min(scaled(shape.high));
        if high <= low {
            return terms;
        }
        let cost = |x: f64| self.left(&at(x));
        let step = (high - low) / (SCAN - 1) as f64;
        let scanned = (0..SCAN).map(|k| low + step * k as f64).chain([here]);
        let best = scanned
            .map(|x| (cost(x), x))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, middle)) = best else {
            return terms;
        };
        let best = golden_section(
            cost,
            (middle - step).max(low)..(middle + step).min(high),
            STEPS,
        );
        at(best)
    }
}
