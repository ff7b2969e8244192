//! One model with one set of effects, fitted to the recording and judged on the other.

use super::NOISE_COUNTS;
use super::descent::{Descent, Settings, descend};
use super::led::{Led, follows};
use super::motion::Motion;
use super::starts::starts;
use crate::error::Error;
use crate::fit::{self, Options, base_for, scores, validate};
use crate::problem::cost::rms_counts;
use crate::problem::simulate::Method;
use crate::problem::{Candidate, Data, FitProblem, Horizon, StartAngle, Structure};
use shared::cost::Cost;
use shared::effects::Kind;

/// Of the led fit, of a simulated fit, and of the last one.
const SKETCH: Settings = Settings {
    evaluations: 60,
    tolerance: 1e-3,
    stride: 4,
    enough: f64::INFINITY,
};
const FULL: Settings = Settings {
    evaluations: 80,
    tolerance: 1e-3,
    stride: 2,
    enough: 0.0,
};

/// A fitted model with its errors.
#[derive(Clone, Debug)]
pub struct Refit {
    /// The effects, the newest last.
    pub effects: Vec<Kind>,
    /// The model.
    pub candidate: Candidate,
    /// The unknowns.
    pub structure: Structure,
    /// Values of the effects' parameters, SI.
    pub parameters: Vec<f64>,
    /// RMS error on the fitted recording, open loop, counts.
    pub rms_counts: f64,
    /// RMS error on the held-out recording, counts.
    pub validate_rms_counts: f64,
    /// RMS error that the led model foresaw, counts; that of the fit where there was none.
    pub foreseen_rms_counts: f64,
    /// Evaluations spent, led ones apart.
    pub evaluations: usize,
}

impl Refit {
    /// Whether both errors are the encoder's own.
    pub fn at_floor(&self) -> bool {
        self.rms_counts < NOISE_COUNTS && self.validate_rms_counts < NOISE_COUNTS
    }

    /// ln(fitted · held-out error), neither counted below the noise: what candidates are ranked by.
    pub fn score(&self) -> f64 {
        let floored = |rms: f64| rms.max(shared::encoder::FLOOR_RMS_COUNTS);
        (floored(self.rms_counts) * floored(self.validate_rms_counts)).ln()
    }
}

/// The recordings and how models are run: what every refit needs.
pub struct Workshop<'a> {
    /// Fitted.
    pub data: &'a Data,
    /// Never fitted.
    pub held_out: &'a Data,
    /// The fitted recording's motion.
    pub motion: Motion,
    /// How models are run.
    pub method: Method,
}

/// A model that was fitted while led.
pub struct Sketch {
    /// The unknowns.
    pub structure: Structure,
    /// Where the led fit ended.
    pub x: Vec<f64>,
    /// RMS error that the led model leaves, counts; infinite where the effect cannot be led.
    pub led: f64,
    /// RMS error of a simulation from there, counts.
    pub simulated: f64,
}

impl<'a> Workshop<'a> {
    /// Prepares.
    pub fn new(data: &'a Data, held_out: &'a Data, options: &Options) -> Self {
        Workshop {
            data,
            held_out,
            motion: Motion::measured(data),
            method: Method {
                substeps: 1,
                ..options.method
            },
        }
    }

    /// The linear motor.
    ///
    /// # Errors
    /// [`Error::Failed`] where no motor fits even roughly.
    pub fn base(&self, options: &Options) -> Result<Refit, Error> {
        let options = Options {
            effects: Vec::new(),
            ..options.clone()
        };
        let problem = fit::problem(self.data, &options)?;
        let start = problem.start.clone().unwrap_or_default();
        let found = descend(&problem, &start, FULL)
            .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", self.data.source)))?;
        let foreseen = f64::NAN;
        self.conclude(problem.structure, &found, foreseen)
    }

    /// The model `current` with `kind` added, fitted while led along the measured motion.
    pub fn sketches(&self, current: &Refit, kind: Kind) -> Option<Sketch> {
        let mut effects = current.effects.clone();
        effects.push(kind);
        let structure = Structure::around(
            self.data,
            base_for(self.data, &effects),
            &effects,
            &current.candidate.machine,
            current.structure.start_speed,
        );
        let mut best: Option<Sketch> = None;
        for start in starts(self.data, &current.candidate, kind) {
            let mut parameters = current.parameters.clone();
            parameters.extend(start);
            let x = structure.coordinates(&structure.values_of(
                &current.candidate.machine,
                &parameters,
                current.candidate.start_speed,
            ));
            let Some(sketch) = self.sketch(&structure, x) else {
                continue;
            };
            let quality = |s: &Sketch| s.led.min(s.simulated);
            if best.as_ref().is_none_or(|b| quality(&sketch) < quality(b)) {
                best = Some(sketch);
            }
        }
        best
    }

    fn sketch(&self, structure: &Structure, x: Vec<f64>) -> Option<Sketch> {
        let samples = self.data.len() as f64;
        if !structure.effects.iter().all(|&kind| follows(kind)) {
            let found = descend(&self.problem(structure), &x, SKETCH)?;
            let rms = (found.squares / samples).sqrt();
            return Some(Sketch {
                structure: structure.clone(),
                x: found.x,
                led: f64::INFINITY,
                simulated: rms,
            });
        }
        let led = Led {
            data: self.data,
            motion: &self.motion,
            structure: structure.clone(),
            method: self.method,
        };
        let found = descend(&led, &x, SKETCH)?;
        let values = structure.values(&found.x);
        let simulated = scores::whole(self.data, &structure.candidate(&values), self.method)
            .map_or(f64::INFINITY, |errors| rms_counts(self.data, &errors));
        Some(Sketch {
            structure: structure.clone(),
            x: found.x,
            led: (found.squares / samples).sqrt(),
            simulated,
        })
    }

    /// Fits a sketched model by full simulation.
    ///
    /// # Errors
    /// [`Error::Failed`] where the model cannot run from there.
    pub fn refit(&self, sketch: &Sketch) -> Result<Refit, Error> {
        let problem = self.problem(&sketch.structure);
        let settings = Settings {
            enough: NOISE_COUNTS * NOISE_COUNTS * self.data.len() as f64,
            ..FULL
        };
        let found = descend(&problem, &sketch.x, settings)
            .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", self.data.source)))?;
        self.conclude(problem.structure, &found, sketch.led)
    }

    fn problem(&self, structure: &Structure) -> FitProblem<'a> {
        FitProblem {
            data: self.data,
            structure: structure.clone(),
            cost: Cost::Squared,
            weight: 1.0,
            horizon: Horizon::Whole,
            start_angle: StartAngle::Free,
            method: self.method,
            start: None,
        }
    }

    fn conclude(
        &self,
        structure: Structure,
        found: &Descent,
        foreseen: f64,
    ) -> Result<Refit, Error> {
        let values = structure.values(&found.x);
        let candidate = structure.candidate(&values);
        let whole = scores::whole(self.data, &candidate, self.method)?;
        let rms = rms_counts(self.data, &whole);
        Ok(Refit {
            effects: structure.effects.clone(),
            parameters: structure.effect_values(&values).to_vec(),
            candidate,
            structure,
            rms_counts: rms,
            validate_rms_counts: validate(self.held_out, &candidate, self.method)?,
            foreseen_rms_counts: if foreseen.is_finite() { foreseen } else { rms },
            evaluations: found.evaluations,
        })
    }
}
