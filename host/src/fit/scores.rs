//! Errors of a fitted model, in the several ways that people measure them.

use super::filter::filtered;
use super::physical::Estimate;
use super::{Options, SPEED_HALF_WIDTH};
use crate::error::Error;
use crate::problem::cost::{Horizon, errors};
use crate::problem::simulate::Method;
use crate::problem::{Candidate, Data, StartAngle};
use crate::recording::Drive;
use shared::cost::Cost;
use shared::effects::{Lowered, Shaft};

/// Filter time of the equation error, sample intervals.
const EQUATION_FILTER_SAMPLES: f64 = 5.0;

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
    let windows = Horizon::windows(data, window_s, SPEED_HALF_WIDTH);
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
    let centre = data.centre(0) - data.counts[0];
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
    let radians = core::f64::consts::TAU / data.units.counts_per_rev;
    let angle: Vec<f64> = (0..data.len())
        .map(|k| (data.centre(k) - data.centre(0)) * radians)
        .collect();
    let motion = filtered(data, time, &angle, false);
    let lowered = Lowered::<f64>::new(&candidate.effects, &data.units);
    // What the effects leave of the drive, less what they take from it.
    let net: Vec<f64> = (0..data.len())
        .map(|k| {
            let shaft = Shaft {
                turns: (data.centre(k) / data.units.counts_per_rev).rem_euclid(1.0),
                speed: motion[k].rate / data.units.speed,
                current: 0.0,
            };
            let friction = lowered.friction(&shaft).moving * shaft.speed.signum();
            let drive = lowered.drive(data.command[k], &shaft);
            (drive - lowered.torque(&shaft) - friction) * data.units.volts
        })
        .collect();
    let command: Vec<f64> = data.command.iter().map(|v| v * data.units.volts).collect();
    let (net, command) = (
        filtered(data, time, &net, true),
        filtered(data, time, &command, true),
    );
    let m = &candidate.machine;
    let (total, second) = (m.kb + m.damping, m.inertia + m.electrical * m.damping);
    let third = m.electrical * m.inertia;
    let (mut wrong, mut driven, mut closed_since) = (0.0, 0.0, 0.0);
    for k in 0..data.len() {
        if data.is_open(k) {
            closed_since = data.time_s[k];
        } else if data.time_s[k] - closed_since > 6.0 * time {
            let f = &motion[k];
            let needed = total * f.rate + second * f.acceleration + third * f.jerk;
            wrong += (needed - net[k].value).powi(2);
            driven += command[k].value.powi(2);
        }
    }
    (driven > 0.0).then(|| (wrong / driven).sqrt())
}

/// Resistance from a measured current, Ω: the model's `R·i` regressed on the measured `i` with a
/// free zero.
pub fn resistance(data: &Data, candidate: &Candidate) -> Option<Estimate> {
    let current = data
        .current_a
        .as_ref()
        .filter(|_| data.drive == Drive::Voltage)?;
    let machine = &candidate.machine;
    if machine.electrical > 20.0 * data.units.interval || data.len() < 50 {
        return None;
    }
    // R·i = m·dω/dt + b·ω + torques; with the electrics settled, R·i = v − Kb·ω, which needs only
    // the speed. Take it in the middle of intervals whose voltage was held long enough.
    let settle = (5.0 * machine.electrical / data.units.interval).ceil() as usize + 1;
    let mut rows = Vec::new();
    let mut held = 0;
    for (k, &amperes) in current.iter().enumerate().skip(1) {
        let steady = data.command[k] == data.command[k - 1] && !data.is_open(k);
        held = if steady { held + 1 } else { 0 };
        if held >= settle {
            let speed = data.speed_counts_s(k, SPEED_HALF_WIDTH) / data.units.counts_per_rev
                * core::f64::consts::TAU;
            let volts = data.command[k] * data.units.volts;
            rows.push((amperes, volts - machine.kb * speed));
        }
    }
    let n = rows.len() as f64;
    if rows.len() < 20 {
        return None;
    }
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| rows.iter().map(f).sum::<f64>() / n;
    let (mi, mv) = (mean(&|r| r.0), mean(&|r| r.1));
    let sii: f64 = rows.iter().map(|r| (r.0 - mi).powi(2)).sum();
    let siv: f64 = rows.iter().map(|r| (r.0 - mi) * (r.1 - mv)).sum();
    let slope = siv / sii;
    let left: f64 = rows
        .iter()
        .map(|r| (r.1 - mv - slope * (r.0 - mi)).powi(2))
        .sum();
    // Neighbouring samples share their speed estimate.
    let independent = n / (2 * SPEED_HALF_WIDTH + 1) as f64;
    let std = (left / n / sii * n / independent.max(1.0)).sqrt();
    (slope > 0.0 && slope.is_finite() && std < 0.3 * slope)
        .then_some(Estimate { value: slope, std })
}
