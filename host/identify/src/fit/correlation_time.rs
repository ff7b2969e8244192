//! Sum of an error's autocorrelation over the lags at which it is positive (C. J. Geyer, *Statistical Science* 7(4), 473,
//! 1992): for how long the error is correlated with itself.

/// Correlations up to this count as zero.
const NONE: f64 = 0.05;
/// Lags that are all evaluated. Beyond them the step grows with the lag, with straight lines between: a long correlation
/// changes slowly, and an hour's error would take an hour.
const EACH: usize = 400;
/// Steps to the length of a lag beyond [`EACH`].
const PART: usize = 32;

/// Sum of `correlation(lag)` over the lags, samples, from 1 to below `most`, up to the first that counts as zero.
pub fn correlation_sum(most: usize, correlation: impl Fn(usize) -> f64) -> f64 {
    let mut sum = 0.0;
    let (mut lag, mut last) = (1, 1.0);
    let mut step = 1;
    while lag < most {
        let here = correlation(lag);
        if here <= NONE {
            break;
        }
        // The lags between, and this one.
        let between = (step - 1) as f64;
        sum += here + 0.5 * between * (here + last);
        last = here;
        step = if lag < EACH { 1 } else { lag / PART };
        lag += step;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_sum_over_each_lag_within_a_few_thousandths() {
        for decay in [0.5, 3.0, 40.0, 700.0, 9000.0, 1e5] {
            let correlation = |lag: usize| libm::exp(-(lag as f64) / decay);
            let each: f64 = (1..200_000)
                .map(correlation)
                .take_while(|r| *r > NONE)
                .sum();
            let found = correlation_sum(200_000, correlation);
            assert!(
                (found - each).abs() <= 0.01 * each,
                "{decay}: {found} for {each}"
            );
        }
        assert_eq!(correlation_sum(1, |_| 1.0), 0.0);
        assert_eq!(correlation_sum(300, |_| 1.0), 299.0);
    }
}
