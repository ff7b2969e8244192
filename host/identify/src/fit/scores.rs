//! Errors of a fitted model, in the several ways that people measure them.

use super::filter::{Passing, filtered};
use super::options::Options;
use super::start::SPEED_HALF_WIDTH;
use crate::error::Error;
use servoid_engine::problem::{Candidate, Data, StartAngle};
use servoid_engine::problem::{Horizon, errors};
use servoid_engine::simulation::Method;
use shared::cost::Cost;
use shared::effects::{Lowered, Place, Shaft};
use shared::motor::Machine;

/// Filter time of the equation error, sample intervals.
const EQUATION_FILTER_SAMPLES: f64 = 5.0;

/// What was longer ago, in filter times, the filter has forgotten.
const MEMORY: f64 = 6.0;

/// Length of the windows when the user chose none, s.
const USUAL_WINDOW_S: f64 = 1.0;

/// Errors of free runs over short windows, each started from the measured angle and speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windowed {
    /// Length of a window, s.
    pub window_s: f64,
    /// RMS error, counts.
    pub rms_counts: f64,
    /// RMS error as a part of the RMS of the motion within the windows.
    pub relative: f64,
}

/// Model minus reading over the whole recording, open loop, with the best start angle.
pub fn whole(data: &Data, candidate: &Candidate, method: Method) -> Result<Vec<f64>, Error> {
    Ok(errors(
        data,
        candidate,
        method,
        &Horizon::Whole,
        StartAngle::Free,
        Cost::Squared,
    )?)
}

/// Scores of short free runs. `None` where a window holds too few samples.
pub fn windowed(data: &Data, candidate: &Candidate, options: &Options) -> Option<Windowed> {
    let window_s = options.window_s.unwrap_or(USUAL_WINDOW_S);
    let windows = Horizon::windows(data, window_s);
    let Horizon::Windows(list) = &windows else {
        return None;
    };
    if list.len() < 2 || data.len() / list.len() < 4 {
        return None;
    }
    let error = errors(
        data,
        candidate,
        options.method,
        &windows,
        StartAngle::Free,
        Cost::Squared,
    )
    .ok()?;
    let centre = data.half_cell();
    let (mut wrong, mut moved) = (0.0, 0.0);
    for window in list {
        let first = data.counts[window.range.start];
        for k in window.range.clone() {
            wrong += (error[k] - centre).powi(2);
            moved += (data.counts[k] - first).powi(2);
        }
    }
    Some(Windowed {
        window_s,
        rms_counts: (wrong / data.len() as f64).sqrt(),
        relative: (wrong / moved.max(f64::MIN_POSITIVE)).sqrt(),
    })
}

/// Equation error: how much of the drive the model's equation leaves unexplained along the measured
/// motion, as a part of the drive's RMS. Nothing is simulated, so nothing can drift. `None` where
/// the bridge was open too much of the time.
pub fn equation_error(data: &Data, candidate: &Candidate) -> Option<f64> {
    let time = EQUATION_FILTER_SAMPLES * data.units.interval;
    let (mut wrong, mut driven) = (0.0, 0.0);
    each_equation_residual(data, candidate, time, |left| {
        wrong += left.volts.powi(2);
        driven += left.command.powi(2);
    });
    (driven > 0.0).then(|| (wrong / driven).sqrt())
}

/// What a model's equation leaves unexplained at one sample.
#[derive(Clone, Copy, Debug)]
pub struct EquationResidual {
    /// The sample.
    pub sample: usize,
    /// Drive that the equation asks for and did not get, V: a torque against the motion counts positive.
    pub volts: f64,
    /// Angle, rad, from the first sample; as late as the filter makes the residual.
    pub angle: f64,
    /// Speed, rad/s; as late as the residual.
    pub speed: f64,
    /// Command, V; as late as the residual.
    pub command: f64,
    /// Acceleration, rad/s²; as late as the residual.
    pub acceleration: f64,
}

/// Coefficients of speed, acceleration and jerk in the linear motor's equation: what the volts at the winding are spent on.
pub fn motor_coefficients(machine: &Machine<f64>) -> [f64; 3] {
    [
        machine.kb + machine.damping,
        machine.inertia + machine.electrical * machine.damping,
        machine.electrical * machine.inertia,
    ]
}

