//! How far what a model's effects give is from a known truth: for proofs on a bench that knows what it hides.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::given::Given;
use servoid_engine::problem::{Candidate, Data};

/// RMS of the difference of a candidate's effects from the truth along a recording where the shaft turns, as a part of the truth's own
/// RMS. What a linear motor could give of either is taken out: a friction that grows with the speed is as well a back-EMF.
/// `None` where the motor turned too little, or the truth is a linear motor's.
pub fn departure(data: &Data, candidate: &Candidate, known: &Given) -> Option<f64> {
    // A friction leaves out where the shaft may rest, so that the rows are the whole model's.
    let equation = Equation::new(data, candidate)?;
    let mut truth = known.seen(&equation);
    let mut found = Given::by(data, candidate, &equation.motion).seen(&equation);
    let basis = orthonormal(equation.linear());
    take_out(&basis, &mut truth);
    take_out(&basis, &mut found);
    let off: Vec<f64> = truth.iter().zip(&found).map(|(a, b)| a - b).collect();
    let part = (dot(&off, &off) / dot(&truth, &truth)).sqrt();
    part.is_finite().then_some(part)
}
