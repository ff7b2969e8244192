//! Fitting a model to a recording: start from regression, search, and say what was learnt.

mod filter;
pub mod margins;
pub mod physical;
pub mod regression;
pub mod report;
pub mod scores;
pub mod uncertainty;

use crate::error::Error;
use crate::input::Known;
use crate::problem::cost::{Horizon, errors, rms_counts};
use crate::problem::simulate::Method;
use crate::problem::{Base, Candidate, Data, FitProblem, StartAngle, Structure};
use crate::recording::Drive;
use crate::solve::nelder_mead::NelderMead;
use crate::solve::{Evaluator, Found, Objective, Solver};
use shared::cost::Cost;
use shared::effects::{Kind, Place};
use shared::motor::Machine;
use std::sync::atomic::AtomicBool;

pub use report::{Fit, Parameter};

/// What to fit, and how.
#[derive(Clone, Debug)]
pub struct Options {
    /// Effects beside the linear machine.
    pub effects: Vec<Kind>,
    /// What is minimised.
    pub cost: Cost,
    /// Seed of the search.
    pub seed: u64,
    /// Largest number of model evaluations.
    pub budget: usize,
    /// Length of the windows in which the model runs on its own; the whole recording if `None`.
    pub window_s: Option<f64>,
    /// How the model is run.
    pub method: Method,
    /// Facts about the motor.
    pub known: Known,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            effects: Vec::new(),
            cost: Cost::Squared,
            seed: 1,
            budget: 20_000,
            window_s: None,
            method: Method {
                substeps: 2,
                ..Method::default()
            },
            known: Known::default(),
        }
    }
}

/// Samples to each side from which the speed at a window's start is taken.
pub const SPEED_HALF_WIDTH: usize = 4;
/// A motor that turns more than this part of its fastest speed at the first sample started in motion.
const STARTS_MOVING: f64 = 0.01;

/// The problem that `options` state, with its start from regression.
///
/// # Errors
/// [`Error::Failed`] where no regression gives a machine: the recording does not excite the motor.
pub fn problem<'a>(data: &'a Data, options: &Options) -> Result<FitProblem<'a>, Error> {
    let base = base_for(data, &options.effects);
    let start_speed = starts_moving(data) && options.window_s.is_none();
    let unit = Machine {
        kb: 1.0,
        damping: 0.0,
        inertia: 1.0,
        electrical: 0.0,
    };
    let sketch = Structure::around(data, base, &options.effects, &unit, start_speed);
    let guesses = regression::guesses(data, &sketch);
    let speed_now = data.speed_counts_s(0, SPEED_HALF_WIDTH) / data.units.counts_per_rev
        * core::f64::consts::TAU;
    let mut problem = FitProblem {
        data,
        structure: sketch,
        cost: options.cost,
        weight: 1.0,
        horizon: match options.window_s {
            Some(seconds) => Horizon::windows(data, seconds, SPEED_HALF_WIDTH),
            None => Horizon::Whole,
        },
        start_angle: StartAngle::Free,
        method: options.method,
        start: None,
    };
    let mut best: Option<(f64, Vec<f64>, Structure)> = None;
    for guess in guesses {
        let structure =
            Structure::around(data, base, &options.effects, &guess.machine, start_speed);
        let x =
            structure.coordinates(&structure.values_of(&guess.machine, &guess.effects, speed_now));
        problem.structure = structure;
        let cost = problem.cost(&x);
        if cost.is_finite() && best.as_ref().is_none_or(|(least, ..)| cost < *least) {
            best = Some((cost, x, problem.structure.clone()));
        }
    }
    let (_, start, structure) = best.ok_or_else(|| {
        Error::Failed(format!(
            "{}: no motor fits this recording even roughly: the speed does not follow the command. \
             Check the columns and units, the sign of the angle (positive voltage must raise it), \
             and that the motor was driven",
            data.source
        ))
    })?;
    problem.structure = structure;
    problem.start = Some(start);
    Ok(problem)
}

/// Viscous friction is searched for apart from back-EMF where something can tell the two apart:
/// coasting with the bridge open, or a torque that passes only the one of them.
fn base_for(data: &Data, effects: &[Kind]) -> Base {
    let mechanical = |kind: &Kind| {
        matches!(
            kind.description().place,
            Place::Friction | Place::Torque | Place::Load
        )
    };
    match data.drive {
        Drive::Current => Base::CurrentDriven,
        Drive::Voltage => Base::Response {
            damping: data.coasts() || effects.iter().any(mechanical),
        },
    }
}

fn starts_moving(data: &Data) -> bool {
    let per_interval = data.speed_counts_s(0, SPEED_HALF_WIDTH).abs() * data.units.interval;
    let fastest = data.units.counts_per_unit();
    per_interval > STARTS_MOVING * fastest && per_interval * SPEED_HALF_WIDTH as f64 > 2.0
}

/// Part of the budget, at most, for the polish after least squares.
const POLISH: usize = 600;

/// Searches with one method. Least squares minimises squares, whatever the cost is: where the cost
/// is another, a simplex search polishes its result.
pub fn search(
    problem: &FitProblem<'_>,
    solver: &dyn Solver,
    options: &Options,
    stop: &AtomicBool,
    observer: &mut dyn FnMut(usize, f64),
) -> Found {
    let mut evaluator = Evaluator::new(problem, options.budget, stop, observer);
    solver.search(&mut evaluator, options.seed);
    if solver.name() == "lm" && problem.cost != Cost::Squared {
        evaluator.limit(POLISH);
        let polish = NelderMead {
            edge: 1e-3,
            ..NelderMead::default()
        };
        polish.search(&mut evaluator, options.seed);
    }
    evaluator.finish()
}

/// Error of a fitted model on another recording, whose start angle and speed are its own: RMS in
/// counts over the whole of it.
pub fn validate(data: &Data, candidate: &Candidate, method: Method) -> Result<f64, Error> {
    let mut candidate = *candidate;
    candidate.start_speed = if starts_moving(data) {
        data.speed_counts_s(0, SPEED_HALF_WIDTH) / data.units.counts_per_rev
            * core::f64::consts::TAU
    } else {
        0.0
    };
    let errors = errors(
        data,
        &candidate,
        method,
        &Horizon::Whole,
        StartAngle::Free,
        Cost::Squared,
    )?;
    Ok(rms_counts(data, &errors))
}
