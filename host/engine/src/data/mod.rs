//! A recording in the model's units: per-unit commands, counts, and the lengths of the sample intervals.

mod joined;
mod recordings;
mod thinned;

pub use joined::JoinError;
pub use recordings::Recordings;

use servoid_io::channel::{Measured, Series};
use servoid_io::median::median_interval;
use servoid_io::recording::{Drive, Recording};
use shared::effects::Kind;
use shared::error::ModelError;
use shared::units::{PerUnit, Quantity};
use std::ops::Range;
use std::sync::Arc;

/// Rounding of the sample times: the fastest motion moves less than this in it, counts.
const TIME_ERROR_COUNTS: f64 = 0.01;
/// Finest grid of sample times, parts of the nominal interval.
const FINEST_GRID: f64 = 65_536.0;

/// A recording ready for simulation. Indices run over the samples.
#[derive(Clone, Debug)]
pub struct Data {
    /// Where it came from.
    pub source: String,
    /// Bases; the interval is the median sample interval.
    pub units: PerUnit<f64>,
    /// Time since the first sample, s.
    pub time_s: Vec<f64>,
    /// Command, per unit.
    pub command: Vec<f64>,
    /// Reading in counts.
    pub counts: Vec<f64>,
    /// Whether the bridge is open after each sample; `None` where the recording does not say.
    pub open: Option<Vec<bool>>,
    /// What was measured beside the angle.
    pub measured: Series,
    /// Whether readings are floored to whole counts.
    pub quantised: bool,
    /// What the command drives.
    pub drive: Drive,
    /// Supply voltage (or largest command), V (or A).
    pub supply: f64,
    /// Distinct interval lengths, in nominal intervals.
    pub lengths: Vec<f64>,
    /// Index into `lengths` of the interval that begins at each sample.
    pub length_of: Vec<u32>,
    /// The recordings that the samples come from.
    pub recordings: Recordings,
    /// The whole recording, where this is its end: a model that runs from its start arrives here in a state that a few
    /// readings could not tell.
    pub end_of: Option<Arc<Data>>,
}

impl Data {
    /// Converts a recording.
    ///
    /// # Errors
    /// Bases that are not positive: no command, no motion, no samples.
    pub fn new(recording: &Recording) -> Result<Self, ModelError> {
        Data::taken(recording.clone())
    }

