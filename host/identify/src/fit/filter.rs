//! State variable filters (Young, *Recursive Estimation*, 1984): four first-order lags in a row,
//! `1/(1 + T·s)⁴`, whose states are also the filtered derivatives, so that an encoder's steps are
//! never differentiated. Several filter times go side by side.
//!
//! The states are kept as what they are behind the input, `y`. While the input rises by `r` in an interval `h`, with
//! `x = h/T`,
//!
//! ```text
//! y(h) = Φ·(y + k·r/x) − k·r/x,    Φ(i, j) = e^−x · x^(i−j)/(i−j)!,    k = 1, 2, 3, 4
//! ```
//!
//! exactly: behind an even rise each lag is late by `T`, and what is not yet so dies away.

use servoid_engine::problem::Data;
use std::array::from_fn;

/// Lags in a row.
const STAGES: usize = 4;

/// A filtered signal and its first three derivatives: a number each, or one for each filter time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Filtered<V = f64> {
    pub(crate) value: V,
    pub(crate) rate: V,
    pub(crate) acceleration: V,
    pub(crate) jerk: V,
}

/// What the lags of a signal are behind it, for each filter time.
pub(crate) type Behind<const L: usize> = [[f64; L]; STAGES];

/// A filter for each of `L` times.
pub(crate) struct Filter<const L: usize> {
    /// One over each time, 1/s.
    per_time: [f64; L],
    /// What an interval does, for each length in the data.
    intervals: Vec<Interval<L>>,
}

struct Interval<const L: usize> {
    /// A diagonal of Φ each.
    decay: [[f64; L]; STAGES],
    /// Each state by the input's rise.
    rise: [[f64; L]; STAGES],
}

impl<const L: usize> Interval<L> {
    /// So many filter times long.
    fn new(parts: [f64; L]) -> Self {
        let mut decay = [parts.map(|x| libm::exp(-x)); STAGES];
        for k in 1..STAGES {
            decay[k] = from_fn(|l| decay[k - 1][l] * parts[l] / k as f64);
        }
        let rise = from_fn(|stage| {
            from_fn(|l| {
                let left = (0..=stage).map(|j| decay[stage - j][l] * (j + 1) as f64);
                (left.sum::<f64>() - (stage + 1) as f64) / parts[l]
            })
        });
        Interval { decay, rise }
    }
}

impl<const L: usize> Filter<L> {
    /// With these filter times, s, for these data.
    pub(crate) fn new(data: &Data, times: [f64; L]) -> Self {
        let interval = |length: &f64| {
            let seconds = length * data.units.interval;
            Interval::new(times.map(|time| seconds / time))
        };
        Filter {
            per_time: times.map(|time| 1.0 / time),
            intervals: data.lengths.iter().map(interval).collect(),
        }
    }

    /// What is filtered of a signal that stands at `input`.
    #[inline(always)]
    pub(crate) fn output(&self, behind: &Behind<L>, input: [f64; L]) -> Filtered<[f64; L]> {
        let [a, b, c, d] = behind;
        let per = &self.per_time;
        Filtered {
            value: from_fn(|l| input[l] + d[l]),
            rate: from_fn(|l| (c[l] - d[l]) * per[l]),
            acceleration: from_fn(|l| (b[l] - 2.0 * c[l] + d[l]) * (per[l] * per[l])),
            jerk: from_fn(|l| (a[l] - 3.0 * b[l] + 3.0 * c[l] - d[l]) * (per[l] * per[l] * per[l])),
        }
    }

    /// Lets the interval that begins at sample `k` of the data pass, in which the input rises straight by `rise`.
    #[inline(always)]
    pub(crate) fn pass(&self, data: &Data, k: usize, behind: &mut Behind<L>, rise: [f64; L]) {
        let interval = &self.intervals[data.length_of[k] as usize];
        let [a, b, c, d] = *behind;
        let [p, q, r, s] = &interval.decay;
        let own = interval.rise.map(|by| times(&by, &rise));
        // Each state's own part last: the rest does not wait for it.
        *behind = [
            plus(own[0], times(p, &a)),
            plus(plus(own[1], times(q, &a)), times(p, &b)),
            plus(plus(plus(own[2], times(r, &a)), times(q, &b)), times(p, &c)),
            plus(
                plus(plus(own[3], times(s, &a)), plus(times(r, &b), times(q, &c))),
                times(p, &d),
            ),
        ];
    }
}

// In loops over the lanes within loops over the states the compiler does not find the vectors.
#[inline(always)]
fn times<const L: usize>(a: &[f64; L], b: &[f64; L]) -> [f64; L] {
    from_fn(|l| a[l] * b[l])
}

#[inline(always)]
fn plus<const L: usize>(a: [f64; L], b: [f64; L]) -> [f64; L] {
    from_fn(|l| a[l] + b[l])
}

/// A signal as it passes a filter, sample by sample.
pub(super) struct Passing<'a> {
    data: &'a Data,
    filter: Filter<1>,
    behind: Behind<1>,
    /// Constant between samples; else straight.
    held: bool,
}

impl<'a> Passing<'a> {
    /// A signal that begins at rest.
    pub(super) fn new(data: &'a Data, time: f64, held: bool) -> Self {
        Passing {
            data,
            filter: Filter::new(data, [time]),
            behind: Behind::default(),
            held,
        }
    }

