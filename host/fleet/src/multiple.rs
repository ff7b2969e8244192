//! Many tests at a time.

/// Which of the hypotheses are rejected at false discovery rate `rate` (Benjamini and Hochberg, 1995).
pub(crate) fn discoveries(p: &[f64], rate: f64) -> Vec<bool> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let bound = |rank: usize| rate * (rank + 1) as f64 / p.len() as f64;
    let last = (0..order.len())
        .rev()
        .find(|&rank| p[order[rank]] <= bound(rank));
    let mut rejected = vec![false; p.len()];
    for &test in &order[..last.map_or(0, |last| last + 1)] {
        rejected[test] = true;
    }
    rejected
}

/// Makes the p-values of tests hold for all of them together.
pub(crate) fn adjust<T>(tests: &mut [T], p_value: impl Fn(&mut T) -> &mut f64) {
    let own: Vec<f64> = tests.iter_mut().map(|test| *p_value(test)).collect();
    for (test, adjusted) in tests.iter_mut().zip(holm(&own)) {
        *p_value(test) = adjusted;
    }
}

/// p-values that hold for all tests together (Holm, 1979).
fn holm(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut adjusted = vec![1.0; p.len()];
    let mut most: f64 = 0.0;
    for (rank, &test) in order.iter().enumerate() {
        most = most.max(p[test] * (p.len() - rank) as f64).min(1.0);
        adjusted[test] = most;
    }
    adjusted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_nothing_hidden_few_are_rejected_and_of_something_all() {
        let even: Vec<f64> = (0..1000).map(|k| (f64::from(k) + 0.5) / 1000.0).collect();
        assert!(!discoveries(&even, 0.05).contains(&true));
        let mut mixed = even;
        mixed.extend([1e-12; 10]);
        let found = discoveries(&mixed, 0.05);
        assert!(found[1000..].iter().all(|&found| found));
        assert!(found[..1000].iter().filter(|&&found| found).count() <= 1);
        assert!(discoveries(&[], 0.05).is_empty());
    }

    #[test]
    fn adjusted_values_are_the_published_ones() {
        let adjusted = holm(&[0.01, 0.04, 0.03, 0.005]);
        let expected = [0.03, 0.06, 0.06, 0.02];
        for (found, expected) in adjusted.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{adjusted:?}");
        }
    }
}
