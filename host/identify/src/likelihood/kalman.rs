//! The extended Kalman filter: predicts each used reading from those before.

use super::observed::Observed;
use super::parameters::Parameters;
use super::step::{State, Stepper};

/// Standard deviations of an innovation from which the motor has moved otherwise than the model (it sticks, say, and the
/// motor does not): the state becomes uncertain by the innovation, else the filter would never come back.
const GATE: f64 = 6.0;
/// Part of the squared innovation that the gate adds to the variance of the angle.
const GATE_ANGLE: f64 = 0.3;
/// The same for the speed, of the squared innovation over the time since the last reading.
const GATE_SPEED: f64 = 0.03;

/// Innovations of one recording and their variances.
#[derive(Clone, Debug, Default)]
pub(super) struct Innovations {
    /// Reading less prediction, rad.
    pub(super) errors: Vec<f64>,
    /// Their variances, rad².
    pub(super) variances: Vec<f64>,
}

/// Runs the filter. `volts` are the means of the delayed command over the steps, `used` the points whose readings count.
pub(super) fn innovations(
    observed: &Observed,
    used: &[usize],
    volts: &[f64],
    p: &Parameters,
) -> Innovations {
    let stepper = Stepper::new(p, &observed.lengths_s);
    let reading = observed.lsb * observed.lsb / 12.0 + p.reading_noise * p.reading_noise;
    let intensity = (p.process_noise / p.inertia).powi(2);
    let (start_speed, start_error) = observed.start_speed;
    let mut state = State {
        angle: 0.0,
        speed: start_speed,
    };
    // Variances of angle and speed, and their covariance.
    let (mut angle, mut cross, mut speed) = (reading, 0.0, start_error * start_error);
    let mut out = Innovations {
        errors: Vec::with_capacity(used.len()),
        variances: Vec::with_capacity(used.len()),
    };
    let mut from = 0;
    for &to in used {
        let steps = (volts[from + 1..=to].iter()).zip(&observed.length_of[from + 1..=to]);
        for (&volts, &length) in steps {
            let step = stepper.step(state, volts, length);
            state = step.state;
            let ([aa, sa], [av, sv]) = (step.by_angle, step.by_speed);
            let left = [aa * angle + av * cross, aa * cross + av * speed];
            let right = [sa * angle + sv * cross, sa * cross + sv * speed];
            let noise = stepper.noise(length);
            let driven = intensity * step.sliding;
            angle = left[0] * aa + left[1] * av + driven * noise.angle;
            cross = left[0] * sa + left[1] * sv + driven * noise.cross;
            speed = right[0] * sa + right[1] * sv + driven * noise.speed;
        }
        let error = observed.angle[to] - state.angle;
        let variance = angle + reading;
        out.errors.push(error);
        out.variances.push(variance);
        if error * error > GATE * GATE * variance {
            let elapsed = observed.time_s[to] - observed.time_s[from];
            angle += GATE_ANGLE * error * error;
            speed += GATE_SPEED * (error / elapsed).powi(2);
        }
        let total = angle + reading;
        let [by_angle, by_speed] = [angle / total, cross / total];
        state.angle += by_angle * error;
        state.speed += by_speed * error;
        speed -= by_speed * cross;
        cross -= by_angle * cross;
        angle -= by_angle * angle;
        from = to;
    }
    out
}
