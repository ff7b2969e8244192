//! One model with one set of effects, fitted to the recording and judged on the other.

use super::NOISE_COUNTS;
use super::descent::{Descent, PROBE, Settings};
use super::errors::{Errors, ROOM};
use super::missed::Losses;
use super::sketch::Sketch;
use super::track::Tracked;
use super::workshop::Workshop;
use crate::error::Error;
use crate::fit::{scores, validate, validate_roughly};
use servoid_engine::problem::{Candidate, Data, FitProblem, Horizon, StartAngle, Structure};
use servoid_engine::problem::{errors, rms_counts};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::cmp::Ordering;

/// Of a fit by full simulation.
const FULL: Settings = Settings {
    evaluations: 80,
    tolerance: 1e-3,
    stride: 2,
    enough: 0.0,
    damping: 1e-6,
    secant: true,
    probe: PROBE,
    probed: None,
    again: true,
};
/// Of a stage with a short memory.
const FADE: Settings = Settings {
    evaluations: 40,
    tolerance: 1e-2,
    stride: 4,
    enough: f64::INFINITY,
    damping: 1e-4,
    secant: true,
    probe: PROBE,
    probed: None,
    again: true,
};
/// How long errors are remembered, stage by stage.
const MEMORIES_S: [f64; 4] = [0.02, 0.1, 0.5, 2.5];
/// A stage that leaves so many times the error of the one before has lost its way.
const ASTRAY: f64 = 2.0;
/// A simulation whose error is so many times the led one's has lost its way.
pub(super) const LOST: f64 = 3.0;
/// A chaotic run that was followed over such a part of the recording proves the model.
const PROOF: f64 = 0.5;
/// Tracked scores this near are as good as each other.
const AS_GOOD: f64 = 0.04;

/// A fitted model with its errors.
#[derive(Clone, Debug)]
pub struct Refit {
    /// The effects, the newest last; one that its structure holds several times stands here once.
    pub effects: Vec<Kind>,
    /// The model.
    pub candidate: Candidate,
    /// The unknowns.
    pub structure: Structure,
    /// Where it stands in the unknowns' unit cube.
    pub x: Vec<f64>,
    /// Values of the effects' parameters, SI.
    pub parameters: Vec<f64>,
    /// The counts that were lost, where [`Kind::MissedCounts`] is among the effects: then all errors are
    /// those with the lost counts put back, and `candidate` and `structure` are without that effect.
    pub losses: Option<Losses>,
    /// RMS error on the fitted recording, open loop, counts.
    pub rms_counts: f64,
    /// RMS error on the held-out recording, counts.
    pub validate_rms_counts: f64,
    /// Errors in windows, each run from the measured state, where whole runs say little.
    pub windowed: Option<Errors>,
    /// Errors that are soon forgotten, where free runs are chaotic.
    pub tracked: Option<Tracked>,
    /// The same for every memory that was asked for, so that none is computed again whenever models are compared.
    pub(super) tracks: Vec<Tracked>,
    /// The part of the recording, from its begin, over which a chaotic free run was followed and leaves the reading's own error.
    pub followed: f64,
    /// RMS error that was foreseen before the refit, counts.
    pub foreseen_rms_counts: f64,
    /// Evaluations spent on it.
    pub evaluations: usize,
    /// How it was run.
    pub method: Method,
}

impl Refit {
    /// Errors of the free runs.
    pub fn free(&self) -> Errors {
        Errors {
            fitted: self.rms_counts,
            held_out: self.validate_rms_counts,
            floor: FLOOR_RMS_COUNTS,
        }
    }

    /// The errors of the runs that were fitted: in windows if there are any.
    pub fn ran(&self) -> Errors {
        self.windowed.unwrap_or_else(|| self.free())
    }

    /// The errors that it is judged by: those of the runs that were fitted, unless they are chaotic.
    pub fn judged(&self) -> Errors {
        match self.tracked {
            Some(tracked) if !self.ran().at_floor() => tracked.errors,
            _ => self.ran(),
        }
    }

