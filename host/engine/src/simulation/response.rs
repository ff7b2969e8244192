//! What a model does under commands: a simulation without a measurement.

use super::candidate::{Candidate, Method};
use super::horizon::{Horizon, StartAngle};
use super::segment::segments;
use super::single::Simulation;
use crate::data::Data;
use servoid_io::channel::Series;
use servoid_io::recording::{Drive, Recording};
use shared::error::ModelError;
use thiserror::Error;

/// What a motor is driven by.
#[derive(Clone, Debug)]
pub struct Commands {
    /// Times, s.
    pub time_s: Vec<f64>,
    /// Command from each time until the next, V (A for a motor behind a current loop).
    pub command: Vec<f64>,
    /// False while the bridge is open; always driven if none.
    pub enabled: Option<Vec<bool>>,
    /// Counts per revolution of the encoder.
    pub counts_per_rev: f64,
}

/// Why commands cannot be simulated.
#[derive(Debug, Error)]
pub enum ResponseError {
    /// Too few.
    #[error("{0} samples are too few to simulate; give two or more")]
    Few(usize),
    /// Columns of different lengths.
    #[error("time has {time} samples and {column} has {other}; give as many of each")]
    Lengths {
        /// Samples of the time.
        time: usize,
        /// The other column.
        column: &'static str,
        /// Its samples.
        other: usize,
    },
    /// A number that is none.
    #[error("sample {sample}: {column} is {value}; give finite numbers")]
    NotFinite {
        /// Index of the sample, from zero.
        sample: usize,
        /// Its column.
        column: &'static str,
        /// What stands there.
        value: f64,
    },
    /// Time that stands or goes back.
    #[error("sample {sample}: time goes from {before} to {now} s; it must increase")]
    Time {
        /// Index of the sample, from zero.
        sample: usize,
        /// The time before it, s.
        before: f64,
        /// Its time, s.
        now: f64,
    },
    /// No model can be made.
    #[error(transparent)]
    Model(#[from] ModelError),
}

/// The angle at each of the times as the encoder senses it before it rounds down, counts, from the candidate's start.
///
/// # Errors
/// Commands that are no commands; a model that cannot run.
pub fn response(
    candidate: &Candidate,
    method: Method,
    commands: Commands,
) -> Result<Vec<f64>, ResponseError> {
    commands.check()?;
    let fastest = fastest(candidate, &commands);
    let samples = commands.time_s.len();
    let recording = Recording {
        source: String::new(),
        time_s: commands.time_s,
        command: commands.command,
        counts: vec![0.0; samples],
        measured: Series::NONE,
        enabled: commands.enabled,
        counts_per_rev: commands.counts_per_rev,
        quantised: false,
        // Only a base, where all commands are zero.
        supply_v: Some(1.0),
        drive: Drive::Voltage,
        position: None,
    };
    let data = Data::driven(recording, fastest)?;
    let simulation = Simulation::new(&data, candidate, method)?;
    let segments = segments(&data, candidate, &Horizon::Whole, StartAngle::Free);
    // Model less a reading of zero.
    Ok(simulation.errors(Horizon::Whole.mode(), &segments))
}

/// A speed that the motor may reach, rad/s: a base for its numbers, and how finely times are told apart.
fn fastest(candidate: &Candidate, commands: &Commands) -> f64 {
    let most = commands.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let machine = &candidate.machine;
    let seconds = commands.time_s[commands.time_s.len() - 1] - commands.time_s[0];
    let by_run_up = most * seconds / machine.inertia;
    let by_back_emf = most / (machine.kb + machine.damping);
    let reached = by_run_up.min(by_back_emf).max(candidate.start_speed.abs());
    if reached > 0.0 { reached } else { 1.0 }
}

impl Commands {
    fn check(&self) -> Result<(), ResponseError> {
        let time = self.time_s.len();
        if time < 2 {
            return Err(ResponseError::Few(time));
        }
        let enabled = self.enabled.as_ref().map_or(time, Vec::len);
        for (column, other) in [("command", self.command.len()), ("enabled", enabled)] {
            if other != time {
                return Err(ResponseError::Lengths {
                    time,
                    column,
                    other,
                });
            }
        }
        for (column, values) in [("time", &self.time_s), ("command", &self.command)] {
            if let Some(sample) = values.iter().position(|value| !value.is_finite()) {
                return Err(ResponseError::NotFinite {
                    sample,
                    column,
                    value: values[sample],
                });
            }
        }
        match self.time_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            None => Ok(()),
            Some(k) => Err(ResponseError::Time {
                sample: k + 1,
                before: self.time_s[k],
                now: self.time_s[k + 1],
            }),
        }
    }
}