/// Direction in which the shaft slides at a sample; zero where it may rest.
fn sliding(data: &Data, k: usize) -> f64 {
    let near = data.recordings.around(k, SPEED_HALF_WIDTH);
    let travel = data.counts[near.end - 1] - data.counts[near.start];
    // On the edge of a cell the reading of a shaft at rest may change by one.
    if travel.abs() > 1.0 {
        travel.signum()
    } else {
        0.0
    }
}

/// A sampled signal through the filter of [`equation_residuals`].
pub fn filtered_values(data: &Data, time: f64, signal: &[f64]) -> Vec<f64> {
    let filtered = filtered(data, time, signal, false);
    filtered.iter().map(|f| f.value).collect()
}

/// The volts that the model's equation leaves unexplained along the measured motion, filtered with
/// `time` (s); samples with the bridge open, just closed, or held by friction are left out.
pub fn equation_residuals(data: &Data, candidate: &Candidate, time: f64) -> Vec<EquationResidual> {
    let mut residuals = Vec::with_capacity(data.len());
    each_equation_residual(data, candidate, time, |left| residuals.push(left));
    residuals
}

/// The same, one after the other.
fn each_equation_residual(
    data: &Data,
    candidate: &Candidate,
    time: f64,
    mut each: impl FnMut(EquationResidual),
) {
    let radians = core::f64::consts::TAU / data.units.counts_per_rev;
    let angle = |k: usize| (data.centre(k) - data.centre(0)) * radians;
    let lowered = Lowered::<f64>::new(&candidate.effects, &data.units);
    // What the effects leave of the drive, less what they take from it.
    let net = |k: usize| {
        let turns = (data.centre(k) / data.units.counts_per_rev).rem_euclid(1.0);
        // As it is now: what passes the filter below must not be late before.
        let speed = data.rate_of(&data.counts, k, SPEED_HALF_WIDTH) * radians;
        let drive = lowered.drive(data.command[k]);
        let current = drive - candidate.machine.kb * speed / data.units.volts;
        let mut shaft = Shaft {
            volts: drive,
            temperature: data.temperature(k),
            ..Shaft::at(turns, speed / data.units.speed, current)
        };
        let torque = lowered.torque(&shaft, &Default::default());
        shaft.transmitted = current + torque;
        let budget = lowered.friction(&shaft);
        let friction = budget.moving * shaft.speed.signum() + budget.bias;
        (drive - torque - friction) * data.units.volts
    };
    let command = |k: usize| data.command[k] * data.units.volts;
    let mut passing_angle = Passing::new(data, time, false);
    let mut passing_net = Passing::new(data, time, true);
    let mut passing_command = Passing::new(data, time, true);
    let holds = candidate
        .effects
        .iter()
        .any(|(kind, _)| kind.description().place == Place::Friction);
    let m = &candidate.machine;
    let [total, second, third] = motor_coefficients(m);
    let mut closed_since = 0.0;
    let (mut direction, mut slid_since) = (0.0, 0.0);
    let mut net_now = if data.is_empty() { 0.0 } else { net(0) };
    for k in 0..data.len() {
        let next = (k + 1 < data.len()).then_some(k + 1);
        let net_next = next.map(net);
        let f = passing_angle.at(k, angle(k), next.map(angle));
        let net = passing_net.at(k, net_now, net_next);
        let command = passing_command.at(k, command(k), next.map(command));
        net_now = net_next.unwrap_or(net_now);
        if data.recordings.is_first(k) {
            (closed_since, direction) = (data.time_s[k], 0.0);
        }
        let sliding = sliding(data, k);
        if sliding == 0.0 || sliding != direction {
            (direction, slid_since) = (sliding, data.time_s[k]);
        }
        if data.is_open(k) {
            closed_since = data.time_s[k];
        } else if data.time_s[k] - closed_since > MEMORY * time {
            // At rest friction is whatever holds the shaft: the equation says nothing of it.
            if holds && data.time_s[k] - slid_since < MEMORY * time {
                continue;
            }
            each(EquationResidual {
                sample: k,
                volts: net.value - total * f.rate - second * f.acceleration - third * f.jerk,
                angle: f.value,
                speed: f.rate,
                command: command.value,
                acceleration: f.acceleration,
            });
        }
    }
}