    /// Whether it leaves the reading's own error only, by what it is judged by.
    pub fn explains(&self) -> bool {
        self.is_proven() || self.judged().at_floor()
    }

    /// Whether it does so running on its own: to the end, or as far as a chaotic run can be followed.
    pub fn is_proven(&self) -> bool {
        self.ran().at_floor() || self.followed >= PROOF
    }

    /// Whether nothing more need be looked for. A model that has to be held tightly to the readings may yet lack something.
    pub fn is_complete(&self) -> bool {
        let tight = self.tracked.is_some_and(|tracked| !tracked.is_loose());
        self.is_proven() || (self.judged().at_floor() && !tight)
    }

    /// Order by what they are judged by, best first.
    pub fn by_score(&self, other: &Refit) -> Ordering {
        self.judged().score().total_cmp(&other.judged().score())
    }

    /// Whether its newest effect is as large as is searched for: then it does another one's work.
    pub fn at_wall(&self) -> bool {
        let Some(newest) = self.effects.last() else {
            return false;
        };
        let values = self.structure.values_of(
            &self.candidate.machine,
            &self.parameters,
            self.candidate.start_speed,
        );
        let amplitude = |name: &str| {
            let parameters = newest.description().parameters;
            name.split_once('.').is_some_and(|(effect, name)| {
                effect == newest.name() && parameters.iter().any(|p| p.amplitude && p.name == name)
            })
        };
        let unknowns = self.structure.unknowns.iter().zip(&values);
        unknowns.into_iter().any(|(unknown, &value)| {
            let x = unknown.coordinate(value);
            amplitude(&unknown.name) && (x == 1.0 || (x == 0.0 && unknown.range.0 < 0.0))
        })
    }
}

