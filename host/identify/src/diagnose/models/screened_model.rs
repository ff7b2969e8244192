//! A model that was fitted roughly: it predicts what an effect can explain, and is where the full fit starts.

use super::errors::NOISE_COUNTS;
use super::fitted_model::FittedModel;
use servoid_engine::problem::{Candidate, Structure};
use shared::effects::Kind;

/// A screened model that leaves more than this factor of what another model leaves does not rival it.
const FAR: f64 = 4.0;

/// A model that was fitted roughly.
pub struct ScreenedModel {
    /// The unknowns, with the newest effect last.
    pub structure: Structure,
    /// Where the fit ended.
    pub x: Vec<f64>,
    /// RMS error that the series-parallel model leaves, counts; infinite where that does not follow the effect.
    pub series_parallel: f64,
    /// What a count of that error is worth in a free run: what the model without the effect leaves there, over what it
    /// leaves in series-parallel form, at most one.
    pub free_run_ratio: f64,
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
            free_run_ratio: 1.0,
            simulated: f64::INFINITY,
        }
    }

    /// Values of the effects' parameters.
    pub fn values(&self) -> Vec<f64> {
        let values = self.structure.values(&self.x);
        self.structure.effect_values(&values).to_vec()
    }

    /// The effect that was added.
    pub fn newest(&self) -> Option<Kind> {
        self.structure.effects.last().copied()
    }

    /// Whether a full fit may come near what `chosen` leaves, which may have been predicted as badly.
    pub fn may_rival(&self, chosen: &FittedModel) -> bool {
        let left = chosen.ran().fitted.max(chosen.predicted_rms_counts);
        self.predicted() < FAR * left.max(NOISE_COUNTS)
    }

    /// RMS error that a full fit is expected to reach, counts.
    pub fn predicted(&self) -> f64 {
        (self.series_parallel * self.free_run_ratio).min(self.simulated)
    }
}
