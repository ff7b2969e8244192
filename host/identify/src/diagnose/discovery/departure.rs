//! How far what a model's effects give is from a known truth: for proofs on a bench that knows what it hides.

use super::equation::{Equation, dot, orthonormal, take_out};
use super::term::Place;
use servoid_engine::problem::{Candidate, Data};

/// What a hidden law gives in the interval that begins at each sample, V referred to the winding.
pub struct Known {
    /// As a torque on the shaft.
    pub torque: Vec<f64>,
    /// As a voltage at the winding.
    pub voltage: Vec<f64>,
}

impl Known {
    /// What it gives at the rows of an equation.
    pub(super) fn seen(&self, equation: &Equation<'_>) -> Vec<f64> {
        let torque = equation.seen(&self.torque, Place::Torque);
        let voltage = equation.seen(&self.voltage, Place::Voltage);
        torque.iter().zip(&voltage).map(|(a, b)| a + b).collect()
    }
}

/// RMS of the difference of a candidate's effects from the truth along a recording where the shaft turns, as a part of the truth's own
/// RMS. What a linear motor could give of either is taken out: a friction that grows with the speed is as well a back-EMF.
/// `None` where the motor turned too little, or the truth is a linear motor's.
pub fn departure(data: &Data, candidate: &Candidate, known: &Known) -> Option<f64> {
    // A friction leaves out where the shaft may rest, so that the rows are the whole model's.
    let equation = Equation::new(data, candidate)?;
    let mut truth = known.seen(&equation);
    let without = equation.missing_by(&candidate.keeping(|_| false))?;
    let pairs = without.iter().zip(&equation.missing);
    let mut found: Vec<f64> = pairs.map(|(without, with)| without - with).collect();
    let basis = orthonormal(equation.linear());
    take_out(&basis, &mut truth);
    take_out(&basis, &mut found);
    let off: Vec<f64> = truth.iter().zip(&found).map(|(a, b)| a - b).collect();
    let part = (dot(&off, &off) / dot(&truth, &truth)).sqrt();
    part.is_finite().then_some(part)
}
