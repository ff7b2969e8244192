//! The recordings and how models are run: what every fit of a diagnosis needs.

use super::descent::{Settings, descend};
use super::motion::Motion;
use super::refit::Refit;
use crate::error::Error;
use crate::fit::{self, Options, base_for};
use crate::problem::simulate::Method;
use crate::problem::{Data, FitProblem, Structure};
use shared::effects::Kind;

/// Of the linear motor.
const BASE: Settings = Settings {
    evaluations: 80,
    tolerance: 1e-6,
    stride: 1,
    enough: 0.0,
    damping: 1e-9,
    secant: false,
};

/// The recordings and how models are run.
pub struct Workshop<'a> {
    /// Fitted.
    pub data: &'a Data,
    /// Never fitted.
    pub held_out: &'a Data,
    /// The fitted recording's motion.
    pub motion: Motion,
    /// How models are run at first.
    pub method: Method,
}

impl<'a> Workshop<'a> {
    /// Prepares. Models are run with one part to a sample, which [`polish`](Self::polish) refines where it
    /// matters.
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
            method: self.method,
            ..options.clone()
        };
        let problem = self.base_problem(&options)?;
        let start = problem.start.clone().unwrap_or_default();
        let found = descend(&problem, &start, BASE)
            .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", self.data.source)))?;
        let foreseen = (found.squares / self.data.len() as f64).sqrt();
        self.conclude(problem.structure, &found, foreseen, self.method)
    }

    /// The linear motor with a start. A strong offset hides the motor from regression: then it is found beside
    /// one.
    fn base_problem(&self, options: &Options) -> Result<FitProblem<'_>, Error> {
        let plain = fit::problem(self.data, options);
        let Err(error) = plain else { return plain };
        let beside = Options {
            effects: vec![Kind::OffsetVoltage],
            ..options.clone()
        };
        let Ok(with_offset) = fit::problem(self.data, &beside) else {
            return Err(error);
        };
        let start = with_offset.start.clone().unwrap_or_default();
        let values = with_offset.structure.values(&start);
        let candidate = with_offset.structure.candidate(&values);
        let speed = with_offset.structure.start_speed;
        let structure = Structure::around(
            self.data,
            base_for(self.data, &[]),
            &[],
            &candidate.machine,
            speed,
        );
        let mut problem = self.problem(&structure, self.method);
        let values = structure.values_of(&candidate.machine, &[], candidate.start_speed);
        problem.start = Some(structure.coordinates(&values));
        Ok(problem)
    }
}
