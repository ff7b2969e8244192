//! A driver that wakes after the log has begun: its first commands are logged and move nothing. No physics of the motor does that, and the
//! error of these moments hides all others; they are cut off.
//!
//! It shows where a motor that rests at first and is then seen to move is started too early by a linear motor with Coulomb friction that
//! was regressed on the rest of the recording: by far more than that model misses any other start or reversal, and no longer once its
//! bridge is open until the motion begins. A delay of the bus and friction that holds are seen at other starts, too.

use crate::check::{Finding, Severity, begun_s, edges_after_rest};
use crate::fit::{self, Options, SPEED_HALF_WIDTH};
use servoid_engine::problem::{Data, FitProblem, Horizon, rms_counts};
use servoid_io::recording::Recording;
use shared::effects::Kind;
use std::ops::Range;

/// Length of the windows in which the first moments are held against the rest, s.
const WINDOW_S: f64 = 0.5;
/// Counts of motion that are no jitter.
const BEGUN: f64 = 2.0;
/// Fewest samples of rest before the first motion.
const RESTED: usize = 5;
/// The error of the first window is so many times that of any other in which the speed changes as much. It was at most 1.07 in 115
/// recordings of the bench with one effect each, and 2.1 to 5.2 where a driver woke 45 to 135 ms late.
const OUTLIER: f64 = 1.5;
/// It falls to this part once the bridge is open until the motion begins. A slow ramp fell to 0.79, drivers that woke late to 0.08 to 0.29.
const CURED: f64 = 0.5;
/// Part of the first window's change of speed from which on another is compared with it.
const AS_LIVELY: f64 = 0.5;
/// Fewest windows to compare with: what is seen once may be a delay.
const FEWEST: usize = 2;

/// A driver that woke late.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LateDriver {
    /// First sample from which on it drives.
    sample: usize,
    /// The same, s after the first sample.
    after_s: f64,
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

    /// The recording without the moments before.
    pub fn cut(&self, recording: &Recording) -> Recording {
        recording.samples(self.sample..recording.len())
    }
}

/// The recordings with the first moments of a late driver cut off, and the findings.
pub fn without_late_drivers(recordings: &mut [Recording]) -> Vec<(String, Finding)> {
    let mut findings = Vec::new();
    for recording in recordings {
        if let Some(late) = LateDriver::of(recording) {
            findings.push((recording.source.clone(), late.finding()));
            *recording = late.cut(recording);
        }
    }
    findings
}

/// First sample from which on the driver drives: as long before the motion begins as at the other starts.
fn wakes(recording: &Recording, moved: usize) -> usize {
    let time = &recording.time_s;
    let begun = begun_s(time, &recording.counts).unwrap_or(time[moved] - time[0]);
    let mut answers: Vec<f64> = edges_after_rest(recording)
        .filter_map(|edge| begun_s(&time[edge..], &recording.counts[edge..]))
        .collect();
    answers.sort_by(f64::total_cmp);
    let usual = answers.get(answers.len() / 2).copied().unwrap_or(0.0);
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
    let errors = FitProblem {
        data,
        structure: problem.structure.clone(),
        horizon: horizon.clone(),
        start: None,
        ..*problem
    }
    .errors(&candidate)
    .ok()?;
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

#[cfg(test)]
mod tests {
    use super::LateDriver;
    use crate::check::edges_after_rest;
    use servoid_io::recording::Recording;
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use shared::effects::Kind;

    const SEEDS: std::ops::Range<u64> = 1..31;

    fn with(effect: &str, seed: u64) -> Option<Recording> {
        let hidden = Hidden::typical(effect, &showcase::machine()).ok()?;
        showcase::record(&[hidden], seed, "bench").ok()
    }

    /// The same log, begun `seconds` before the driver woke, while its first command stood there already.
    fn late(recording: &Recording, seconds: f64) -> Recording {
        let interval = recording.median_interval_s();
        let asleep = (seconds / interval).round() as usize;
        let mut late = recording.clone();
        let start = recording.time_s[0];
        let before = |k: usize| start + (k as f64 - asleep as f64) * interval;
        late.time_s.splice(0..0, (0..asleep).map(before));
        let first = recording.command[0];
        late.command.splice(0..0, vec![first; asleep]);
        late.counts.splice(0..0, vec![recording.counts[0]; asleep]);
        late
    }

    #[test]
    fn a_driver_that_woke_late_is_cut_off_where_it_woke() {
        let (mut tried, mut found) = (0, 0);
        for seed in SEEDS {
            let whole = with("coulomb", seed).expect("a recording");
            let Some(edge) = edges_after_rest(&whole).next() else {
                continue;
            };
            let recording = whole.samples(edge..whole.len());
            tried += 1;
            let slept_s = 0.04 + 0.003 * seed as f64;
            if let Some(woken) = LateDriver::of(&late(&recording, slept_s)) {
                let off = woken.after_s - slept_s;
                assert!(off.abs() < 0.01, "seed {seed}: {off} s beside {slept_s} s");
                found += 1;
            }
        }
        assert!(tried > 5 && found * 10 >= tried * 8, "{found} of {tried}");
    }

    #[test]
    fn no_effect_passes_for_a_driver_that_woke_late() {
        for (kind, seed) in Kind::ALL.iter().zip(SEEDS) {
            let Some(recording) = with(kind.name(), seed) else {
                continue;
            };
            let found = LateDriver::of(&recording);
            assert_eq!(found, None, "{} of seed {seed}", kind.name());
        }
    }
}
