//! Limits on both sides.

use std::ops::Range;

pub fn within(what: &str, value: f64, limits: Range<f64>) {
    assert!(
        limits.contains(&value),
        "{what}: {value}, expected {limits:?}"
    );
}
