//! The recordings and how models are run: what every fit of a diagnosis needs.

use super::descent::{Descent, PROBE, Settings, descend};
use super::effort::Effort;
use super::motion::Motion;
use super::refit::Refit;
use super::span::{Span, floor_counts};
use crate::error::Error;
use crate::fit::{self, Options, SPEED_HALF_WIDTH, base_for, scores};
use servoid_engine::problem::rms_counts;
use servoid_engine::problem::{Candidate, Data, FitProblem, Horizon, Structure};
use servoid_engine::simulation::Method;
use servoid_engine::solve::Objective;
use shared::effects::Kind;
use shared::encoder::FLOOR_RMS_COUNTS;
use shared::motor::Machine;

/// Of the linear motor.
const BASE: Settings = Settings {
    evaluations: 80,
    tolerance: 1e-6,
    stride: 1,
    enough: 0.0,
    damping: 1e-9,
    secant: false,
    probe: PROBE,
    probed: None,
    again: true,
};

/// The recordings and how models are run.
pub struct Workshop<'a> {
    /// Fitted.
    pub data: &'a Data,
    /// Never fitted.
    pub held_out: &'a Data,
    /// The fitted recording's motion.
    pub motion: Motion,
    /// How far models run on their own.
    pub span: Span,
    /// The same for the fitted recording,
    pub fitted_horizon: Horizon,
    /// and for the other.
    pub held_out_horizon: Horizon,
    /// RMS error that the reading's own noise makes of a right model, counts.
    pub floor: f64,
    /// How models are run at first.
    pub method: Method,
    /// How much may be computed.
    pub effort: &'a Effort<'a>,
}

impl<'a> Workshop<'a> {
    /// Prepares. Models are run with one part to a sample, which [`polish`](Self::polish) refines where it
    /// matters.
    pub fn new(
        data: &'a Data,
        held_out: &'a Data,
        options: &Options,
        effort: &'a Effort<'a>,
    ) -> Self {
        let span = Span::of(data, options);
        Workshop {
            fitted_horizon: horizon(&span, data),
            held_out_horizon: horizon(&span, held_out),
            span,
            floor: FLOOR_RMS_COUNTS,
            data,
            held_out,
            motion: Motion::measured(data),
            method: Method {
                substeps: 1,
                ..options.method
            },
            effort,
        }
    }

    /// The same for runs over another span.
    #[must_use]
    pub fn over(self, span: Span) -> Self {
        Workshop {
            fitted_horizon: horizon(&span, self.data),
            held_out_horizon: horizon(&span, self.held_out),
            span,
            floor: FLOOR_RMS_COUNTS,
            ..self
        }
    }

    /// Descends, and books what it took. `None` where the model cannot run at the start.
    pub(super) fn descended(
        &self,
        problem: &dyn Objective,
        start: &[f64],
        settings: Settings,
        method: Method,
    ) -> Option<Descent> {
        let found = descend(problem, start, settings, self.effort)?;
        let steps = self.data.len() * usize::from(method.substeps.max(1)) * found.evaluations;
        self.effort.book(steps as u64);
        Some(found)
    }

    /// The linear motor.
    ///
    /// # Errors
    /// [`Error::Failed`] where no motor fits even roughly.
    pub fn base(&mut self, options: &Options) -> Result<Refit, Error> {
        let options = Options {
            effects: Vec::new(),
            window_s: self.span.window_s,
            method: self.method,
            ..options.clone()
        };
        let problem = self.base_problem(&options)?;
        let start = problem.start.clone().unwrap_or_default();
        let found = self
            .descended(&problem, &start, BASE, self.method)
            .ok_or_else(|| Error::Failed(format!("{}: no start for a fit", self.data.source)))?;
        let structure = problem.structure;
        let mut base = self.concluded_base(structure, &found)?;
        let machine = &base.candidate.machine;
        let fitted = floor_counts(self.data, &self.fitted_horizon, machine);
        let held_out = floor_counts(self.held_out, &self.held_out_horizon, machine);
        self.floor = fitted.max(held_out);
        if let Some(windowed) = &mut base.windowed {
            windowed.floor = self.floor;
        }
        Ok(base)
    }

    /// The linear motor, fitted again from `machine`, if that explains the recording down to the encoder after all.
    pub fn base_again(&self, base: &Refit, machine: &Machine<f64>) -> Option<Refit> {
        let (kind, speed) = (base.structure.base, base.structure.start_speed);
        let structure = Structure::around(self.data, kind, &[], machine, speed);
        let start = structure.values_of(machine, &[], base.candidate.start_speed);
        let start = structure.coordinates(&start);
        let problem = self.problem(&structure, self.method);
        let found = self.descended(&problem, &start, BASE, self.method)?;
        let again = self.concluded_base(structure, &found).ok()?;
        again.judged().at_floor().then_some(again)
    }

    fn concluded_base(&self, structure: Structure, found: &Descent) -> Result<Refit, Error> {
        let foreseen = (found.squares / self.data.len() as f64).sqrt();
        self.conclude(structure, found, foreseen, self.method)
    }

    /// The linear motor with a start. A strong offset hides the motor from regression: then it is found beside
    /// one.
    fn base_problem(&self, options: &Options) -> Result<FitProblem<'_>, Error> {
        let plain = fit::problem(self.data, options);
        let Err(error) = plain else { return plain };
        let Ok(with_offset) = self.beside_offset(options) else {
            return Err(error);
        };
        let candidate = candidate_of(&with_offset);
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

    /// The linear motor beside a constant that drives it, with its start.
    fn beside_offset(&self, options: &Options) -> Result<FitProblem<'_>, Error> {
        let beside = Options {
            effects: vec![Kind::OffsetVoltage],
            ..options.clone()
        };
        fit::problem(self.data, &beside)
    }

    /// The linear motor as regression sees it beside a constant that drives it, and its RMS error over the
    /// whole recording, counts. A strong load bends a fit without it by orders of magnitude.
    pub fn steadied(&self, options: &Options) -> Option<(Machine<f64>, f64)> {
        let options = Options {
            window_s: None,
            method: self.method,
            ..options.clone()
        };
        let candidate = candidate_of(&self.beside_offset(&options).ok()?);
        let errors = scores::whole(self.data, &candidate, self.method).ok()?;
        Some((candidate.machine, rms_counts(self.data, &errors)))
    }
}

/// How far models run along data on their own.
fn horizon(span: &Span, data: &Data) -> Horizon {
    match span.window_s {
        Some(seconds) => Horizon::windows(data, seconds, SPEED_HALF_WIDTH),
        None => Horizon::Whole,
    }
}

/// The model that a problem starts from.
fn candidate_of(problem: &FitProblem<'_>) -> Candidate {
    let start = problem.start.as_deref().unwrap_or_default();
    problem
        .structure
        .candidate(&problem.structure.values(start))
}
