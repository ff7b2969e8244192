//! What the values of a column tell: whether it may be a channel, and in which unit.

use super::cell::switch_word;
use super::direction::is_halt;
use super::names::parts;
use super::profile::Profile;
use crate::channel::Channel;
use crate::median::median;
use std::f64::consts::TAU;

/// Times between samples of a motor's log, s.
const INTERVAL_S: [f64; 2] = [2e-5, 0.25];
/// A supply varies by no more than this.
const SUPPLY: f64 = 4.0;
/// Counts per revolution that encoders have.
const COUNTS: [f64; 2] = [8.0, 2e7];
/// Whole numbers are as near to one.
const WHOLE: f64 = 0.02;
/// The range of a target and that of what follows it differ by no more than this factor.
const ALIKE: f64 = 3.0;

/// Whether a column may hold a channel, by its values alone.
pub(super) fn is_plausible(channel: Channel, profile: &Profile) -> bool {
    let Some([least, greatest]) = profile.range() else {
        return match channel {
            Channel::Time => profile.dates > 0,
            Channel::Direction => is_two_words(profile),
            Channel::Enabled => {
                profile.words.len() <= 2
                    && profile.words.iter().all(|word| switch_word(word).is_some())
            }
            _ => false,
        };
    };
    let range = channel.facts().range;
    let within = least >= range[0] && greatest <= range[1];
    match channel {
        Channel::Time => profile.is_rising(),
        Channel::Command => profile.is_number() && !profile.is_constant() && !profile.is_rising(),
        Channel::Angle => profile.is_number() && !profile.is_constant(),
        Channel::Measured(crate::channel::Measured::Supply) => {
            within && greatest < SUPPLY * least && !profile.is_rising()
        }
        Channel::Measured(_) => profile.is_number() && within && !profile.is_rising(),
        Channel::Enabled => within && profile.is_whole(),
        Channel::Direction => {
            let levels = profile.levels(2);
            profile.is_whole() && within && levels.is_some_and(|levels| levels.len() == 2)
        }
    }
}

/// Whether a column has two words, and perhaps one for a halt.
fn is_two_words(profile: &Profile) -> bool {
    let moving = profile.words.iter().filter(|word| !is_halt(word));
    moving.count() == 2 && profile.words.len() <= 3 && profile.dates == 0
}

/// The unit of a time without one: the largest for which its steps are those of a motor's log; none for seconds.
pub(super) fn time_unit(profile: &Profile) -> Option<&'static str> {
    let steps = profile.first.windows(2).map(|pair| pair[1] - pair[0]);
    let usual = median(steps.filter(|step| *step > 0.0).collect())?;
    let in_range = |per: f64| (INTERVAL_S[0]..=INTERVAL_S[1]).contains(&(usual / per));
    if in_range(1.0) && !profile.is_whole() {
        return None;
    }
    let units = [("ms", 1e3), ("us", 1e6), ("ns", 1e9)];
    let mut fitting = units.into_iter().filter(|(_, per)| in_range(*per));
    fitting.next().map(|(unit, _)| unit)
}

/// The unit of a command that its values and its name tell, none for volts; and whether that is sure.
pub(super) fn command_unit(name: &str, profile: &Profile) -> (Option<&'static str>, bool) {
    let words = parts(name);
    let is = |word: &str| words.iter().any(|part| part.contains(word));
    let largest = profile.largest();
    let is_share = is("pwm")
        || is("duty")
        || is("tastgrad")
        || is("throttle")
        || is("ciclo")
        || is("tastverh");
    if !is_share {
        return (None, largest <= 1000.0);
    }
    if largest <= 1.05 {
        return (Some("duty"), !profile.is_whole() || !is("pwm"));
    }
    if !profile.is_whole() {
        return (Some("percent"), largest <= 105.0);
    }
    match largest {
        x if x <= 105.0 => (Some(if is("pwm") { "pwm8" } else { "percent" }), false),
        x if x <= 267.0 => (Some("pwm8"), true),
        x if x <= 1074.0 => (Some("pwm10"), true),
        _ => (None, false),
    }
}

