//! Speeds that a controller has filtered before it logs them: as a moving average, or through a first-order lag. The filter is undone before
//! the speed is integrated, so that neither inertia nor delay contain it.
//!
//! Which filter it is the motion tells: of a motor that is driven by the command the next speed follows from the last one, the command and the
//! sign of the speed. Behind a filter it follows from both as they come out of the same filter.
//!
//! An average of speeds that were rounded or measured afterwards cannot be undone, since each rounding would stay for ever. The command is
//! averaged likewise then: a filter behind a linear system acts as one before it.

use nalgebra::{Matrix4, Vector4};

/// Longest moving average that is looked for, samples.
const LONGEST: usize = 64;
/// Shares of the new value in a first-order lag: so many are tried at first.
const SHARES: usize = 40;
/// Steps by which the best of them is refined: to a hundred-thousandth.
const SECTIONS: usize = 16;
/// A filter is told where the next speed follows so much better once it is undone: part of the RMS error that is left.
const BETTER: f64 = 0.3;
/// A shorter delay than this, samples, is as well that of the winding, whose lag a speed has too.
const SHORTEST: f64 = 0.5;
/// Fewest samples that tell a filter.
const FEWEST: usize = 200;
/// Samples of a longer recording by which it is told, from where the motor first moves: two hundred filters are tried on each.
const MOST: usize = 50_000;

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

/// How a filter was taken into account.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// The speeds are those before the filter.
    Undone,
    /// The command went through the filter as well.
    CommandToo,
}

/// Undoes the filter of speeds that were sampled evenly beside their commands, or averages the commands likewise; `None` where they show no
/// filter.
pub(super) fn unfiltered(speeds: &mut [f64], command: &mut [f64]) -> Option<(Filter, Way)> {
    let first = speeds.iter().position(|speed| *speed != 0.0)?;
    let from = first.min(speeds.len().saturating_sub(MOST));
    let tell = from..speeds.len().min(from + MOST);
    let (filter, way) = told(&speeds[tell.clone()], &command[tell])?;
    match (way, filter) {
        (Way::CommandToo, Filter::Average(length)) => {
            command.copy_from_slice(&averaged(command, length));
        }
        _ => speeds.copy_from_slice(&filter.undone(speeds)),
    }
    Some((filter, way))
}

/// The filter that speeds show beside their commands.
fn told(speeds: &[f64], command: &[f64]) -> Option<(Filter, Way)> {
    if speeds.len() < FEWEST {
        return None;
    }
    let signs: Vec<f64> = speeds.iter().map(|speed| sign(*speed)).collect();
    let raw = error(speeds, command, &signs)?;
    let lengths = 2..=LONGEST;
    let undone = |filter: Filter| {
        let error = error_undone(&filter.undone(speeds), command)?;
        Some((error, filter, Way::Undone))
    };
    let command_too = |length: usize| {
        let signs = averaged(&ahead(&signs, (length - 1) / 2), length);
        let error = error(speeds, &averaged(command, length), &signs)?;
        Some((error, Filter::Average(length), Way::CommandToo))
    };
    let tried = (lengths.clone().map(Filter::Average)).filter_map(undone);
    let tried = tried.chain(lengths.filter_map(command_too));
    let tried = tried.chain(least_lag(&|share| Some(undone(Filter::Lag(share))?.0)));
    let tried = tried.chain(least_lag(&|share| {
        let undone = Filter::Lag(share).undone(speeds);
        let signs: Vec<f64> = undone.into_iter().map(sign).collect();
        error(speeds, &lagged(command, share), &lagged(&signs, share))
    }));
    let (least, filter, way) = tried.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let is_told = least <= BETTER * raw && filter.delay_samples() >= SHORTEST;
    is_told.then_some((filter, way))
}

/// The first-order lag that leaves the least error: the best of a grid, and then between its neighbours by golden section.
fn least_lag(error: &dyn Fn(f64) -> Option<f64>) -> Option<(f64, Filter, Way)> {
    let of_share = |share: f64| Some((error(share)?, share));
    let grid = (1..SHARES).filter_map(|k| of_share(k as f64 / SHARES as f64));
    let mut best = grid.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let (mut low, mut high) = (best.1 - 1.0 / SHARES as f64, best.1 + 1.0 / SHARES as f64);
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..SECTIONS {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        let (at_left, at_right) = (of_share(left)?, of_share(right)?);
        let better = if at_left.0 < at_right.0 {
            high = right;
            at_left
        } else {
            low = left;
            at_right
        };
        if better.0 < best.0 {
            best = better;
        }
    }
    Some((best.0, Filter::Lag(best.1), Way::Undone))
}

