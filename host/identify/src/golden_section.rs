//! The least of a function of one number.

use std::ops::Range;

/// Where `cost` is least within `range`, after so many steps of the golden section (Kiefer, "Sequential minimax search for a maximum", 1953).
pub fn golden_section(cost: impl Fn(f64) -> f64, range: Range<f64>, steps: usize) -> f64 {
    const PART: f64 = 0.618_033_988_749_894_9;
    let Range {
        start: mut low,
        end: mut high,
    } = range;
    let (mut a, mut b) = (high - PART * (high - low), low + PART * (high - low));
    let (mut at_a, mut at_b) = (cost(a), cost(b));
    for _ in 0..steps {
        if at_a < at_b {
            (high, b, at_b) = (b, a, at_a);
            a = high - PART * (high - low);
            at_a = cost(a);
        } else {
            (low, a, at_a) = (a, b, at_b);
            b = low + PART * (high - low);
            at_b = cost(b);
        }
    }
    if at_a < at_b { a } else { b }
}