/// The unit of an angle and its counts per revolution, told by its smallest step: a turn in degrees, radians or revolutions is a whole
/// number of it. None where it is whole counts, or no plain part of a turn.
pub(super) fn angle_step(profile: &Profile) -> Option<(&'static str, f64)> {
    let least = profile.least_step.filter(|_| !profile.is_whole())?;
    let steps = profile
        .first
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs());
    let near: Vec<f64> = steps
        .filter(|step| *step >= 0.5 * least && *step < 1.5 * least)
        .collect();
    let mean = near.iter().sum::<f64>() / near.len().max(1) as f64;
    let counts =
        [("deg", 360.0), ("rad", TAU), ("rev", 1.0)].map(|(unit, turn)| (unit, turn / mean));
    let mut fitting = counts.into_iter().filter(|(_, counts)| {
        let round = usual_counts(*counts);
        (COUNTS[0]..=COUNTS[1]).contains(counts) && round.is_some()
    });
    let first = fitting.next()?;
    let alone = fitting.next().is_none();
    alone.then(|| (first.0, usual_counts(first.1).unwrap_or(first.1)))
}

/// The counts that encoders have nearest to a number: a power of two, or four times a round number of lines.
fn usual_counts(counts: f64) -> Option<f64> {
    let power = 2f64.powf(counts.log2().round());
    if (counts / power - 1.0).abs() < 0.005 {
        return Some(power);
    }
    let lines = [
        100.0, 120.0, 128.0, 200.0, 250.0, 256.0, 300.0, 360.0, 400.0, 500.0, 512.0, 600.0, 720.0,
        1000.0, 1250.0, 2000.0, 2500.0, 5000.0,
    ];
    let near = |lines: &f64| (counts / (4.0 * lines) - 1.0).abs() < WHOLE / 4.0;
    lines.iter().copied().find(near).map(|lines| 4.0 * lines)
}

/// Whether a measured quantity may follow a target: their ranges overlap, and are alike.
pub(super) fn follows(measured: &Profile, target: &Profile) -> bool {
    let (Some([low, high]), Some([from, to])) = (measured.range(), target.range()) else {
        return false;
    };
    let overlap = high.min(to) - low.max(from);
    let spans = [high - low, to - from];
    spans.iter().all(|span| *span > 0.0)
        && overlap > 0.3 * spans[0].min(spans[1])
        && spans[0] < ALIKE * spans[1]
        && spans[1] < ALIKE * spans[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn profile(values: impl Iterator<Item = f64>) -> Profile {
        let mut profile = Profile::default();
        values.for_each(|value| profile.take(value));
        profile
    }

    #[test]
    fn the_unit_of_a_time_is_told_by_its_steps() {
        for (step, wanted) in [
            (0.001, None),
            (5.0, Some("ms")),
            (1000.0, Some("us")),
            (1e6, Some("ns")),
        ] {
            let times = profile((0..100).map(|k| step * f64::from(k)));
            assert_eq!(time_unit(&times), wanted, "{step}");
        }
    }

    #[test]
    fn the_unit_of_an_angle_and_its_counts_are_told_by_its_least_step() {
        for (turn, counts, unit, digits) in [
            (360.0, 4096.0, "deg", 4),
            (360.0, 1024.0, "deg", 3),
            (TAU, 2048.0, "rad", 6),
            (1.0, 8192.0, "rev", 6),
            (360.0, 2000.0, "deg", 2),
        ] {
            let round = |x: f64| (x * 10f64.powi(digits)).round() / 10f64.powi(digits);
            let swing = |k: u32| (300.0 * libm::sin(0.01 * f64::from(k))).round();
            let angles = profile((0..2000).map(|k| round(swing(k) * turn / counts)));
            assert_eq!(angle_step(&angles), Some((unit, counts)), "{unit} {counts}");
        }
        assert_eq!(angle_step(&profile((0..100).map(f64::from))), None);
    }
}
