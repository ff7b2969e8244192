//! State variable filters (Young, *Recursive Estimation*, 1984): four first-order lags in a row,
//! `1/(1 + T·s)⁴`, whose states are also the filtered derivatives, so that an encoder's steps are
//! never differentiated.

use crate::problem::Data;

/// A filtered signal and its first three derivatives.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Filtered {
    pub(super) value: f64,
    pub(super) rate: f64,
    pub(super) acceleration: f64,
    pub(super) jerk: f64,
}

struct Lags {
    time: f64,
    stages: [f64; 4],
}

impl Lags {
    fn output(&self) -> Filtered {
        let [a, b, c, d] = self.stages;
        let t = self.time;
        Filtered {
            value: d,
            rate: (c - d) / t,
            acceleration: (b - 2.0 * c + d) / (t * t),
            jerk: (a - 3.0 * b + 3.0 * c - d) / (t * t * t),
        }
    }

    fn rates(&self, stages: &[f64; 4], input: f64) -> [f64; 4] {
        let [a, b, c, d] = *stages;
        [input - a, a - b, b - c, c - d].map(|x| x / self.time)
    }

    /// Advances by `interval` while the input runs straight from `from` to `to`: Heun's rule in
    /// parts well below the filter time.
    fn advance(&mut self, interval: f64, from: f64, to: f64) {
        let parts = (4.0 * interval / self.time).ceil().clamp(1.0, 16.0);
        let h = interval / parts;
        for part in 0..parts as usize {
            let at = |p: usize| from + (to - from) * p as f64 / parts;
            let first = self.rates(&self.stages, at(part));
            let ahead = std::array::from_fn(|i| self.stages[i] + h * first[i]);
            let second = self.rates(&ahead, at(part + 1));
            for i in 0..4 {
                self.stages[i] += 0.5 * h * (first[i] + second[i]);
            }
        }
    }
}

/// Filters a signal that is sampled (straight between samples) or `held` (constant between them).
pub(super) fn filtered(data: &Data, time: f64, signal: &[f64], held: bool) -> Vec<Filtered> {
    let mut lags = Lags {
        time,
        stages: [signal.first().copied().unwrap_or(0.0); 4],
    };
    let mut out = Vec::with_capacity(signal.len());
    for k in 0..signal.len() {
        out.push(lags.output());
        if k + 1 < signal.len() {
            let to = if held { signal[k] } else { signal[k + 1] };
            lags.advance(data.time_s[k + 1] - data.time_s[k], signal[k], to);
        }
    }
    out
}
