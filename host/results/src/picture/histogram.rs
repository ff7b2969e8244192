//! Values counted into bins of equal width.

/// Middles and counts of at most `most` bins from the least to the greatest value; fewer where fewer values differ.
pub(super) fn histogram(values: &[f64], most: usize) -> (Vec<f64>, Vec<usize>) {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if !(low.is_finite() && high.is_finite()) {
        return (Vec::new(), Vec::new());
    }
    // Differences of sample times carry rounding in their last digits.
    if high - low <= 1e-9 * high.abs() {
        return (vec![0.5 * (low + high)], vec![values.len()]);
    }
    let many = most.max(1);
    let width = (high - low) / many as f64;
    let mut counts = vec![0; many];
    for value in values {
        let bin = ((value - low) / width) as usize;
        counts[bin.min(many - 1)] += 1;
    }
    let middles = (0..many).map(|k| low + (k as f64 + 0.5) * width).collect();
    (middles, counts)
}

#[cfg(test)]
mod tests {
    use super::histogram;

    #[test]
    fn every_value_is_counted_once_and_none_gives_no_bins() {
        for values in [
            vec![],
            vec![1.0],
            vec![1.0, 1.0 + 1e-12],
            vec![-3.0, 0.0, 5.0, 5.0],
        ] {
            let (middles, counts) = histogram(&values, 7);
            assert_eq!(counts.iter().sum::<usize>(), values.len(), "{values:?}");
            assert_eq!(middles.len(), counts.len());
            assert!(middles.iter().all(|x| x.is_finite()));
        }
    }
}
