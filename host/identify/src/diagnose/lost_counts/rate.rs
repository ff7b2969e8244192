//! How the losses depend on the speed.

use super::settings::{EARNED, THRESHOLDS};
use crate::diagnose::models::Loss;

/// Share of the travel beyond a threshold that is lost, and that threshold in counts a sample: the most
/// likely for events that come at random, in proportion to the travel beyond it. No threshold unless the
/// events insist on one. `speed` is the travel before each sample, counts.
pub fn share_and_threshold(losses: &[Loss], speed: &[f64]) -> (f64, f64) {
    let fastest = speed.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let beyond =
        |threshold: f64| -> f64 { speed.iter().map(|v| (v.abs() - threshold).max(0.0)).sum() };
    let likelihood = |threshold: f64| -> f64 {
        let total = beyond(threshold);
        losses
            .iter()
            .map(|loss| libm::log((speed[loss.sample].abs() - threshold).max(0.0) / total))
            .sum()
    };
    let none = likelihood(0.0);
    let best = (1..THRESHOLDS)
        .map(|i| fastest * i as f64 / THRESHOLDS as f64)
        .map(|threshold| (threshold, likelihood(threshold)))
        .filter(|(_, likelihood)| *likelihood > none + EARNED)
        .max_by(|a, b| a.1.total_cmp(&b.1));
    let threshold = best.map_or(0.0, |(threshold, _)| threshold);
    let lost: f64 = losses.iter().map(|loss| loss.counts.abs()).sum();
    (lost / beyond(threshold).max(f64::MIN_POSITIVE), threshold)
}
