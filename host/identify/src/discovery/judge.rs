//! How good a law is: what it leaves of blocks that it was not fitted on, and of the held-out recording.

use super::blocks::Blocks;
use super::equation::Equation;
use super::refined::refined;
use super::term::Term;
use crate::fit::correlation_sum;
use servoid_engine::problem::{Candidate, Data};
use statrs::distribution::{ContinuousCDF, FisherSnedecor};

/// Chance at which a law is believed, over all that were tried.
const CHANCE: f64 = 1e-3;
/// Least part that a law explains of what is missing beyond a perfect model's.
const LEAST_EXPLAINED: f64 = 0.3;
/// A law that explains less than this part of what a perfect model would show says nothing.
const NOTICED: f64 = 0.1;

/// Both recordings.
pub struct Judge<'a> {
    /// The fitted one.
    pub fitted: Equation<'a>,
    /// The one that no coefficient comes from.
    pub held: Equation<'a>,
    /// Mean squares that a perfect model would leave of the fitted one, V².
    pub fitted_noise: f64,
    /// The same of the other.
    pub held_noise: f64,
}

/// What the model with some terms leaves, mean squares in V².
#[derive(Clone, Debug)]
pub struct Trial {
    /// The terms, with their amplitudes by the fitted recording.
    pub terms: Vec<Term>,
    /// On the fitted recording.
    pub fitted: f64,
    /// On its blocks, each by the others.
    pub crossed: f64,
    /// On the held-out recording.
    pub held: f64,
    /// Rows that count as independent, of both recordings.
    pub independent: f64,
}

impl Trial {
    /// Numbers that were fitted.
    pub fn freedom(&self) -> f64 {
        let of = |term: &Term| term.amplitudes.len() + term.shapes().len();
        self.terms.iter().map(of).sum::<usize>() as f64
    }

    /// Less is better: the squares that are predicted, and a price of each number (Schwarz).
    pub fn score(&self, independent: f64) -> f64 {
        let left = 0.5 * (self.crossed + self.held);
        independent * libm::log(left.max(1e-300)) + libm::log(independent) * self.freedom()
    }
}

impl<'a> Judge<'a> {
    /// Of two recordings, with the motor that there is beside a law that is known already. `None` where either shows too little motion.
    pub fn new(
        data: &'a Data,
        held_out: &'a Data,
        candidate: &Candidate,
        law: &[Term],
    ) -> Option<Self> {
        let candidate = refined(data, candidate, law);
        let fitted = Equation::new(data, &candidate)?;
        let held = Equation::new(held_out, &candidate)?;
        Some(Judge {
            fitted_noise: fitted.perfect(&candidate).unwrap_or(0.0),
            held_noise: held.perfect(&candidate).unwrap_or(0.0),
            fitted,
            held,
        })
    }

    /// The model with these terms.
    pub fn try_terms(&self, terms: &[Term]) -> Option<Trial> {
        let columns = |equation: &Equation<'_>| -> Vec<Vec<f64>> {
            terms
                .iter()
                .flat_map(|term| equation.columns(term))
                .collect()
        };
        let (fitted_columns, held_columns) = (columns(&self.fitted), columns(&self.held));
        if !self.fitted.are_distinct(&fitted_columns) {
            return None;
        }
        let references: Vec<&[f64]> = fitted_columns.iter().map(Vec::as_slice).collect();
        let fitted = Blocks::new(&self.fitted, &references);
        let references: Vec<&[f64]> = held_columns.iter().map(Vec::as_slice).collect();
        let held = Blocks::new(&self.held, &references);
        let all: Vec<usize> = (0..references.len()).collect();
        let used = fitted.with(&all);
        let by = fitted.coefficients(&used)?;
        if !self.fitted.leaves_a_motor(by.as_slice()) {
            return None;
        }
        let n = fitted.rows as f64;
        let mut amplitudes = by.iter().skip(fitted.own).copied();
        let amplified = terms.iter().map(|term| Term {
            amplitudes: amplitudes.by_ref().take(term.amplitudes.len()).collect(),
            ..term.clone()
        });
        let terms = amplified.collect();
        let mut rest = self.held.missing.clone();
        let columns = self.held.own.iter().chain(&held_columns);
        for (column, by) in columns.zip(by.iter()) {
            for (left, x) in rest.iter_mut().zip(column) {
                *left -= by * x;
            }
        }
        let part = independent_part(&rest);
        Some(Trial {
            terms,
            fitted: fitted.left(&used, &by) / n,
            crossed: fitted.left_out(&used)? / n,
            held: held.left(&used, &by) / held.rows as f64,
            independent: part * (fitted.rows + held.rows) as f64,
        })
    }

    /// Share of what is missing on the held-out recording, beyond what a perfect model would leave, that `trial` explains.
    pub fn explained(&self, base: &Trial, trial: &Trial) -> f64 {
        let noise = self.held_noise.min(trial.held);
        let beyond = (base.held - noise).max(f64::MIN_POSITIVE);
        ((base.held - trial.held) / beyond).clamp(0.0, 1.0)
    }

    /// Whether `trial` says more than `base` does, of which it is one of `tried`.
    pub fn believes(&self, base: &Trial, trial: &Trial, tried: usize) -> bool {
        let gains = trial.crossed < base.crossed && trial.held < base.held;
        let noticed = base.held - trial.held > NOTICED * self.held_noise
            && base.fitted - trial.fitted > NOTICED * self.fitted_noise;
        gains
            && noticed
            && chance(base, trial) * (tried as f64) < CHANCE
            && self.explained(base, trial) > LEAST_EXPLAINED
    }
}

/// Chance that numbers without meaning would lower the squares as much (Fisher's F of as many samples as are independent).
fn chance(base: &Trial, trial: &Trial) -> f64 {
    let more = (trial.freedom() - base.freedom()).max(1.0);
    let others = (0.5 * trial.independent - trial.freedom()).max(2.0);
    let before = base
        .crossed
        .min(base.held * trial.crossed / trial.held.max(1e-300));
    let ratio = (before - trial.crossed) / more / (trial.crossed / others).max(f64::MIN_POSITIVE);
    let law = FisherSnedecor::new(more, others).ok();
    law.filter(|_| ratio.is_finite())
        .map_or(1.0, |law| law.sf(ratio.max(0.0)))
}

/// Part of the rows that are independent.
pub fn independent_part(left: &[f64]) -> f64 {
    let square: f64 = left.iter().map(|x| x * x).sum();
    if square <= 0.0 {
        return 1.0;
    }
    let at = |lag: usize| {
        let pairs = left.iter().zip(&left[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / square
    };
    1.0 / (1.0 + 2.0 * correlation_sum(left.len() / 2, at))
}
