//! A recording in SI, with the readings that are used.

use super::input::Command;
use servoid_engine::data::local_parabola;
use servoid_engine::problem::Data;
use std::f64::consts::TAU;

/// Longest step, s: within a step the delayed command counts by its mean. At 5 ms the edges of a motor of 13 ms already
/// bent its inertia by a quarter.
const LONGEST_STEP_S: f64 = 2.5e-3;
/// Most steps to a sample interval, for gaps.
const MOST_PARTS: usize = 16;
/// A reading that equals the last is a held one where a fresh one is overdue by less than this part of the sensor's interval.
const OVERDUE: f64 = 1.5;
/// Samples between changes of the reading, median while it moves fast, from which the sensor counts as slower than the log.
const HELD_SAMPLES: f64 = 1.5;
/// Time from the last change of the reading, and to the next, from which a standstill counts as one, s.
const SETTLED_S: f64 = 0.05;
/// Time between the readings that are used of a standstill, s.
const STANDSTILL_S: f64 = 0.5;
/// Time over which the speed at the first sample is taken, s.
const START_S: f64 = 0.02;
/// Its standard deviation, part of itself.
const START_SPEED_ERROR: f64 = 0.2;
/// Samples without a change from which the motor counts as standing.
const STANDING_SAMPLES: usize = 3;

/// A recording in SI for the filter, in steps no longer than 2.5 ms. Indices run over the steps' ends; 0 is the first sample.
#[derive(Clone, Debug)]
pub struct Observed {
    /// Distinct lengths of steps, s.
    pub(super) lengths_s: Vec<f64>,
    /// Index into them of the step that ends at each point; that of point 0 is not used.
    pub(super) length_of: Vec<u32>,
    /// Times of the points from the first, s.
    pub(super) time_s: Vec<f64>,
    /// Angle, rad, at the points with a fresh reading; NaN elsewhere.
    pub(super) angle: Vec<f64>,
    /// The command, V (A behind a current loop).
    pub(super) command: Command,
    /// Resolution of the encoder, rad.
    pub(super) lsb: f64,
    /// Speed at the first sample, rad/s, and its standard deviation.
    pub(super) start_speed: (f64, f64),
    /// Median time between fresh readings, s.
    pub(super) interval_s: f64,
    /// Largest size of the command, V.
    pub(super) largest: f64,
}

impl Observed {
    /// From a recording that is ready for simulation. `None` where the bridge opens, which the equations do not have, or where
    /// nothing moves or drives.
    pub fn new(data: &Data) -> Option<Self> {
        if data.len() < 3 || data.coasts() {
            return None;
        }
        let lsb = TAU / data.units.counts_per_rev;
        let held = held_for(data);
        let fresh = fresh(data, held);
        let parts: Vec<usize> = (data.lengths.iter())
            .map(|length| parts(length * data.units.interval))
            .collect();
        let lengths_s: Vec<f64> = (data.lengths.iter().zip(&parts))
            .map(|(length, &parts)| length * data.units.interval / parts as f64)
            .collect();
        let first = data.centre(0);
        let mut edges = Vec::with_capacity(data.len());
        let (mut time_s, mut angle, mut length_of) = (vec![0.0], vec![0.0], vec![0]);
        let mut time = 0.0;
        for k in 0..data.len() - 1 {
            edges.push(time);
            let length = data.length_of[k] as usize;
            for part in 1..=parts[length] {
                time_s.push(time + lengths_s[length] * part as f64);
                length_of.push(length as u32);
                angle.push(f64::NAN);
            }
            time += lengths_s[length] * parts[length] as f64;
            if let (true, Some(last)) = (fresh[k + 1], angle.last_mut()) {
                *last = (data.centre(k + 1) - first) * lsb;
            }
        }
        edges.push(time);
        let volts: Vec<f64> = data.command.iter().map(|u| u * data.units.volts).collect();
        let largest = volts.iter().fold(0.0f64, |most, u| most.max(u.abs()));
        let (standing, start_speed) = start_speed(data, lsb);
        (largest > 0.0).then(|| Observed {
            lengths_s,
            length_of,
            time_s,
            angle,
            command: Command::new(edges, volts, standing),
            lsb,
            start_speed,
            interval_s: data.units.interval * held,
            largest,
        })
    }

    /// Indices of the points whose readings are used, no nearer to each other than `update_s`, and at a standstill only now and
    /// then; without the first, which is where the filter starts.
    pub(super) fn used(&self, update_s: f64) -> Vec<usize> {
        // Sample times are never exact; half a step early is on time.
        let early = 0.5
            * self
                .lengths_s
                .iter()
                .fold(f64::INFINITY, |least, l| least.min(*l));
        let resting = self.resting();
        let mut next = update_s - early;
        let mut rested = f64::NEG_INFINITY;
        (1..self.angle.len())
            .filter(|&k| {
                let time = self.time_s[k];
                let due = time >= next && self.angle[k].is_finite();
                let used = due && (!resting[k] || time >= rested + STANDSTILL_S);
                if used {
                    next = time + update_s - early;
                    rested = time;
                }
                used
            })
            .collect()
    }

