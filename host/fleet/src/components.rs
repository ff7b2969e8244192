//! Two levels: each unit's value is drawn from the population, and each reading of it has an error of its own, whose variance is
//! known. What the readings spread is both; here the population's part is taken out of it.
//!
//! Variances by restricted maximum likelihood (Patterson and Thompson, 1971), covariances pair by pair with the variances held
//! (pairwise fitting: Fieuws and Verbeke, 2006, Biometrics 62). Intervals hold where all errors are alike, and nearly where not:
//! of a variance by the χ² distribution of population and error together; of a mean by Student's t with the same degrees of
//! freedom; of a covariance as a quarter of the difference of the variances of sum and difference, which are independent, each with
//! its own interval (MOVER: Zou and Donner, 2008, Statistics in Medicine 27).

use statrs::distribution::{ChiSquared, ContinuousCDF, StudentsT};

const ITERATIONS: usize = 200;
const CLOSE: f64 = 1e-12;
/// Parts of a distribution below the ends of an interval of 95 %.
const LOW: f64 = 0.025;
const HIGH: f64 = 0.975;
/// No population's correlation is stated nearer to one.
const LARGEST_CORRELATION: f64 = 0.9999;

/// A value with its interval of 95 %.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) value: f64,
    pub(crate) low: f64,
    pub(crate) high: f64,
}

/// The population's part of one quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Level {
    /// Mean over the population.
    pub(crate) mean: Interval,
    /// Variance between units.
    pub(crate) variance: Interval,
    /// Variance of a reading's own error, as units weigh.
    pub(crate) error: f64,
    /// Degrees of freedom of the variance.
    pub(crate) freedom: f64,
}

/// Splits readings `y` with variances `error` of their own. None of fewer than three, or where they are no numbers.
pub(crate) fn level(y: &[f64], error: &[f64]) -> Option<Level> {
    let units = y.len();
    if units < 3 || y.iter().chain(error).any(|x| !x.is_finite()) {
        return None;
    }
    let plain = y.iter().sum::<f64>() / units as f64;
    let spread = y.iter().map(|y| (y - plain).powi(2)).sum::<f64>() / (units - 1) as f64;
    let mut variance = (spread - error.iter().sum::<f64>() / units as f64).max(0.0);
    // A variance of nothing at all has no weights.
    let least = CLOSE * spread.max(f64::MIN_POSITIVE);
    let mut state = Weighed::of(y, error, variance.max(least))?;
    for _ in 0..ITERATIONS {
        let next = (variance + state.score / state.information).max(0.0);
        let moved = (next - variance).abs();
        variance = next;
        state = Weighed::of(y, error, variance.max(least))?;
        if moved <= CLOSE * spread {
            break;
        }
    }
    let own = state.error;
    let total = variance + own;
    // Twice the square of a variance over the variance of its estimate.
    let freedom = (2.0 * total * total * state.information).clamp(1.0, (units - 1) as f64);
    let chi = ChiSquared::new(freedom).ok()?;
    let t = StudentsT::new(0.0, 1.0, freedom).ok()?.inverse_cdf(HIGH);
    let half = t * state.mean_variance.sqrt();
    Some(Level {
        mean: Interval {
            value: state.mean,
            low: state.mean - half,
            high: state.mean + half,
        },
        variance: Interval {
            value: variance,
            low: (freedom * total / chi.inverse_cdf(HIGH) - own).max(0.0),
            high: (freedom * total / chi.inverse_cdf(LOW) - own).max(0.0),
        },
        error: own,
        freedom,
    })
}

/// Weighted sums at a variance, with score and expected information of the restricted likelihood.
struct Weighed {
    mean: f64,
    mean_variance: f64,
    error: f64,
    score: f64,
    information: f64,
}

impl Weighed {
    fn of(y: &[f64], error: &[f64], variance: f64) -> Option<Self> {
        let weights: Vec<f64> = error.iter().map(|error| 1.0 / (variance + error)).collect();
        let powers = |power: i32| weights.iter().map(|w| w.powi(power)).sum::<f64>();
        let (one, two, three) = (powers(1), powers(2), powers(3));
        let mean = weights.iter().zip(y).map(|(w, y)| w * y).sum::<f64>() / one;
        let squares = weights.iter().zip(y).map(|(w, y)| (w * (y - mean)).powi(2));
        let own = weights.iter().zip(error).map(|(w, error)| w * w * error);
        let found = Weighed {
            mean,
            mean_variance: 1.0 / one,
            error: own.sum::<f64>() / two,
            score: 0.5 * (squares.sum::<f64>() - one + two / one),
            information: 0.5 * (two - 2.0 * three / one + (two / one).powi(2)),
        };
        (found.information > 0.0 && found.score.is_finite()).then_some(found)
    }
}