/// The mean of the last values, and of the first one before there were so many.
fn averaged(values: &[f64], length: usize) -> Vec<f64> {
    let Some(first) = values.first() else {
        return Vec::new();
    };
    let mut sum = first * length as f64;
    let mean = values.iter().enumerate().map(|(k, value)| {
        sum += value - k.checked_sub(length).map_or(first, |place| &values[place]);
        sum / length as f64
    });
    mean.collect()
}

/// Values behind a lag that takes this share of each new one.
fn lagged(values: &[f64], share: f64) -> Vec<f64> {
    let mut before = values.first().copied().unwrap_or(0.0);
    let each = values.iter().map(|value| {
        before += share * (value - before);
        before
    });
    each.collect()
}

/// Values as they will be some samples later.
fn ahead(values: &[f64], samples: usize) -> Vec<f64> {
    let last = values.len().saturating_sub(1);
    (0..values.len())
        .map(|k| values[(k + samples).min(last)])
        .collect()
}

fn sign(speed: f64) -> f64 {
    if speed == 0.0 { 0.0 } else { speed.signum() }
}

/// The error of speeds before a filter.
fn error_undone(speeds: &[f64], command: &[f64]) -> Option<f64> {
    let signs: Vec<f64> = speeds.iter().map(|speed| sign(*speed)).collect();
    error(speeds, command, &signs)
}

/// RMS error of the next speed as it follows from the last one, the command, the sign of the speed and a constant; as a part of the speed's
/// own change, so that a filter gains nothing by making all small.
fn error(speeds: &[f64], command: &[f64], signs: &[f64]) -> Option<f64> {
    let mut products = Matrix4::zeros();
    let mut right = Vector4::zeros();
    let (mut all, mut rows) = (0.0, 0usize);
    // A speed in an interval is driven by the command at its beginning.
    let row = |k: usize| Vector4::new(speeds[k], command[k], signs[k], 1.0);
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

    #[test]
    fn filters_are_told_and_undone() {
        let (speeds, mut commands) = motor();
        for length in [4, 12, 30] {
            let mut filtered = averaged(&speeds, length);
            let found = unfiltered(&mut filtered, &mut commands);
            assert_eq!(found, Some((Filter::Average(length), Way::Undone)));
            let worst = filtered.iter().zip(&speeds).map(|(a, b)| (a - b).abs());
            assert!(worst.fold(0.0, f64::max) < 1e-6, "{length}");
        }
        for share in [0.25, 0.0392] {
            let mut filtered = lagged(&speeds, share);
            let Some((Filter::Lag(found), Way::Undone)) = unfiltered(&mut filtered, &mut commands)
            else {
                panic!("no lag at {share}");
            };
            assert!((found / share - 1.0).abs() < 0.1, "{found} for {share}");
        }
    }

    #[test]
    fn averages_of_rounded_speeds_are_told_and_the_command_is_averaged() {
        let (speeds, commands) = motor();
        for (length, digit) in [(4, 0.01), (12, 0.1), (12, 0.5)] {
            let rounded = averaged(&speeds, length);
            let mut rounded: Vec<f64> = rounded
                .iter()
                .map(|x| (x / digit).round() * digit)
                .collect();
            let (before, mut own) = (rounded.clone(), commands.clone());
            let found = unfiltered(&mut rounded, &mut own);
            assert_eq!(
                found,
                Some((Filter::Average(length), Way::CommandToo)),
                "{digit}"
            );
            assert_eq!(rounded, before);
            assert_eq!(own, averaged(&commands, length));
        }
    }

    #[test]
    fn a_speed_without_a_filter_is_left_alone() {
        let (speeds, mut commands) = motor();
        let mut own = speeds.clone();
        assert_eq!(unfiltered(&mut own, &mut commands), None);
        let mut rounded: Vec<f64> = speeds.iter().map(|speed| speed.round()).collect();
        assert_eq!(unfiltered(&mut rounded, &mut commands), None);
        assert_eq!(own, speeds);
    }
}
