//! How far what a model's effects give is from a known truth: for proofs on a bench that knows what it hides.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::given::Given;
use servoid_engine::problem::{Candidate, Data};

/// RMS of the difference of a candidate's effects from the truth along a recording where the shaft turns, as a part of the RMS of a
/// hidden law. The truth is that law and what the effects of the model `beside` give. What a linear motor could give is taken out of
/// all: a friction that grows with the speed is as well a back-EMF.
/// `None` where the motor turned too little, or the law is a linear motor's.
pub fn departure(
    data: &Data,
    candidate: &Candidate,
    law: &Given,
    beside: &Candidate,
) -> Option<f64> {
    // A friction leaves out where the shaft may rest, so that the rows are the whole model's.
    let equation = Equation::new(data, candidate)?;
    let given = |model| Given::by(data, model, &equation.motion).seen(&equation);
    let mut law = law.seen(&equation);
    let rest = given(beside).into_iter().zip(given(candidate));
    let mut off: Vec<f64> = law
        .iter()
        .zip(rest)
        .map(|(law, (beside, found))| law + beside - found)
        .collect();
    let basis = orthonormal(equation.linear());
    take_out(&basis, &mut law);
    take_out(&basis, &mut off);
    let part = (dot(&off, &off) / dot(&law, &law)).sqrt();
    part.is_finite().then_some(part)
}