impl Workshop<'_> {
    /// Fits a sketched model by full simulation.
    ///
    /// # Errors
    /// [`Error::Failed`] where the model cannot run from there.
    pub fn refit(&self, sketch: &Sketch) -> Result<Refit, Error> {
        let settings = Settings {
            enough: (self.floor * ROOM).powi(2) * self.data.len() as f64,
            ..FULL
        };
        let foreseen = sketch.foreseen();
        let fit = |start: &[f64]| {
            let found = self.descend(&sketch.structure, start, settings, self.method)?;
            self.conclude(sketch.structure.clone(), &found, foreseen, self.method)
        };
        // Where the simulation is far worse than the led model foresaw, the free run has lost its way.
        if self.span.window_s.is_some() || sketch.simulated <= LOST * sketch.led.max(NOISE_COUNTS) {
            return fit(&sketch.x);
        }
        let faded = self.fade(&sketch.structure, &sketch.x);
        let free = fit(&faded)?;
        if free.ran().at_floor() {
            return Ok(free);
        }
        // A free run that is chaotic leads the search astray; then what the observer learnt stands.
        let stand = Descent {
            squares: 0.0,
            evaluations: free.evaluations,
            x: faded,
        };
        let faded = self.conclude(sketch.structure.clone(), &stand, foreseen, self.method)?;
        let mut both = [free, faded];
        self.track_all(&mut both);
        let score = |refit: &Refit| {
            let errors = refit.tracked.map(|tracked| tracked.errors);
            errors.map_or(f64::INFINITY, |errors| errors.score())
        };
        let [free, faded] = both;
        Ok(if score(&free) < score(&faded) + AS_GOOD {
            free
        } else {
            faded
        })
    }

    /// Looks for the start of the held-out run as it is looked for where results are told.
    pub(super) fn follow_held_out(&self, refit: &mut Refit) {
        // Where nothing depends on the angle, where it began does not matter.
        if refit.losses.is_none()
            && refit.candidate.needs_angle()
            && let Ok(rms) = validate(self.held_out, &refit.candidate, refit.method)
        {
            refit.validate_rms_counts = rms;
        }
    }

    /// Descends with a memory that grows from stage to stage, so that the search meets the rough cost of the
    /// free run only when it is near.
    fn fade(&self, structure: &Structure, x: &[f64]) -> Vec<f64> {
        let mut x = x.to_vec();
        let mut last = f64::INFINITY;
        for memory_s in MEMORIES_S {
            let problem = FitProblem {
                horizon: Horizon::Observer(memory_s),
                ..self.problem(structure, self.method)
            };
            let Some(found) = self.descended(&problem, &x, FADE, self.method) else {
                break;
            };
            let rms = (found.squares / self.data.len() as f64).sqrt();
            if rms > ASTRAY * last.max(NOISE_COUNTS) {
                break;
            }
            last = rms;
            x = found.x;
        }
        x
    }

    fn descend(
        &self,
        structure: &Structure,
        start: &[f64],
        settings: Settings,
        method: Method,
    ) -> Result<Descent, Error> {
        self.descended(&self.problem(structure, method), start, settings, method)
            .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", self.data.source)))
    }

    /// The recording, run over the span that was chosen.
    pub(super) fn problem(&self, structure: &Structure, method: Method) -> FitProblem<'_> {
        FitProblem {
            data: self.data,
            structure: structure.clone(),
            cost: Cost::Squared,
            weight: 1.0,
            horizon: self.fitted_horizon.clone(),
            start_angle: StartAngle::Free,
            method,
            start: None,
        }
    }

    /// Errors of a model over the span that was chosen.
    ///
    /// # Errors
    /// As [`refit`](Self::refit).
    pub(super) fn runs(&self, candidate: &Candidate, method: Method) -> Result<Errors, Error> {
        if self.span.window_s.is_none() {
            return Ok(Errors {
                fitted: rms_counts(self.data, &scores::whole(self.data, candidate, method)?),
                held_out: validate_roughly(self.held_out, candidate, method)?,
                floor: self.floor,
            });
        }
        let rms = |data: &Data, horizon: &Horizon| {
            let cost = Cost::Squared;
            errors(data, candidate, method, horizon, StartAngle::Free, cost)
                .map(|errors| rms_counts(data, &errors))
        };
        Ok(Errors {
            fitted: rms(self.data, &self.fitted_horizon)?,
            held_out: rms(self.held_out, &self.held_out_horizon)?,
            floor: self.floor,
        })
    }

    /// Scores a model where a search ended.
    ///
    /// # Errors
    /// As [`refit`](Self::refit).
    pub(super) fn conclude(
        &self,
        structure: Structure,
        found: &Descent,
        foreseen: f64,
        method: Method,
    ) -> Result<Refit, Error> {
        let values = structure.values(&found.x);
        let candidate = structure.candidate(&values);
        let windows = self.span.window_s.is_some();
        Ok(Refit {
            effects: distinct(&structure.effects),
            parameters: structure.effect_values(&values).to_vec(),
            candidate,
            structure,
            x: found.x.clone(),
            losses: None,
            rms_counts: if windows {
                validate_roughly(self.data, &candidate, method)?
            } else {
                rms_counts(self.data, &scores::whole(self.data, &candidate, method)?)
            },
            windowed: if windows {
                Some(self.runs(&candidate, method)?)
            } else {
                None
            },
            validate_rms_counts: validate_roughly(self.held_out, &candidate, method)?,
            tracked: None,
            tracks: Vec::new(),
            followed: 0.0,
            foreseen_rms_counts: foreseen,
            evaluations: found.evaluations,
            method,
        })
    }
}

/// Each effect once, in order.
fn distinct(effects: &[Kind]) -> Vec<Kind> {
    let mut distinct: Vec<Kind> = Vec::new();
    for &kind in effects {
        if !distinct.contains(&kind) {
            distinct.push(kind);
        }
    }
    distinct
}
