//! What is held out of a fit: another recording, or the end of the only one.

use crate::diagnose::settings::{FITTED_PART, LEAST_S, REST_S};
use servoid_io::recording::Recording;
use std::ops::Range;

/// Parts of the recording between which a rest is looked for, to cut there.
const REST_BETWEEN: Range<f64> = 0.6..0.9;
/// What the held-out errors were measured on.
#[derive(Clone, Debug, PartialEq)]
pub enum HeldOut {
    /// Another recording.
    Recording(String),
    /// The end of the fitted recording.
    End {
        /// The whole recording.
        of: String,
        /// Where it begins, s after the first sample.
        from_s: f64,
        /// Its length, s.
        seconds: f64,
        /// Whether the motor stood still there, at zero command. Else the speed at the cut is fitted, and
        /// commands that were on their way are lost.
        at_rest: bool,
    },
    /// The fitted recording itself: nothing.
    Nothing,
}

impl HeldOut {
    /// Its name in JSON.
    pub fn name(&self) -> &'static str {
        match self {
            HeldOut::Recording(_) => "recording",
            HeldOut::End { .. } => "end",
            HeldOut::Nothing => "nothing",
        }
    }

    /// The whole recording whose end it is.
    pub fn whole(&self) -> Option<&str> {
        match self {
            HeldOut::End { of, .. } => Some(of),
            HeldOut::Recording(_) | HeldOut::Nothing => None,
        }
    }

    /// The other recording, if it is one.
    pub fn source(&self) -> Option<&str> {
        match self {
            HeldOut::Recording(source) => Some(source),
            HeldOut::End { .. } | HeldOut::Nothing => None,
        }
    }
}

/// Cuts the last quarter off, at a rest of the motor near there if it has one: then nothing of the start is
/// unknown. `None` where too little would be left of it.
pub fn cut(recording: &Recording) -> Option<(Recording, Recording, HeldOut)> {
    let length = recording.duration_s();
    let rest = rest(recording, length);
    let from_s = rest.unwrap_or(FITTED_PART * length);
    let (fitted, held_out) = recording.split_at(from_s)?;
    let seconds = held_out.duration_s();
    (seconds >= LEAST_S).then_some((
        fitted,
        held_out,
        HeldOut::End {
            of: recording.source.clone(),
            from_s,
            seconds,
            at_rest: rest.is_some(),
        },
    ))
}

/// Time after the first sample, s, at which the motor has stood still without a command for a while: of all
/// such times the one nearest to [`FITTED_PART`].
fn rest(recording: &Recording, length: f64) -> Option<f64> {
    let start = *recording.time_s.first()?;
    let mut busy = start;
    let mut best: Option<f64> = None;
    let off = |time: f64| (time - FITTED_PART * length).abs();
    for k in 1..recording.len() {
        let now = recording.time_s[k];
        let closed = recording.enabled.as_ref().is_none_or(|on| on[k - 1]);
        let driven = closed && recording.command[k - 1] != 0.0;
        if driven || recording.counts[k] != recording.counts[k - 1] {
            busy = now;
        }
        let time = now - start;
        let rests = now - busy >= REST_S && REST_BETWEEN.contains(&(time / length));
        if rests && best.is_none_or(|best| off(time) < off(best)) {
            best = Some(time);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::channel::Series;
    use servoid_io::recording::Drive;

    /// Ten seconds at 100 Hz that turn all the time but for a rest of `rest` s that begins at `at`.
    fn recording(at: f64, rest: f64) -> Recording {
        let time_s: Vec<f64> = (0..1000).map(|k| k as f64 * 0.01).collect();
        let driven = |t: &f64| *t < at || *t >= at + rest;
        let mut counts = vec![0.0];
        for t in &time_s[1..] {
            let last = counts[counts.len() - 1];
            counts.push(if driven(t) { last + 3.0 } else { last });
        }
        Recording {
            source: "made up".to_owned(),
            command: time_s.iter().map(|t| f64::from(driven(t))).collect(),
            counts,
            measured: Series::NONE,
            enabled: None,
            counts_per_rev: 100.0,
            quantised: true,
            supply_v: None,
            drive: Drive::Voltage,
            position: None,
            time_s,
        }
    }

    #[test]
    fn the_cut_lies_in_a_rest_near_three_quarters_and_loses_no_sample() {
        for (at, rest, cut_at_rest) in [
            (7.0, 0.3, true),
            (8.0, 0.5, true),
            (3.0, 1.0, false),
            (7.5, 0.02, false),
            (20.0, 1.0, false),
        ] {
            let whole = recording(at, rest);
            let (fitted, held_out, kind) = cut(&whole).expect("long enough");
            assert_eq!(fitted.len() + held_out.len(), whole.len());
            assert_eq!(
                [&fitted.counts[..], &held_out.counts[..]].concat(),
                whole.counts
            );
            let HeldOut::End {
                from_s, at_rest, ..
            } = kind
            else {
                panic!("{kind:?}");
            };
            assert_eq!(at_rest, cut_at_rest, "rest of {rest} s at {at} s");
            if at_rest {
                assert!(
                    (at + REST_S..=at + rest + 0.01).contains(&from_s),
                    "{from_s}"
                );
                assert_eq!(held_out.counts[0], fitted.counts[fitted.len() - 1]);
            } else {
                assert!((from_s - 7.5).abs() < 0.02, "{from_s}");
            }
        }
    }

    #[test]
    fn what_is_too_short_is_not_cut() {
        let mut short = recording(20.0, 0.0);
        for t in &mut short.time_s {
            *t *= 0.05;
        }
        assert!(cut(&short).is_none());
    }
}
