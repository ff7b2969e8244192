//! When a driver woke, and the recording without the moments before.

use super::settings::{AS_LIVELY, CURED, FEWEST, OUTLIER, RESTED, WINDOW_S};
use crate::check::{BEGUN, Finding, Severity, begun_s, usual_answer};
use crate::fit::{self, Options, SPEED_HALF_WIDTH};
use servoid_engine::problem::{Data, FitProblem, Horizon, errors, rms_counts};
use servoid_io::recording::Recording;
use shared::effects::Kind;
use std::ops::Range;

/// A driver that woke late.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateDriver {
    /// First sample from which on it drives.
    sample: usize,
    /// The same, s after the first sample.
    pub(super) after_s: f64,
    /// Its error in the first window, counts RMS.
    first: f64,
    /// The greatest of the windows to compare with.
    others: f64,
}

impl LateDriver {
    /// When the driver of a recording woke; `None` where nothing shows that it was late.
    pub fn of(recording: &Recording) -> Option<Self> {
        let counts = &recording.counts;
        let moves = |count: &f64| (count - counts[0]).abs() >= BEGUN;
        let moved = counts.iter().position(moves)?;
        let driven = recording.command[..moved].iter().any(|u| *u != 0.0);
        if moved < RESTED || !driven {
            return None;
        }
        let mut open = recording.clone();
        let closed = open
            .enabled
            .get_or_insert_with(|| vec![true; recording.len()]);
        closed[..moved - 1].fill(false);
        let open = Data::taken(open).ok()?;
        let options = Options {
            effects: vec![Kind::Coulomb],
            window_s: Some(WINDOW_S),
            // A motor that is refused is refused where it is fitted, with the reason.
            force: true,
            ..Options::default()
        };
        let cured = fit::problem(&open, &options).ok()?;
        let as_logged = Data::new(recording).ok()?;
        let (first, others) = first_and_others(&cured, &as_logged)?;
        let (first_cured, _) = first_and_others(&cured, &open)?;
        let sample = wakes(recording, moved);
        (first > OUTLIER * others && first_cured < CURED * first && sample > 0).then(|| {
            LateDriver {
                sample,
                after_s: recording.time_s[sample] - recording.time_s[0],
                first,
                others,
            }
        })
    }

    /// As a recording's finding.
    pub fn finding(&self) -> Finding {
        Finding::new(
            "late_driver",
            Severity::Remark,
            format!(
                "the driver wakes {:.0} ms after the log begins: it drives no motion before, and a linear motor with friction misses the \
                 first {WINDOW_S} s by {:.0} counts RMS, other starts and reversals by {:.0} at most",
                1e3 * self.after_s,
                self.first,
                self.others
            ),
            "fits and diagnoses leave these moments out; start the log once the driver is on",
        )
    }

    /// As a remark on a recording among others.
    pub fn remark(&self, recording: &Recording) -> String {
        format!("{}: {}", recording.source, self.finding().text())
    }

    /// The span without the moments before, s after the first sample.
    pub fn span_s(&self, recording: &Recording) -> [f64; 2] {
        let last = recording.time_s.last().copied().unwrap_or_default();
        [self.after_s, last - recording.time_s[0]]
    }

    /// The recording without the moments before.
    pub fn cut(&self, recording: &Recording) -> Recording {
        recording.samples(self.sample..recording.len())
    }
}

/// Cuts the first moments of late drivers off; returns a remark on each.
pub fn cut_late_drivers(recordings: &mut [Recording]) -> Vec<String> {
    let mut remarks = Vec::new();
    for recording in recordings {
        if let Some(late) = LateDriver::of(recording) {
            remarks.push(late.remark(recording));
            *recording = late.cut(recording);
        }
    }
    remarks
}

/// First sample from which on the driver drives: as long before the motion begins as at the other starts.
fn wakes(recording: &Recording, moved: usize) -> usize {
    let time = &recording.time_s;
    let begun = begun_s(time, &recording.counts).unwrap_or(time[moved] - time[0]);
    let usual = usual_answer(recording).map_or(0.0, |(median, _)| median);
    time.partition_point(|t| t - time[0] < begun - usual)
}

/// Errors in counts RMS of a problem's start along other data: in the first window, and the greatest of the windows in which the speed
/// changes as much.
fn first_and_others(problem: &FitProblem<'_>, data: &Data) -> Option<(f64, f64)> {
    let candidate = problem.structure.candidate_at(problem.start.as_ref()?);
    let horizon = Horizon::windows(data, WINDOW_S);
    let Horizon::Windows(windows) = &horizon else {
        return None;
    };
    let (method, start) = (problem.method, problem.start_angle);
    let errors = errors(data, &candidate, method, &horizon, start, problem.cost).ok()?;
    let error = |window: &Range<usize>| rms_counts(data, &errors[window.clone()]);
    let change = |window: &Range<usize>| {
        let speeds = window
            .clone()
            .map(|k| data.speed_counts_s(k, SPEED_HALF_WIDTH));
        let (low, high) = speeds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), speed| {
            (low.min(speed), high.max(speed))
        });
        high - low
    };
    let (first, rest) = windows.split_first()?;
    let lively = AS_LIVELY * change(&first.range);
    let others: Vec<f64> = rest
        .iter()
        .filter(|window| change(&window.range) >= lively)
        .map(|window| error(&window.range))
        .collect();
    let most = others.iter().fold(0.0f64, |most, error| most.max(*error));
    (others.len() >= FEWEST).then(|| (error(&first.range), most))
}
