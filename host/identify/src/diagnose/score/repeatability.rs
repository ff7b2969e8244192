//! How far two runs of one motor under one command part: what the torque that no model knows makes of a free run.

use super::gains::{Covariance, Plant};
use super::noise::Noise;
use super::settings::STEPS;

/// RMS error in counts of a right model's free run over windows of `window_s`, each from the measured state. On recordings with
/// repeats it is within 30 % of what the repeats differ by up to 2 s; over longer times the parameters themselves drift, which no single
/// recording shows.
pub fn repeatability_counts(noise: &Noise, plant: Plant, window_s: f64) -> f64 {
    let mut state = Covariance::known(noise.reading);
    let step = window_s / STEPS as f64;
    let mut squares = 0.0;
    for _ in 0..STEPS {
        state.predict(step, plant.time_constant_s, noise.torque, false);
        squares += state.angle + noise.reading;
    }
    (squares / STEPS as f64).sqrt()
}
