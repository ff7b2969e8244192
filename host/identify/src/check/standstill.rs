//! A reading that stands still although the motor is driven: friction, a weight or a stop holds it, or the encoder is stuck.

use super::{Finding, Severity};
use servoid_io::recording::Recording;

/// Samples so far apart may be of a log in milliseconds, s.
const MAY_BE_MS: f64 = 0.1;
/// A motor that reads the same for so long stands still, s.
const STILL_S: f64 = 0.2;
/// Time without a change of sign under such a drive that must move a free motor, s.
const DRIVEN_S: f64 = 0.05;
/// Commands above this part of the largest one must move a free motor.
const STRONG: f64 = 0.5;
/// A motor that stops from this part of its fastest step within one sample was not stopped by any torque.
const SUDDEN: f64 = 0.5;

pub(super) fn findings(recording: &Recording) -> Vec<Finding> {
    let Some(still) = driven_standstill(recording) else {
        return Vec::new();
    };
    let interval = recording.median_interval_s();
    if interval >= MAY_BE_MS {
        return vec![Finding::new(
            "time_unit",
            Severity::Refusal,
            format!(
                "samples are {interval:.3} s apart, {:.0} s in all",
                recording.duration_s()
            ),
            "time looks like milliseconds taken for seconds; say --unit time=ms (or us), or time = \"ms\" under [units] in \
             motor.toml",
        )];
    }
    let from_to = format!("from {:.3} to {:.3} s", still.from_s, still.to_s);
    let driven = format!("{:.2} {} and more", still.least, recording.drive.symbol());
    vec![if still.sudden {
        Finding::new(
            "stuck_encoder",
            Severity::Warning,
            format!(
                "the encoder is stuck {from_to}: it stops or starts at full speed within one sample while {driven} are commanded"
            ),
            "only a hard stop does that; check the encoder, and cut that part out",
        )
    } else {
        Finding::new(
            "driven_standstill",
            Severity::Remark,
            format!("the motor stands still {from_to} while {driven} are commanded"),
            "friction, a weight or a stop holds it there; if none does, the encoder was stuck",
        )
    }]
}

struct Standstill {
    from_s: f64,
    to_s: f64,
    /// The least command in it.
    least: f64,
    sudden: bool,
}

/// A stretch in which the reading never changes under commands as strong as those that usually move the motor.
fn driven_standstill(recording: &Recording) -> Option<Standstill> {
    let closed = |k: usize| recording.enabled.as_ref().is_none_or(|on| on[k]);
    let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
    let counts = &recording.counts;
    let mut moving: Vec<f64> = (1..recording.len())
        .filter(|&k| counts[k] != counts[k - 1])
        .map(|k| recording.command[k - 1].abs())
        .collect();
    if moving.is_empty() {
        return None;
    }
    let middle = moving.len() / 2;
    let usual = *moving.select_nth_unstable_by(middle, f64::total_cmp).1;
    // As long as the recording, and so are the steps.
    drop(moving);
    let strong = usual.max(STRONG * largest);
    let mut steps: Vec<f64> = counts.windows(2).map(|p| (p[1] - p[0]).abs()).collect();
    let place = steps.len() * 95 / 100;
    let (_, fast, _) = steps.select_nth_unstable_by(place, f64::total_cmp);
    let fast = fast.max(1.0);
    drop(steps);
    let mut begin = 0;
    for k in 1..=recording.len() {
        if k < recording.len() && counts[k] == counts[begin] {
            continue;
        }
        let still = begin..k;
        let seconds = recording.time_s[k - 1] - recording.time_s[begin];
        begin = k;
        if seconds < STILL_S {
            continue;
        }
        let driven = |&k: &usize| closed(k) && recording.command[k].abs() >= strong;
        if longest_s(recording, still.clone().filter(driven)) < DRIVEN_S {
            continue;
        }
        let at = |k: usize| recording.time_s[k] - recording.time_s[0];
        let step = |k: usize| (k > 0).then(|| (counts[k] - counts[k - 1]).abs());
        let leap = |k: usize| step(k).is_some_and(|step| step > 1.0 && step >= SUDDEN * fast);
        return Some(Standstill {
            from_s: at(still.start),
            to_s: at(k - 1),
            least: strong,
            sudden: leap(still.start) || (k < recording.len() && leap(k)),
        });
    }
    None
}

/// The longest time for which the command keeps its sign over neighbouring ones of these samples, s.
fn longest_s(recording: &Recording, samples: impl Iterator<Item = usize>) -> f64 {
    let sign = |k: usize| recording.command[k].signum();
    let mut longest = 0.0f64;
    let mut run: Option<(usize, usize)> = None;
    for k in samples {
        let on = run.filter(|&(_, last)| last + 1 == k && sign(last) == sign(k));
        let from = on.map_or(k, |(from, _)| from);
        longest = longest.max(recording.time_s[k] - recording.time_s[from]);
        run = Some((from, k));
    }
    longest
}
