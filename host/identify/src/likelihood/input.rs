//! The mean of the delayed command over each step.
//!
//! The integral of a command that is held from sample to sample is a polygon. The mean over a step is the difference of the
//! integral, each end earlier by the delay, over the step's length: continuous in the delay and, but for the corners,
//! differentiable, however long the sample interval is.

/// A held command by its integral.
#[derive(Clone, Debug)]
pub(super) struct Command {
    /// When each value begins, s.
    edges: Vec<f64>,
    /// The values, V.
    values: Vec<f64>,
    /// Integral up to each edge, V·s.
    integral: Vec<f64>,
    /// The value before the first edge, V.
    before: f64,
}

impl Command {
    /// Of values that begin at `edges`. Before them there was none if the motor stood, else the first.
    pub(super) fn new(edges: Vec<f64>, values: Vec<f64>, standing: bool) -> Self {
        let mut sum = 0.0;
        let integral = (0..edges.len())
            .map(|k| {
                if k > 0 {
                    sum += values[k - 1] * (edges[k] - edges[k - 1]);
                }
                sum
            })
            .collect();
        let before = values.first().copied().filter(|_| !standing).unwrap_or(0.0);
        Command {
            edges,
            values,
            integral,
            before,
        }
    }

    /// Means over the steps between `times`, later by `delay`, s; times must increase. Entry 0 belongs to no step.
    pub(super) fn means(&self, times: &[f64], delay: f64) -> Vec<f64> {
        let mut at = 0;
        let mut last = (f64::NAN, f64::NAN);
        (times.iter())
            .map(|&time| {
                let time = time - delay;
                while at < self.edges.len() && self.edges[at] <= time {
                    at += 1;
                }
                let integral = match at {
                    0 => self.before * (time - self.edges.first().copied().unwrap_or(0.0)),
                    k => self.integral[k - 1] + self.values[k - 1] * (time - self.edges[k - 1]),
                };
                let mean = (integral - last.1) / (time - last.0);
                last = (time, integral);
                mean
            })
            .collect()
    }

    /// How many changes of the command, before `end`, s, the response is timed by: `(Σd²)²/Σd⁴` of the changes `d`, one for a
    /// single edge however many small ones stand beside it.
    pub(super) fn effective_edges(&self, end: f64) -> f64 {
        let (mut squares, mut fourths) = (0.0, 0.0);
        let mut last = self.before;
        for (&value, &edge) in self.values.iter().zip(&self.edges) {
            if edge < end {
                let square = (value - last).powi(2);
                squares += square;
                fourths += square * square;
            }
            last = value;
        }
        if fourths > 0.0 {
            squares * squares / fourths
        } else {
            f64::INFINITY
        }
    }

    /// Largest change from one value to the next before `end`, s, part of the range of all.
    pub(super) fn steepest_edge(&self, end: f64) -> f64 {
        let (mut low, mut high, mut steepest) = (self.before, self.before, 0.0f64);
        let mut last = self.before;
        for (&value, &edge) in self.values.iter().zip(&self.edges) {
            low = low.min(value);
            high = high.max(value);
            if edge < end {
                steepest = steepest.max((value - last).abs());
            }
            last = value;
        }
        if high > low {
            steepest / (high - low)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng;

    #[test]
    fn the_delayed_mean_is_what_brute_force_integrates() {
        let seed = 5;
        println!("seed {seed}");
        let mut rng = rng::seeded(seed);
        let mut uniform = || -> f64 { rng::uniform(&mut rng) };
        for standing in [true, false] {
            let mut edges = vec![0.0];
            for _ in 0..60 {
                edges.push(edges[edges.len() - 1] + 1e-3 * (0.5 + uniform()));
            }
            let values: Vec<f64> = edges.iter().map(|_| 24.0 * uniform() - 12.0).collect();
            let command = Command::new(edges.clone(), values.clone(), standing);
            for delay in [0.0, 3.3e-4, 1e-3, 7.77e-3, 0.2] {
                let means = command.means(&edges, delay);
                for k in 1..edges.len() {
                    let many = 20_000;
                    let width = (edges[k] - edges[k - 1]) / f64::from(many);
                    let sum: f64 = (0..many)
                        .map(|i| {
                            let time = edges[k - 1] + (f64::from(i) + 0.5) * width - delay;
                            match edges.partition_point(|&edge| edge <= time) {
                                0 if standing => 0.0,
                                0 => values[0],
                                at => values[at - 1],
                            }
                        })
                        .sum();
                    let expected = sum / f64::from(many);
                    let error = (means[k] - expected).abs();
                    assert!(error < 3e-3, "{delay}: {} for {expected}", means[k]);
                }
            }
        }
    }

    #[test]
    fn the_mean_changes_with_a_delay_far_below_the_sample_interval() {
        let command = Command::new(vec![0.0, 0.01], vec![0.0, 10.0], true);
        let at = |delay: f64| command.means(&[0.0, 0.01, 0.02], delay)[2];
        for delay in [1e-3, 2.5e-3, 9e-3] {
            let slope = (at(delay + 1e-6) - at(delay - 1e-6)) / 2e-6;
            assert!((slope + 10.0 / 0.01).abs() < 1e-3, "{slope}");
        }
    }
}
