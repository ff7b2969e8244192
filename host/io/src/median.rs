//! The usual one of several values: half of them are smaller.

/// The median; of an even number the upper of the middle two, of none nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    if values.is_empty() {
        return None;
    }
    let middle = values.len() / 2;
    Some(*values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// The median time from one sample to the next, s; zero for fewer than two.
pub fn median_interval(time_s: &[f64]) -> f64 {
    let steps = time_s.windows(2).map(|pair| pair[1] - pair[0]);
    median(steps.collect()).unwrap_or(0.0)
}