    /// Converts a recording in place: one of an hour is as large as the result.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn taken(mut recording: Recording) -> Result<Self, ModelError> {
        let one = Recordings::one(&recording.source, recording.len());
        let one = one.driven_by(recording.position.take());
        Data::of_recordings(recording, one)
    }

    /// Converts commands without readings, along which a model is to run: the readings are of no account. `fastest_rad_s` is the
    /// fastest motion to expect, rad/s.
    ///
    /// # Errors
    /// Bases that are not positive.
    pub fn driven(commands: Recording, fastest_rad_s: f64) -> Result<Self, ModelError> {
        let one = Recordings::one(&commands.source, commands.len());
        let turns = fastest_rad_s / core::f64::consts::TAU * median_interval(&commands.time_s);
        let fastest = turns * commands.counts_per_rev;
        Data::based_on(commands, one, fastest)
    }

    /// Converts `recordings` that stand one after the other.
    fn of_recordings(recording: Recording, recordings: Recordings) -> Result<Self, ModelError> {
        let steps = recordings.steps(&recording.counts);
        let fastest = steps.map(f64::abs).fold(0.0, f64::max);
        Data::based_on(recording, recordings, fastest)
    }

    /// The same, of which the fastest motion is known, counts a sample.
    fn based_on(
        recording: Recording,
        recordings: Recordings,
        fastest: f64,
    ) -> Result<Self, ModelError> {
        let largest = recording.command.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let supply = recording
            .supply_v
            .filter(|_| recording.drive == Drive::Voltage)
            .unwrap_or(largest);
        let first = recording.time_s.first().copied().unwrap_or(0.0);
        let mut time_s = recording.time_s;
        for time in &mut time_s {
            *time -= first;
        }
        let interval = median_interval(&time_s);
        let turns_per_s = fastest / recording.counts_per_rev / interval;
        let units = PerUnit::new(
            supply.max(largest),
            turns_per_s * core::f64::consts::TAU,
            interval,
            recording.counts_per_rev,
        )?;
        let (lengths, length_of) = interval_lengths(&time_s, &recordings, interval, fastest);
        let mut command = recording.command;
        for command in &mut command {
            *command /= units.volts;
        }
        let mut open = recording.enabled;
        for open in open.iter_mut().flatten() {
            *open = !*open;
        }
        Ok(Data {
            source: recording.source,
            command,
            counts: recording.counts,
            open,
            measured: recording.measured,
            quantised: recording.quantised,
            drive: recording.drive,
            supply,
            time_s,
            units,
            lengths,
            length_of,
            recordings,
            end_of: None,
        })
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.counts.len()
    }

    /// The first `samples` samples.
    pub fn first(&self, samples: usize) -> Data {
        let some = |values: &[f64]| values[..samples.min(values.len())].to_vec();
        Data {
            source: self.source.clone(),
            time_s: some(&self.time_s),
            command: some(&self.command),
            counts: some(&self.counts),
            open: self
                .open
                .as_ref()
                .map(|open| open[..samples.min(open.len())].to_vec()),
            measured: self.measured.rows(0..samples.min(self.len())),
            lengths: self.lengths.clone(),
            length_of: self.length_of[..samples.min(self.len())].to_vec(),
            recordings: self.recordings.first(samples),
            end_of: None,
            ..*self
        }
    }

    /// Marks the data as the end of a whole recording.
    pub fn at_end_of(mut self, whole: Arc<Data>) -> Self {
        self.end_of = Some(whole);
        self
    }

    /// The same with so many counts added to each reading, which need not be whole.
    #[must_use]
    pub fn turned(&self, counts: f64) -> Self {
        let mut turned = self.clone();
        for count in &mut turned.counts {
            *count += counts;
        }
        turned.recordings = turned.recordings.turned(counts);
        turned
    }

    /// Changes of the reading from sample to sample, counts.
    pub fn steps(&self) -> impl Iterator<Item = f64> {
        self.recordings.steps(&self.counts)
    }

    /// Time that the recordings took, s.
    pub fn duration_s(&self) -> f64 {
        let ranges = self.recordings.ranges().filter(|range| !range.is_empty());
        ranges
            .map(|range| self.time_s[range.end - 1] - self.time_s[range.start])
            .sum()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.counts.is_empty()
    }

    /// Best estimate of the angle in counts from the reading of sample `k`: the centre of its cell.
    pub fn centre(&self, k: usize) -> f64 {
        self.counts[k] + self.half_cell()
    }

    /// How far a reading lies below the centre of its cell, counts: nothing where angles are not floored.
    pub fn half_cell(&self) -> f64 {
        if self.quantised {
            shared::encoder::FLOOR_OFFSET_COUNTS
        } else {
            0.0
        }
    }

    /// What was asked of the motor over samples of one recording: its targets, counts, where a position loop drives it, and else its command.
    pub fn asked(&self, samples: &Range<usize>) -> &[f64] {
        let begin = self.recordings.holding(samples.start).start;
        match self.recordings.drive_at(samples.start) {
            Some(drive) => &drive.target_counts[samples.start - begin..samples.end - begin],
            None => &self.command[samples.clone()],
        }
    }

    /// Whether the bridge is open after sample `k`.
    pub fn is_open(&self, k: usize) -> bool {
        self.open.as_ref().is_some_and(|open| open[k])
    }

    /// The temperature at sample `k`, per unit; zero where the recording tells none.
    #[inline(always)]
    pub fn temperature(&self, k: usize) -> f64 {
        let told = self.measured.get(Measured::Temperature);
        told.map_or(0.0, |temperature| {
            self.units.lower(temperature[k], Quantity::Temperature)
        })
    }

    /// Whether these effects can run along the data.
    ///
    /// # Errors
    /// [`ModelError::NoTemperature`] where one depends on the temperature, and the data tell none.
    pub fn check_told(&self, effects: impl IntoIterator<Item = Kind>) -> Result<(), ModelError> {
        match self.measured.get(Measured::Temperature) {
            Some(_) => Ok(()),
            None => (effects.into_iter()).try_for_each(Kind::check_without_temperature),
        }
    }

    /// Whether the bridge is ever open.
    pub fn coasts(&self) -> bool {
        self.open
            .as_ref()
            .is_some_and(|open| open.iter().any(|&open| open))
    }

    /// Greatest less least reading, counts.
    pub fn travel_counts(&self) -> f64 {
        let (low, high) = self
            .counts
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &c| {
                (l.min(c), h.max(c))
            });
        high - low
    }

    /// How many times the reading changes: the number of independent facts about the angle that a
    /// quantised recording holds, far fewer than samples when the motor is slow.
    pub fn transitions(&self) -> usize {
        self.steps().filter(|&step| step != 0.0).count()
    }

    /// Half the number of samples that a measured state is taken from. Whole counts carry the encoder's rounding only; an
    /// angle that is no plain count carries the noise of its sensor, which takes more samples to average.
    pub fn state_half_width(&self) -> usize {
        if self.quantised {
            return COUNTER_HALF_WIDTH;
        }
        let samples = (STATE_HALF_TIME_S / self.units.interval).round() as usize;
        samples.max(COUNTER_HALF_WIDTH)
    }

    /// Angle in counts and speed in counts per second at sample `k`: the reading's centre where it is a whole count, else the
    /// value of the parabola that gives the speed.
    pub fn measured_state(&self, k: usize) -> (f64, f64) {
        let half = self.state_half_width();
        let Range {
            start: from,
            end: to,
        } = self.recordings.around(k, half);
        let still = self.counts[from..to]
            .iter()
            .all(|count| *count == self.counts[k]);
        if self.quantised || still {
            return (self.centre(k), self.speed_counts_s(k, half));
        }
        let origin = self.time_s[k];
        let points = (from..to).map(|j| (self.time_s[j] - origin, self.centre(j) - self.centre(k)));
        let (angle, speed) = local_parabola(points);
        (self.centre(k) + angle, speed)
    }

    /// Whether the samples from `k`, the first of a recording, show any motion at all.
    pub fn may_start_moving(&self, k: usize) -> bool {
        let speed = self.speed_counts_s(k, COUNTER_HALF_WIDTH);
        speed.abs() * self.units.interval * COUNTER_HALF_WIDTH as f64 > 1.0
    }

    /// Whether the samples from `k`, the first of a recording, show that the motor was in motion before: by several counts as far in the
    /// first samples as in as many after them, where a motor that starts at rest comes a third as far.
    pub fn starts_moving(&self, k: usize) -> bool {
        let recording = self.recordings.around(k, 2 * COUNTER_HALF_WIDTH);
        let (middle, end) = (k + COUNTER_HALF_WIDTH, k + 2 * COUNTER_HALF_WIDTH);
        if end >= recording.end {
            return false;
        }
        let first = self.centre(middle) - self.centre(k);
        let second = self.centre(end) - self.centre(middle);
        first * second > 0.0 && first.abs() >= SURE_COUNTS && first.abs() >= AS_FAR * second.abs()
    }

    /// Speed at `k`, the first sample of a recording, rad/s: the measured one where the samples show any motion at all.
    pub fn start_speed(&self, k: usize) -> f64 {
        if !self.may_start_moving(k) {
            return 0.0;
        }
        self.measured_state(k).1 / self.units.counts_per_rev * core::f64::consts::TAU
    }

    /// Change of a signal per second at sample `k`: over as many as `half` samples to both sides, fewer at the ends.
    pub fn rate_of(&self, signal: &[f64], k: usize, half: usize) -> f64 {
        let near = self.recordings.around(k, half);
        let (from, to) = (near.start, near.end - 1);
        let time = self.time_s[to] - self.time_s[from];
        (signal[to] - signal[from]) / time.max(f64::MIN_POSITIVE)
    }

    /// Speed at sample `k` in counts per second: slope of a parabola through its neighbourhood of
    /// `2·half + 1` samples, fewer at the ends.
    pub fn speed_counts_s(&self, k: usize, half: usize) -> f64 {
        let Range {
            start: from,
            end: to,
        } = self.recordings.around(k, half);
        let origin = self.time_s[k];
        local_parabola(
            (from..to).map(|j| (self.time_s[j] - origin, self.centre(j) - self.centre(k))),
        )
        .1
    }
}

