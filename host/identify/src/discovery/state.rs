//! The state of a hysteresis along the measured motion.

use super::motion::Motion;

/// `z' = (w - |w|*z)/distance` from zero, as its mean over each interval.
pub fn along(motion: &Motion, distance: f64) -> Vec<f64> {
    let mut now = 0.0;
    let pairs = motion.speed.iter().zip(&motion.seconds);
    pairs
        .map(|(&speed, &seconds)| {
            let parts = speed.abs() * seconds / distance;
            if parts == 0.0 {
                return now;
            }
            let left: f64 = now - speed.signum();
            let mean = speed.signum() - left * libm::expm1(-parts) / parts;
            now = speed.signum() + left * libm::exp(-parts);
            mean
        })
        .collect()
}