    /// Which points are within a standstill, and not near its ends. There a quantised reading repeats itself, and its error is
    /// anything but white.
    fn resting(&self) -> Vec<bool> {
        let count = self.angle.len();
        let (mut last, mut changed) = (0.0, 0.0);
        let since: Vec<f64> = (self.angle.iter().zip(&self.time_s))
            .map(|(&angle, &time)| {
                if (angle - last).abs() > 0.5 * self.lsb {
                    (last, changed) = (angle, time);
                }
                time - changed
            })
            .collect();
        let mut next = self.duration_s();
        let mut resting = vec![false; count];
        for k in (0..count).rev() {
            resting[k] = since[k] > SETTLED_S && next - self.time_s[k] > SETTLED_S;
            if since[k] == 0.0 {
                next = self.time_s[k];
            }
        }
        resting
    }

    /// Largest change of the command between two samples, part of its range, where there are readings after it. Of a smooth
    /// command it is small.
    pub fn steepest_edge(&self) -> f64 {
        self.command.steepest_edge(self.duration_s() - SETTLED_S)
    }

    /// Standard deviation of a delay that comes from the log's ticks, s: a command takes effect, and a reading is taken, anywhere
    /// between two ticks of the sensor, each uniformly; over several edges that averages out.
    pub(super) fn timing_error_s(&self) -> f64 {
        let edges = self.command.effective_edges(self.duration_s() - SETTLED_S);
        self.interval_s * (2.0 / 12.0 / edges).sqrt()
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or(0.0)
    }
}

/// Steps to a sample interval.
pub(super) fn parts(seconds: f64) -> usize {
    ((seconds / LONGEST_STEP_S - 1e-6).ceil().max(1.0) as usize).min(MOST_PARTS)
}

/// Samples from one fresh reading to the next, median over the quarter of the changes with the fastest motion.
fn held_for(data: &Data) -> f64 {
    let mut last = 0;
    let mut changes: Vec<(f64, usize)> = Vec::new();
    for k in 1..data.len() {
        let moved = (data.counts[k] - data.counts[k - 1]).abs();
        if moved > 0.0 {
            changes.push((moved, k - last));
            last = k;
        }
    }
    if changes.is_empty() {
        return 1.0;
    }
    changes.sort_by(|a, b| b.0.total_cmp(&a.0));
    changes.truncate((changes.len() / 4).max(1));
    let mut gaps: Vec<usize> = changes.iter().map(|&(_, gap)| gap).collect();
    let middle = gaps.len() / 2;
    *gaps.select_nth_unstable(middle).1 as f64
}

/// Which readings are new. A sensor that is slower than the log repeats its reading, and a repeated one says nothing of the
/// angle at its time.
fn fresh(data: &Data, held: f64) -> Vec<bool> {
    // A coarse encoder that turns slowly repeats readings too, but each is true: there a change is one count.
    let coarse = data
        .counts
        .windows(2)
        .all(|pair| (pair[1] - pair[0]).abs() < 3.0);
    if held < HELD_SAMPLES || coarse {
        return vec![true; data.len()];
    }
    let overdue = OVERDUE * held * data.units.interval;
    let mut last = f64::NEG_INFINITY;
    (0..data.len())
        .map(|k| {
            let changed = k == 0 || data.counts[k] != data.counts[k - 1];
            let fresh = changed || data.time_s[k] - last > overdue;
            if fresh {
                last = data.time_s[k];
            }
            fresh
        })
        .collect()
}

/// Whether the motor stands at first; speed there and its standard deviation, rad/s.
fn start_speed(data: &Data, lsb: f64) -> (bool, (f64, f64)) {
    let still = (data.counts.iter().take_while(|&&c| c == data.counts[0])).count();
    if still >= STANDING_SAMPLES {
        let time = data.time_s[still - 1].min(START_S);
        return (true, (0.0, 0.5 * lsb / time));
    }
    let many = data.time_s.partition_point(|&t| t <= START_S);
    let many = many.max(STANDING_SAMPLES).min(data.len());
    let points = (0..many).map(|k| (data.time_s[k], data.centre(k) * lsb));
    let (_, speed) = local_parabola(points);
    let time = data.time_s[many - 1];
    let error = START_SPEED_ERROR * speed.abs() + 2.0 * lsb / time;
    (false, (speed, error))
}