/// Covariance between units of two quantities of the same units, whose levels are known; without own errors in common.
pub(crate) fn covariance(
    (y, y_error, y_level): (&[f64], &[f64], &Level),
    (z, z_error, z_level): (&[f64], &[f64], &Level),
) -> Option<Interval> {
    let units = y.len();
    let most = (y_level.variance.value * z_level.variance.value).sqrt() * LARGEST_CORRELATION;
    let totals = |level: &Level| level.variance.value + level.error;
    let scale = (totals(y_level) * totals(z_level)).sqrt();
    if units < 4 || !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    // One degree of freedom has gone into each mean.
    let unbiased = units as f64 / (units - 1) as f64;
    let mut found = 0.0;
    for _ in 0..ITERATIONS {
        let (mut score, mut information) = (0.0, 0.0);
        for unit in 0..units {
            let a = y_level.variance.value + y_error[unit];
            let b = z_level.variance.value + z_error[unit];
            let determinant = a * b - found * found;
            if determinant <= 0.0 {
                continue;
            }
            let (y, z) = (y[unit] - y_level.mean.value, z[unit] - z_level.mean.value);
            let product = unbiased * y * z;
            let squares = unbiased * (b * y * y + a * z * z) - 2.0 * found * product;
            score += (found + product) / determinant - found * squares / determinant.powi(2);
            information += (a * b + found * found) / determinant.powi(2);
        }
        if information <= 0.0 {
            break;
        }
        let next = (found + score / information).clamp(-most, most);
        let moved = (next - found).abs();
        found = next;
        if moved <= CLOSE * scale {
            break;
        }
    }
    let freedom = y_level.freedom.min(z_level.freedom);
    let chi = ChiSquared::new(freedom).ok()?;
    let (low, high) = (
        freedom / chi.inverse_cdf(HIGH),
        freedom / chi.inverse_cdf(LOW),
    );
    let correlation = found / scale;
    let (sum, difference) = (2.0 * (1.0 + correlation), 2.0 * (1.0 - correlation));
    let below = libm::hypot(sum * (1.0 - low), difference * (high - 1.0));
    let above = libm::hypot(sum * (high - 1.0), difference * (1.0 - low));
    Some(Interval {
        value: found,
        low: 0.25 * (sum - difference - below) * scale,
        high: 0.25 * (sum - difference + above) * scale,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng::{normal, seeded};

    /// Intervals of 95 % hold the truth in 92 to 98 of 100 fleets, whether a unit's own error is small or as large as what units
    /// differ by.
    #[test]
    fn intervals_hold_the_truth_as_often_as_they_say() {
        const FLEETS: u32 = 2000;
        for (units, error, correlation) in [
            (30, 0.05, 0.0),
            (30, 1.0, 0.7),
            (60, 0.5, -0.9),
            (200, 0.3, 0.5),
            (200, 1.5, 0.3),
        ] {
            let seed = 7;
            let mut rng = seeded(seed);
            let mut held = [0_u32; 3];
            for _ in 0..FLEETS {
                let (mut y, mut z, mut own) = (Vec::new(), Vec::new(), Vec::new());
                for _ in 0..units {
                    let (a, b): (f64, f64) = (normal(&mut rng), normal(&mut rng));
                    let wide: f64 = error * (1.0 + 0.5 * shared::rng::uniform::<f64>(&mut rng));
                    let b = correlation * a + (1.0 - correlation * correlation).sqrt() * b;
                    y.push(3.0 + a + wide * normal::<f64>(&mut rng));
                    z.push(-1.0 + 2.0 * b + wide * normal::<f64>(&mut rng));
                    own.push(wide * wide);
                }
                let (first, second) = (level(&y, &own).unwrap(), level(&z, &own).unwrap());
                let both = covariance((&y, &own, &first), (&z, &own, &second)).unwrap();
                let holds = |found: Interval, truth: f64| {
                    u32::from(found.low <= truth && truth <= found.high)
                };
                held[0] += holds(first.mean, 3.0);
                held[1] += holds(second.variance, 4.0);
                held[2] += holds(both, 2.0 * correlation);
            }
            for (what, held) in ["mean", "variance", "covariance"].iter().zip(held) {
                let percent = 100.0 * f64::from(held) / f64::from(FLEETS);
                assert!(
                    (92.0..=98.0).contains(&percent),
                    "seed {seed}, {units} units, error {error}, correlation {correlation}: {what} {percent} %"
                );
            }
        }
    }

    #[test]
    fn what_does_not_differ_has_no_variance_and_too_little_has_no_level() {
        let found = level(&[1.0; 9], &[0.01; 9]).unwrap();
        assert_eq!((found.mean.value, found.variance.value), (1.0, 0.0));
        assert_eq!(level(&[1.0, 2.0], &[0.0; 2]), None);
        assert_eq!(level(&[1.0, 2.0, f64::NAN], &[0.0; 3]), None);
    }
}
