//! A model that was fitted roughly: it predicts what an effect can explain, and is where the full fit starts.

use servoid_engine::problem::{Candidate, Structure};

/// A model that was fitted roughly.
pub struct ScreenedModel {
    /// The unknowns, with the newest effect last.
    pub structure: Structure,
    /// Where the fit ended.
    pub x: Vec<f64>,
    /// RMS error that the series-parallel model leaves, counts; infinite where that does not follow the effect.
    pub series_parallel: f64,
    /// RMS error of a free run from there, counts; infinite where it is so far above the series-parallel one that the run
    /// has lost its way.
    pub simulated: f64,
}

impl ScreenedModel {
    /// A model that is not fitted roughly, but stands where a full fit may start: at the machine and the start
    /// of `there`, with these parameters of its effects.
    pub fn standing(structure: Structure, there: &Candidate, parameters: &[f64]) -> Self {
        let values = structure.values_of(&there.machine, parameters, there.start_speed);
        let x = structure.coordinates(&values);
        ScreenedModel::at(structure, x)
    }

    /// The same at a point of the unknowns' unit cube.
    pub fn at(structure: Structure, x: Vec<f64>) -> Self {
        ScreenedModel {
            structure,
            x,
            series_parallel: f64::INFINITY,
            simulated: f64::INFINITY,
        }
    }

    /// Values of the effects' parameters.
    pub fn values(&self) -> Vec<f64> {
        let values = self.structure.values(&self.x);
        self.structure.effect_values(&values).to_vec()
    }

    /// RMS error that a full fit is expected to reach, counts.
    pub fn predicted(&self) -> f64 {
        self.series_parallel.min(self.simulated)
    }
}
