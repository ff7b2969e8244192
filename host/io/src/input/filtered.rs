//! Speeds that a controller has filtered before it logs them: as a moving average, or through a first-order lag. The filter is undone before
//! the speed is integrated, so that neither inertia nor delay contain it.
//!
//! Which filter it is the motion tells: of a motor that is driven by the command the next speed follows from the last one, the command and the
//! sign of the speed, and best so once the filter is undone.

use nalgebra::{Matrix4, Vector4};

/// Longest moving average that is looked for, samples.
const LONGEST: usize = 64;
/// Shares of the new value in a first-order lag.
const SHARES: usize = 40;
/// A filter is told where the next speed follows so much better once it is undone: part of the RMS error that is left.
const BETTER: f64 = 0.3;
/// Fewest samples that tell a filter.
const FEWEST: usize = 200;

/// A filter that was undone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Filter {
    /// A moving average over so many samples.
    Average(usize),
    /// A first-order lag that takes this share of each new value.
    Lag(f64),
}

impl Filter {
    /// By how many samples it is late.
    pub(super) fn delay_samples(self) -> f64 {
        match self {
            Filter::Average(samples) => 0.5 * (samples as f64 - 1.0),
            Filter::Lag(share) => (1.0 - share) / share,
        }
    }

    fn undone(self, filtered: &[f64]) -> Vec<f64> {
        match self {
            Filter::Average(length) => {
                let mut speeds = Vec::with_capacity(filtered.len());
                for k in 0..filtered.len() {
                    let rise = filtered[k] - filtered[k.saturating_sub(1)];
                    let left = match k.checked_sub(length) {
                        Some(place) => speeds[place],
                        None => filtered[0],
                    };
                    speeds.push(left + length as f64 * rise);
                }
                speeds
            }
            Filter::Lag(share) => {
                let pairs = (0..filtered.len()).map(|k| {
                    let before = filtered[k.saturating_sub(1)];
                    before + (filtered[k] - before) / share
                });
                pairs.collect()
            }
        }
    }
}

/// Undoes the filter of speeds that were sampled evenly beside their commands; `None` where they show none.
pub(super) fn unfiltered(speeds: &mut [f64], command: &[f64]) -> Option<Filter> {
    if speeds.len() < FEWEST {
        return None;
    }
    let raw = error(speeds, command)?;
    let averages = (2..=LONGEST).map(Filter::Average);
    let lags = (1..SHARES).map(|k| Filter::Lag(k as f64 / SHARES as f64));
    let tried = averages.chain(lags).filter_map(|filter| {
        let undone = filter.undone(speeds);
        let error = error(&undone, command)?;
        Some((error, filter, undone))
    });
    let (least, filter, undone) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if least > BETTER * raw {
        return None;
    }
    speeds.copy_from_slice(&undone);
    Some(filter)
}

/// RMS error of the next speed as it follows from the last one, the command, the sign of the speed and a constant; as a part of the speed's
/// own change, so that a filter gains nothing by making all small.
fn error(speeds: &[f64], command: &[f64]) -> Option<f64> {
    let mut products = Matrix4::zeros();
    let mut right = Vector4::zeros();
    let (mut all, mut rows) = (0.0, 0usize);
    let row = |k: usize| {
        let sign = if speeds[k] == 0.0 {
            0.0
        } else {
            speeds[k].signum()
        };
        // A speed in an interval is driven by the command at its beginning.
        Vector4::new(speeds[k], command[k], sign, 1.0)
    };
    let moving = |k: &usize| speeds[*k] != 0.0 && speeds[k + 1] != 0.0;
    let used = || (0..speeds.len() - 1).filter(moving);
    for k in used() {
        let (row, change) = (row(k), speeds[k + 1] - speeds[k]);
        products += row * row.transpose();
        right += row * change;
        all += change * change;
        rows += 1;
    }
    if rows < FEWEST / 2 || all == 0.0 {
        return None;
    }
    let solution = products.try_inverse()? * right;
    let left: f64 = used()
        .map(|k| (speeds[k + 1] - speeds[k] - row(k).dot(&solution)).powi(2))
        .sum();
    Some((left / all).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motor with Coulomb friction under steps of its command: speeds and commands.
    fn motor() -> (Vec<f64>, Vec<f64>) {
        let (mut speed, mut level, mut seed) = (0.0f64, 0.0, 12_345u32);
        let (mut speeds, mut commands) = (Vec::new(), Vec::new());
        for k in 0..2000 {
            if k % 37 == 0 {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                level = f64::from(seed >> 8) / f64::from(1 << 23) * 12.0 - 12.0;
            }
            speeds.push(speed);
            commands.push(level);
            let driven = speed + 0.05 * (18.0 * level - speed);
            let friction = 0.8f64.min(driven.abs());
            speed = driven - friction * driven.signum();
        }
        (speeds, commands)
    }

    fn average(values: &[f64], length: usize) -> Vec<f64> {
        let mean = |k: usize| {
            let from = (k + 1).saturating_sub(length);
            let missing = (length - (k + 1 - from)) as f64;
            (values[from..=k].iter().sum::<f64>() + missing * values[0]) / length as f64
        };
        (0..values.len()).map(mean).collect()
    }

    #[test]
    fn filters_are_told_and_undone() {
        let (speeds, commands) = motor();
        for length in [4, 12, 30] {
            let mut filtered = average(&speeds, length);
            let found = unfiltered(&mut filtered, &commands);
            assert_eq!(found, Some(Filter::Average(length)));
            let worst = filtered.iter().zip(&speeds).map(|(a, b)| (a - b).abs());
            assert!(worst.fold(0.0, f64::max) < 1e-6, "{length}");
        }
        let mut lagged = Vec::new();
        for speed in &speeds {
            let before = lagged.last().copied().unwrap_or(0.0);
            lagged.push(before + 0.25 * (speed - before));
        }
        assert_eq!(unfiltered(&mut lagged, &commands), Some(Filter::Lag(0.25)));
    }

    #[test]
    fn a_speed_without_a_filter_is_left_alone() {
        let (speeds, commands) = motor();
        let mut own = speeds.clone();
        assert_eq!(unfiltered(&mut own, &commands), None);
        let mut rounded: Vec<f64> = speeds.iter().map(|speed| speed.round()).collect();
        assert_eq!(unfiltered(&mut rounded, &commands), None);
        assert_eq!(own, speeds);
    }
}
