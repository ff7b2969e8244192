//! How well a count determines a rate.

use servoid_results::schema::proof::{Rate, Share};
use statrs::distribution::{Beta, ContinuousCDF};

/// Chance that the interval misses the rate.
const MISS: f64 = 0.05;

/// So many of so many.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Count {
    /// How many.
    pub hits: u64,
    /// Of how many.
    pub of: u64,
}

impl Count {
    /// How many of `items` pass.
    pub fn of<'a, T: 'a>(
        items: impl IntoIterator<Item = &'a T>,
        test: impl Fn(&T) -> bool,
    ) -> Count {
        let mut count = Count::default();
        for item in items {
            count.of += 1;
            count.hits += u64::from(test(item));
        }
        count
    }

    /// As the answer to a question.
    pub fn share(self, name: &str) -> Share {
        Share {
            name: name.to_owned(),
            count: self.hits,
            of: self.of,
            rate: self.rate(),
        }
    }

    /// The rate with its exact interval (Clopper and Pearson, Biometrika 26, 1934); `None` of nothing.
    pub fn rate(&self) -> Option<Rate> {
        let (hits, misses) = (self.hits as f64, self.of.checked_sub(self.hits)? as f64);
        if self.of == 0 {
            return None;
        }
        let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).ok().map(|law| law.inverse_cdf(p));
        // Both ends are defined as the limits 0 and 1 where the law degenerates.
        let low = quantile(hits, misses + 1.0, 0.5 * MISS).unwrap_or(0.0);
        let high = quantile(hits + 1.0, misses, 1.0 - 0.5 * MISS).unwrap_or(1.0);
        Some(Rate {
            part: hits / self.of as f64,
            low,
            high,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ends of exact intervals, by bisection of the binomial sums in a program of its own.
    const KNOWN: [(u64, u64, f64, f64); 6] = [
        (0, 10, 0.0, 0.308_497),
        (10, 10, 0.691_503, 1.0),
        (5, 10, 0.187_086, 0.812_914),
        (1, 20, 0.001_265, 0.248_733),
        (0, 59, 0.0, 0.060_609),
        (95, 100, 0.887_165, 0.983_568),
    ];

    #[test]
    fn intervals_are_the_known_ones() {
        for (hits, of, low, high) in KNOWN {
            let rate = Count { hits, of }.rate().unwrap();
            assert!((rate.low - low).abs() < 2e-6, "{hits}/{of}: {rate:?}");
            assert!((rate.high - high).abs() < 2e-6, "{hits}/{of}: {rate:?}");
        }
        assert_eq!(Count { hits: 0, of: 0 }.rate(), None);
    }

    #[test]
    fn the_interval_holds_the_rate_and_mirrors() {
        for of in 1..60 {
            for hits in 0..=of {
                let rate = Count { hits, of }.rate().unwrap();
                assert!(0.0 <= rate.low && rate.low <= rate.part);
                assert!(rate.part <= rate.high && rate.high <= 1.0);
                let mirror = Count {
                    hits: of - hits,
                    of,
                }
                .rate()
                .unwrap();
                assert!((rate.low + mirror.high - 1.0).abs() < 1e-9);
            }
        }
    }
}