    /// What is filtered at sample `k`, where the signal is `now`, the `next` of which comes in its turn. With each recording
    /// the signal begins at rest.
    pub(super) fn at(&mut self, k: usize, now: f64, next: Option<f64>) -> Filtered {
        if self.data.recordings.is_first(k) {
            self.behind = Behind::default();
        }
        let at = self.filter.output(&self.behind, [now]);
        if let Some(next) = next {
            let rise = next - now;
            if self.held {
                self.filter.pass(self.data, k, &mut self.behind, [0.0]);
                // The input jumps, the lags do not.
                for stage in &mut self.behind {
                    stage[0] -= rise;
                }
            } else {
                self.filter.pass(self.data, k, &mut self.behind, [rise]);
            }
        }
        Filtered {
            value: at.value[0],
            rate: at.rate[0],
            acceleration: at.acceleration[0],
            jerk: at.jerk[0],
        }
    }
}

/// Filters a signal that is sampled (straight between samples) or `held` (constant between them).
pub(crate) fn filtered(data: &Data, time: f64, signal: &[f64], held: bool) -> Vec<Filtered> {
    let mut passing = Passing::new(data, time, held);
    let at = |(k, now): (usize, &f64)| passing.at(k, *now, signal.get(k + 1).copied());
    signal.iter().enumerate().map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use servoid_io::channel::Series;
    use servoid_io::recording::{Drive, Recording};
    use shared::rng;

    /// Times between samples that differ, s.
    fn data(seed: u64, samples: usize) -> Data {
        let mut generator = rng::seeded(seed);
        let mut time = 0.0;
        let time_s = (0..samples).map(|_| {
            time += 1e-3 * f64::from(1 + (8.0 * rng::uniform::<f64>(&mut generator)) as u8);
            time
        });
        let recording = Recording {
            source: "test".to_owned(),
            time_s: time_s.collect(),
            command: vec![1.0; samples],
            counts: (0..samples).map(|k| k as f64).collect(),
            measured: Series::NONE,
            enabled: None,
            counts_per_rev: 2000.0,
            quantised: true,
            supply_v: Some(12.0),
            drive: Drive::Voltage,
            position: None,
        };
        Data::new(&recording).expect("valid bases")
    }

    fn wander(seed: u64, samples: usize) -> Vec<f64> {
        let mut generator = rng::seeded(seed);
        let mut at = 100.0;
        (0..samples)
            .map(|_| {
                at += rng::uniform::<f64>(&mut generator) - 0.3;
                at
            })
            .collect()
    }

    /// Lags whose input runs straight, or is held, by many small steps of Runge and Kutta.
    fn by_small_steps(data: &Data, time: f64, signal: &[f64], held: bool) -> Vec<[f64; 4]> {
        const STEPS: usize = 200;
        let rates = |s: &[f64; 4], input: f64| {
            [input - s[0], s[0] - s[1], s[1] - s[2], s[2] - s[3]].map(|x| x / time)
        };
        let mut stages = [signal[0]; 4];
        let mut out = vec![stages];
        for k in 0..signal.len() - 1 {
            let h = data.lengths[data.length_of[k] as usize] * data.units.interval / STEPS as f64;
            let to = if held { signal[k] } else { signal[k + 1] };
            let input = |step: f64| signal[k] + (to - signal[k]) * step / STEPS as f64;
            for step in 0..STEPS {
                let step = step as f64;
                let along = |by: f64, slope: &[f64; 4]| from_fn(|i| stages[i] + by * slope[i]);
                let a = rates(&stages, input(step));
                let b = rates(&along(0.5 * h, &a), input(step + 0.5));
                let c = rates(&along(0.5 * h, &b), input(step + 0.5));
                let d = rates(&along(h, &c), input(step + 1.0));
                stages = from_fn(|i| stages[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
            }
            out.push(stages);
        }
        out
    }

    /// However long an interval is beside the filter time.
    #[test]
    fn the_lags_are_those_of_very_small_steps() {
        for seed in 0..5 {
            let (data, signal) = (data(seed, 300), wander(seed, 300));
            for time in [1e-3, 3e-3, 0.03, 0.3] {
                for held in [false, true] {
                    let small = by_small_steps(&data, time, &signal, held);
                    for (own, [a, b, c, d]) in
                        filtered(&data, time, &signal, held).iter().zip(small)
                    {
                        let rates = [c - d, b - 2.0 * c + d, a - 3.0 * b + 3.0 * c - d];
                        let [rate, acceleration, jerk] = rates;
                        let off = [
                            own.value - d,
                            own.rate * time - rate,
                            own.acceleration * time.powi(2) - acceleration,
                            own.jerk * time.powi(3) - jerk,
                        ];
                        for off in off {
                            assert!(off.abs() < 1e-7, "{time} s, held {held}: {off:e}");
                        }
                    }
                }
            }
        }
    }

    /// Behind an even rise every lag is late by its time, and the slope is the rise.
    #[test]
    fn an_even_rise_is_late_by_four_times_the_filter_time() {
        let data = data(9, 4000);
        let mut time = 0.0;
        let mut signal = vec![0.0];
        for k in 0..data.len() - 1 {
            time += data.lengths[data.length_of[k] as usize] * data.units.interval;
            signal.push(70.0 * time);
        }
        for filter_time in [2e-3, 0.02, 0.1] {
            let all = filtered(&data, filter_time, &signal, false);
            let (last, end) = (all[all.len() - 1], signal[signal.len() - 1]);
            assert!((last.value - (end - 4.0 * filter_time * 70.0)).abs() < 1e-8);
            assert!((last.rate - 70.0).abs() < 1e-7);
        }
    }
}
