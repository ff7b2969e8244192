//! A model with one effect more, fitted roughly: led along the measured motion where that is possible. It
//! foresees what the effect can explain, and is where the full fit starts.

use super::descent::{Settings, descend};
use super::led::{Led, follows};
use super::refit::Refit;
use super::starts::starts;
use super::workshop::Workshop;
use crate::fit::base_for;
use crate::problem::cost::{errors, rms_counts};
use crate::problem::{StartAngle, Structure};
use shared::cost::Cost;
use shared::effects::Kind;

const SKETCH: Settings = Settings {
    evaluations: 60,
    tolerance: 1e-3,
    stride: 4,
    enough: f64::INFINITY,
    damping: 1e-4,
    secant: true,
};

/// A model that was fitted roughly.
pub struct Sketch {
    /// The unknowns, with the newest effect last.
    pub structure: Structure,
    /// Where the fit ended.
    pub x: Vec<f64>,
    /// RMS error that the led model leaves, counts; infinite where the effect cannot be led.
    pub led: f64,
    /// RMS error of a free run from there, counts.
    pub simulated: f64,
}

impl Sketch {
    /// The effect that was added.
    pub fn newest(&self) -> Option<Kind> {
        self.structure.effects.last().copied()
    }

    /// RMS error that a full fit is expected to reach, counts.
    pub fn foreseen(&self) -> f64 {
        self.led.min(self.simulated)
    }
}

impl Workshop<'_> {
    /// The model `parent` with `kind` added.
    pub fn sketch(&self, parent: &Refit, kind: Kind) -> Option<Sketch> {
        let mut effects = parent.effects.clone();
        effects.push(kind);
        let structure = Structure::around(
            self.data,
            base_for(self.data, &effects),
            &effects,
            &parent.candidate.machine,
            parent.structure.start_speed,
        );
        let mut best: Option<Sketch> = None;
        for start in starts(self, parent, kind) {
            let mut parameters = parent.parameters.clone();
            parameters.extend(start);
            let x = structure.coordinates(&structure.values_of(
                &parent.candidate.machine,
                &parameters,
                parent.candidate.start_speed,
            ));
            let Some(sketch) = self.sketch_from(&structure, x) else {
                continue;
            };
            if best
                .as_ref()
                .is_none_or(|b| sketch.foreseen() < b.foreseen())
            {
                best = Some(sketch);
            }
        }
        best
    }

    fn sketch_from(&self, structure: &Structure, x: Vec<f64>) -> Option<Sketch> {
        let samples = self.data.len() as f64;
        if !structure.effects.iter().all(|&kind| follows(kind)) {
            let found = descend(&self.problem(structure, self.method), &x, SKETCH)?;
            return Some(Sketch {
                structure: structure.clone(),
                x: found.x,
                led: f64::INFINITY,
                simulated: (found.squares / samples).sqrt(),
            });
        }
        let led = Led {
            data: self.data,
            motion: &self.motion,
            horizon: &self.fitted_horizon,
            structure: structure.clone(),
            method: self.method,
        };
        let found = descend(&led, &x, SKETCH)?;
        let candidate = structure.candidate(&structure.values(&found.x));
        let simulated = errors(
            self.data,
            &candidate,
            self.method,
            &self.fitted_horizon,
            StartAngle::Free,
            Cost::Squared,
        )
        .map_or(f64::INFINITY, |errors| rms_counts(self.data, &errors));
        Some(Sketch {
            structure: structure.clone(),
            x: found.x,
            led: (found.squares / samples).sqrt(),
            simulated,
        })
    }
}
