//! Which effect of the catalogue a law is most like.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::term::Term;
use servoid_engine::problem::Candidate;
use shared::effects::Kind;

/// Least likeness that is worth a word.
const LEAST: f64 = 0.1;

/// The effect whose volts along the motion go most with a law's, and the square of their correlation, both beside what the linear
/// motor could give. Effects have typical parameters.
pub fn likeness(
    equation: &Equation<'_>,
    candidate: &Candidate,
    terms: &[Term],
) -> Option<(Kind, f64)> {
    let own = orthonormal(&equation.own);
    let mut law = vec![0.0; equation.rows.len()];
    for term in terms {
        for (column, by) in equation.columns(term).iter().zip(&term.amplitudes) {
            law.iter_mut()
                .zip(column)
                .for_each(|(sum, x)| *sum += by * x);
        }
    }
    take_out(&own, &mut law);
    let linear = candidate.keeping(|_| false);
    let without = equation.missing_by(&linear)?;
    let alike = Kind::ALL.iter().filter_map(|&kind| {
        let mut with = linear;
        with.effects.push(kind, &equation.typical(kind)).ok()?;
        let left = equation.missing_by(&with)?;
        let mut given: Vec<f64> = without.iter().zip(&left).map(|(a, b)| a - b).collect();
        take_out(&own, &mut given);
        let (both, size) = (dot(&given, &law), dot(&given, &given) * dot(&law, &law));
        let part = both * both / size;
        (part > LEAST && part.is_finite()).then_some((kind, part))
    });
    alike.max_by(|a, b| a.1.total_cmp(&b.1))
}
