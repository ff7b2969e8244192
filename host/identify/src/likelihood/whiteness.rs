//! Whether the innovations are white: what is left after a right model predicts nothing.

use super::huber::HUBER;
use super::objective::Evaluated;
use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Lags that count.
const LAGS: usize = 20;

/// How white the innovations are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Whiteness {
    /// Correlation of neighbouring innovations.
    pub neighbours: f64,
    /// Probability of as much correlation over 20 lags if they were white (Ljung and Box, *Biometrika* 65, 297, 1978).
    pub p_value: f64,
}

/// Of standardised innovations, outliers cut to four standard deviations. `None` where there are too few.
pub(super) fn whiteness(evaluated: &Evaluated) -> Option<Whiteness> {
    let (mut statistic, mut neighbours, mut weight, mut lags) = (0.0, 0.0, 0.0, 0);
    for innovations in &evaluated.innovations {
        let n = innovations.errors.len();
        if n < 3 * LAGS {
            continue;
        }
        let each: Vec<f64> = (innovations.errors.iter().zip(&innovations.variances))
            .map(|(error, variance)| (error / variance.sqrt()).clamp(-HUBER, HUBER))
            .collect();
        let mean = each.iter().sum::<f64>() / n as f64;
        let product = |lag: usize| -> f64 {
            let pairs = each[lag..].iter().zip(&each);
            pairs.map(|(a, b)| (a - mean) * (b - mean)).sum()
        };
        let variance = product(0);
        if variance <= 0.0 {
            continue;
        }
        let n = n as f64;
        for lag in 1..=LAGS {
            let correlation = product(lag) / variance;
            statistic += n * (n + 2.0) / (n - lag as f64) * correlation * correlation;
            if lag == 1 {
                neighbours += n * correlation;
                weight += n;
            }
        }
        lags += LAGS;
    }
    let distribution = ChiSquared::new(lags as f64).ok()?;
    (weight > 0.0 && f64::is_finite(statistic)).then(|| Whiteness {
        neighbours: neighbours / weight,
        p_value: distribution.sf(statistic),
    })
}
