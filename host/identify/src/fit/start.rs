//! The problem that a recording and options state, and its start from regression.

use super::options::Options;
use super::regression::{self, Guess};
use crate::check::{DriveResponse, Driven, drive_response};
use crate::error::Error;
use servoid_engine::block_cost::BlockCost;
use servoid_engine::problem::{Base, Data, FitProblem, Horizon, StartAngle, Structure};
use servoid_io::recording::Drive;
use shared::discretise::Discretisation;
use shared::effects::{Kind, Place};
use shared::motor::Machine;

/// Samples to each side from which the speed at a window's start is taken.
pub const SPEED_HALF_WIDTH: usize = 4;

/// The problem that `options` state, with its start from regression.
///
/// # Errors
/// [`Error::Failed`] where no regression gives a machine: the recording does not excite the motor.
pub fn problem<'a>(data: &'a Data, options: &Options) -> Result<FitProblem<'a>, Error> {
    check(data, options)?;
    let mut starts = starts(data, options);
    let mut still = starts.best(false);
    let follows = || options.force || response(data) == DriveResponse::Follows;
    if still.is_none() && options.method.discretisation != Discretisation::Euler && follows() {
        starts.guesses = usual_machines(data, &starts.problem.structure);
        still = starts.best(false);
    }
    let moving = if data.may_start_moving(0) && options.window_s.is_none() {
        starts.best(true)
    } else {
        None
    };
    let best = match (still, moving) {
        // A start in motion that is not plain to see must earn its unknown; where the model lacks much, none does.
        (Some(still), Some(moving)) => {
            if data.starts_moving(0) || moving.cost < EARNED * still.cost {
                moving
            } else {
                still
            }
        }
        (Some(only), None) | (None, Some(only)) => only,
        (None, None) => return Err(no_motor(data, options)),
    };
    let mut problem = starts.problem;
    problem.structure = best.structure;
    problem.start = Some(best.x);
    Ok(problem)
}

/// A speed at the first sample is searched for if it lowers the cost of the start at least to this part.
const EARNED: f64 = 0.8;
/// Fewest samples that say anything about a motor.
const FEWEST_SAMPLES: usize = 10;
/// Fewest samples in a window.
const FEWEST_IN_WINDOW: f64 = 8.0;

/// Refuses recordings and options that cannot give a fit, with the reason.
fn check(data: &Data, options: &Options) -> Result<(), Error> {
    if data.len() < FEWEST_SAMPLES {
        return Err(Error::Failed(format!(
            "{}: {} samples are too few for a motor; record at least {FEWEST_SAMPLES}, better some thousand",
            data.source,
            data.len()
        )));
    }
    let least = FEWEST_IN_WINDOW * data.units.interval;
    match options.window_s {
        Some(seconds) if seconds < least => Err(Error::Usage(format!(
            "--window {seconds}: shorter than {FEWEST_IN_WINDOW} samples of {:.6} s; take at least {least:.6}",
            data.units.interval
        ))),
        _ => Ok(()),
    }
}

/// Whether no regression gives a motor, and the motor surely speeds up against its command.
pub fn is_reversed(data: &Data, options: &Options) -> bool {
    starts(data, options).best(false).is_none() && response(data) == DriveResponse::Reversed
}

fn response(data: &Data) -> DriveResponse {
    drive_response(&Driven {
        time_s: &data.time_s,
        command: &data.command,
        counts: &data.counts,
        counts_per_rev: data.units.counts_per_rev,
        closed: &|k| !data.is_open(k),
    })
}

/// Guesses where no regression gives a machine although the motor follows its command: a load that the model lacks hides the
/// machine. Mechanical time constants in steps, s, each with the gain that makes the supply the fastest speed, and less.
fn usual_machines(data: &Data, structure: &Structure) -> Vec<Guess> {
    let mut speeds: Vec<f64> = (0..data.len())
        .map(|k| data.speed_counts_s(k, SPEED_HALF_WIDTH).abs())
        .collect();
    speeds.sort_by(f64::total_cmp);
    let fast = speeds[speeds.len() * 95 / 100] / data.units.counts_per_rev * core::f64::consts::TAU;
    let fast = if fast > 0.0 { fast } else { data.units.speed };
    let largest = data.command.iter().fold(0.0f64, |m, u| m.max(u.abs())) * data.units.volts;
    let dampings = [1.0, 0.3].map(|part| part * largest / fast);
    let machine = |damping: f64, time_constant: f64| match structure.base {
        Base::CurrentDriven => Machine {
            kb: 0.0,
            damping,
            inertia: damping * time_constant,
            electrical: 0.0,
        },
        Base::Response { .. } | Base::Physical { .. } => Machine {
            kb: damping,
            damping: 0.0,
            inertia: damping * time_constant,
            electrical: 0.0,
        },
    };
    let effects: Vec<f64> = structure
        .effects
        .iter()
        .flat_map(|kind| kind.parameters())
        .map(|parameter| {
            let share = if parameter.amplitude {
                0.0
            } else {
                parameter.typical
            };
            parameter.scaled(share, data.supply, data.units.speed)
        })
        .collect();
    dampings
        .iter()
        .flat_map(|&damping| TIME_CONSTANTS_S.map(|tau| machine(damping, tau)))
        .map(|machine| Guess {
            machine,
            effects: effects.clone(),
        })
        .collect()
}