/// Half the number of samples that the speed of a counted angle is taken from.
const COUNTER_HALF_WIDTH: usize = 4;
/// Fewest counts that tell a motor in motion from one that starts: the counter's rounding changes the ratio of two such ways by a quarter.
const SURE_COUNTS: f64 = 8.0;
/// The way of the first samples as a part of that of the next ones, from which on the motor was in motion before: between a third, of a
/// constant torque from rest, and one.
const AS_FAR: f64 = 0.7;
/// Half the time that the state of an angle with sensor noise is taken from, s: below a motor's mechanical time constant.
const STATE_HALF_TIME_S: f64 = 0.008;

/// Value and slope at zero of the parabola through the points in the least-squares sense; a straight
/// line where there are too few of them.
pub fn local_parabola(points: impl Iterator<Item = (f64, f64)> + Clone) -> (f64, f64) {
    let count = points.clone().count();
    let terms = count.clamp(1, 3);
    let scale = points
        .clone()
        .fold(0.0f64, |m, (t, _)| m.max(t.abs()))
        .max(f64::MIN_POSITIVE);
    let rows: Vec<(f64, f64)> = points.map(|(t, y)| (t / scale, y)).collect();
    let matrix = nalgebra::DMatrix::from_fn(count, terms, |i, j| rows[i].0.powi(j as i32));
    let right = nalgebra::DVector::from_iterator(count, rows.iter().map(|r| r.1));
    match matrix.svd(true, true).solve(&right, 1e-12) {
        Ok(solution) => (
            solution[0],
            if terms > 1 { solution[1] / scale } else { 0.0 },
        ),
        Err(_) => (0.0, 0.0),
    }
}

