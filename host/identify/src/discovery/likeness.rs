//! Which effect of the catalogue a law is most like.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::term::Term;
use servoid_engine::problem::Candidate;
use shared::effects::Kind;

/// Least likeness that is worth a word.
const LEAST: f64 = 0.1;

/// What each effect of the catalogue gives along a motion, beside what the linear motor could give. Effects have typical parameters.
pub struct Likeness<'e> {
    equation: &'e Equation<'e>,
    own: Vec<Vec<f64>>,
    given: Vec<(Kind, Vec<f64>)>,
}

impl<'e> Likeness<'e> {
    /// Along the motion of an equation.
    pub fn new(equation: &'e Equation<'e>, candidate: &Candidate) -> Self {
        let own = orthonormal(&equation.own);
        let linear = candidate.keeping(|_| false);
        let given = equation.missing_by(&linear).map(|without| {
            let each = Kind::ALL.iter().filter_map(|&kind| {
                let mut with = linear;
                with.effects.push(kind, &equation.typical(kind)).ok()?;
                let left = equation.missing_by(&with)?;
                let mut given: Vec<f64> = without.iter().zip(&left).map(|(a, b)| a - b).collect();
                take_out(&own, &mut given);
                Some((kind, given))
            });
            each.collect()
        });
        Likeness {
            equation,
            own,
            given: given.unwrap_or_default(),
        }
    }

    /// The effect whose volts go most with a law's, and the square of their correlation.
    pub fn of(&self, terms: &[Term]) -> Option<(Kind, f64)> {
        let mut law = vec![0.0; self.equation.rows.len()];
        for term in terms {
            for (column, by) in self.equation.columns(term).iter().zip(&term.amplitudes) {
                law.iter_mut()
                    .zip(column)
                    .for_each(|(sum, x)| *sum += by * x);
            }
        }
        take_out(&self.own, &mut law);
        let alike = self.given.iter().filter_map(|(kind, given)| {
            let (both, size) = (dot(given, &law), dot(given, given) * dot(&law, &law));
            let part = both * both / size;
            (part > LEAST && part.is_finite()).then_some((*kind, part))
        });
        alike.max_by(|a, b| a.1.total_cmp(&b.1))
    }
}