/// Mechanical time constants from which a search begins where no regression tells one, s.
const TIME_CONSTANTS_S: [f64; 4] = [0.01, 0.03, 0.1, 0.3];

/// Why no regression gave a machine.
fn no_motor(data: &Data, options: &Options) -> Error {
    let reason = if is_reversed(data, options) {
        "the angle falls where the voltage should raise it: the sign of the angle (or of the voltage) is \
         reversed; swap the encoder's channels or negate the column"
    } else if options.method.discretisation == Discretisation::Euler {
        "no motor fits it even roughly with the Euler step, which is unstable where the sample interval is \
         longer than about twice the shortest time constant; use --integrator exact"
    } else {
        "no motor fits this recording even roughly: the speed does not follow the command. Check the columns \
         and units, the sign of the angle (positive voltage must raise it), and that the motor was driven"
    };
    Error::Failed(format!("{}: {reason}", data.source))
}

/// A problem, and what regression guesses at.
struct Starts<'a> {
    problem: FitProblem<'a>,
    guesses: Vec<Guess>,
}

/// A start of the search.
struct Start {
    cost: f64,
    x: Vec<f64>,
    structure: Structure,
}

/// The problem, without a start, and the guesses for one.
fn starts<'a>(data: &'a Data, options: &Options) -> Starts<'a> {
    let base = base_for(data, &options.effects, options.window_s.is_some());
    let unit = Machine {
        kb: 1.0,
        damping: 0.0,
        inertia: 1.0,
        electrical: 0.0,
    };
    let structure = Structure::around(data, base, &options.effects, &unit, false);
    let guesses = regression::guesses(data, &structure);
    let problem = FitProblem {
        data,
        structure,
        cost: options.cost,
        weight: 1.0,
        horizon: match options.window_s {
            Some(seconds) => Horizon::windows(data, seconds),
            None => Horizon::Whole,
        },
        start_angle: StartAngle::Free,
        method: options.method,
        start: None,
    };
    Starts { problem, guesses }
}

impl Starts<'_> {
    /// The guess that costs least, at rest or in motion at the first sample; `None` where no guess is a motor.
    fn best(&self, start_speed: bool) -> Option<Start> {
        let FitProblem {
            data, structure, ..
        } = &self.problem;
        let quick = BlockCost::new(&self.problem);
        let speed_now = data.speed_counts_s(0, SPEED_HALF_WIDTH) / data.units.counts_per_rev
            * core::f64::consts::TAU;
        let start = |guess: &Guess| {
            let Guess { machine, effects } = guess;
            let (base, kinds) = (structure.base, &structure.effects);
            let structure = Structure::around(data, base, kinds, machine, start_speed);
            let x = structure.coordinates(&structure.values_of(machine, effects, speed_now));
            Start {
                cost: quick.cost_of(&structure.candidate_at(&x)),
                x,
                structure,
            }
        };
        let starts = self.guesses.iter().map(start);
        starts
            .filter(|start| start.cost.is_finite())
            .min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// Viscous friction is searched for apart from back-EMF where something can tell the two apart:
/// coasting with the bridge open, a torque that passes only the one of them, or an effect of the
/// current, since the current that a speed takes depends on how much of the damping is friction. Beside a torque only the
/// winding's delay tells them apart, which runs `in_windows`, above the encoder's floor, do not hold.
pub fn base_for(data: &Data, effects: &[Kind], in_windows: bool) -> Base {
    let separates = |kind: &Kind| {
        let needs = kind.needs();
        let mechanical = matches!(
            kind.description().place,
            Place::Friction | Place::Torque | Place::Load
        );
        let of_current = needs.winding || needs.current;
        of_current
            || if in_windows {
                needs.lost_torque
            } else {
                mechanical
            }
    };
    match data.drive {
        Drive::Current | Drive::Torque => Base::CurrentDriven,
        Drive::Voltage => Base::Response {
            damping: data.coasts() || effects.iter().any(separates),
        },
    }
}