/// Rounds the sample *times* (so that no error adds up) to a grid just fine enough for the fastest
/// motion, and lists the interval lengths that occur. An even recording has a single one.
fn interval_lengths(
    time_s: &[f64],
    recordings: &Recordings,
    nominal: f64,
    fastest_counts: f64,
) -> (Vec<f64>, Vec<u32>) {
    let mut grid = 1.0;
    while grid < FINEST_GRID && fastest_counts / grid > TIME_ERROR_COUNTS {
        grid *= 2.0;
    }
    let even = time_s
        .iter()
        .enumerate()
        .all(|(k, t)| (t / nominal - k as f64).abs() * grid <= 0.5);
    let tick = |k: usize| {
        if even {
            k as i64 * grid as i64
        } else {
            (time_s[k] / nominal * grid).round() as i64
        }
    };
    let mut known = std::collections::BTreeMap::new();
    let mut lengths = Vec::new();
    let length_of = (0..time_s.len())
        .map(|k| {
            // The last sample of a recording begins no interval: that of the one before, so that an even recording has
            // one length.
            let range = recordings.holding(k);
            let k = k.min(range.end.saturating_sub(2)).max(range.start);
            let next = (k + 1).min(time_s.len().saturating_sub(1));
            let ticks = (tick(next) - tick(k)).max(1);
            *known.entry(ticks).or_insert_with(|| {
                lengths.push(ticks as f64 / grid);
                lengths.len() as u32 - 1
            })
        })
        .collect();
    (lengths, length_of)
}
