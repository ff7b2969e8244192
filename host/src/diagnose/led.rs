//! A fit of the led model: cheap, smooth, and for that a start only.

use super::motion::Motion;
use crate::problem::simulate::{Candidate, Method, Simulation};
use crate::problem::{Data, Horizon, Structure};
use crate::solve::Objective;
use shared::effects::Kind;

/// The led model's error as a function of the unknowns.
pub struct Led<'a> {
    /// The recording.
    pub data: &'a Data,
    /// Its motion.
    pub motion: &'a Motion,
    /// How far the model is led before it is set back to the measured state.
    pub horizon: &'a Horizon,
    /// The unknowns.
    pub structure: Structure,
    /// How the model is run.
    pub method: Method,
}

/// Whether a led model follows this effect: not where motor and load part ways, where commands are
/// late, or where bristles bend, or the current rises,
/// within a sample. Those cost little to simulate in full, or are not helped by being led.
pub fn follows(kind: Kind) -> bool {
    !matches!(
        kind,
        Kind::Compliance | Kind::Backlash | Kind::Delay | Kind::Lugre | Kind::LSat
    )
}

impl Led<'_> {
    /// Model minus measurement in counts, with the best start angle. `None` where the model cannot run.
    pub fn errors(&self, candidate: &Candidate) -> Option<Vec<f64>> {
        // One part a sample: what is held at the measured mean needs no more.
        let method = Method {
            substeps: 1,
            ..self.method
        };
        let simulation = Simulation::new(self.data, candidate, method).ok()?;
        let (seen, turns) = (&self.motion.seen, &self.motion.turns);
        if let Horizon::Windows(windows) = self.horizon {
            let mut errors = Vec::with_capacity(self.data.len());
            for window in windows {
                errors.extend(simulation.led(window.range.clone(), seen, turns, window.speed));
            }
            let centre = self.data.centre(0) - self.data.counts[0];
            for error in &mut errors {
                *error -= centre;
            }
            return errors.iter().all(|e| e.is_finite()).then_some(errors);
        }
        let mut errors = simulation.led(0..self.data.len(), seen, turns, candidate.start_speed);
        let mean = errors.iter().sum::<f64>() / errors.len().max(1) as f64;
        for error in &mut errors {
            *error -= mean;
        }
        mean.is_finite().then_some(errors)
    }
}

impl Objective for Led<'_> {
    fn dim(&self) -> usize {
        self.structure.dim()
    }

    fn cost(&self, x: &[f64]) -> f64 {
        self.residuals_and_cost(x)
            .map_or(f64::INFINITY, |(_, cost)| cost)
    }

    fn residuals_and_cost(&self, x: &[f64]) -> Option<(Vec<f64>, f64)> {
        let errors = self.errors(&self.structure.candidate(&self.structure.values(x)))?;
        let cost = errors.iter().map(|e| e * e).sum();
        Some((errors, cost))
    }
}
