//! A law that is proposed.

use super::formula::formula;
use super::term::Term;
use shared::effects::Kind;

/// Square of the correlation from which on two give the same: they differ by 3 % of their size.
const SAME: f64 = 0.999;

/// A law, by what is known of it from the measured motion alone.
#[derive(Clone, Debug)]
pub struct Law {
    /// Its terms, with amplitudes: what each adds to the shaft, V referred to the winding.
    pub terms: Vec<Term>,
    /// Share that it explains of the variance of the volts that the model misses on the held-out recording, beyond what a
    /// perfect model would miss.
    pub explained: f64,
    /// Mean square of the volts that it leaves of that recording, V².
    pub left: f64,
    /// The effect of the catalogue that gives most alike along the fitted recording, with the square of their correlation.
    pub resembles: Option<(Kind, f64)>,
}

impl Law {
    /// Its text, as the program reads it.
    pub fn formula(&self, name: &str) -> String {
        formula(&self.terms, name)
    }

    /// Whether another law differs by its numbers alone.
    pub fn is_alike(&self, other: &Law) -> bool {
        let mut pairs = self.terms.iter().zip(&other.terms);
        self.terms.len() == other.terms.len() && pairs.all(|(own, other)| own.is_alike(other))
    }

    /// The same as a drop of the winding; `None` where any of its terms is none.
    pub fn as_drop(&self) -> Option<Law> {
        let terms = self.terms.iter().map(Term::as_drop);
        Some(Law {
            terms: terms.collect::<Option<_>>()?,
            ..self.clone()
        })
    }

    /// Whether an effect of the catalogue gives the same.
    pub fn is_in_the_catalogue(&self) -> bool {
        self.resembles.is_some_and(|(_, part)| part > SAME)
    }

    /// Numbers that it has.
    pub fn freedom(&self) -> usize {
        let of = |term: &Term| term.amplitudes.len() + term.shapes().len();
        self.terms.iter().map(of).sum()
    }
}
