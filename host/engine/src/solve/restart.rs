//! What the methods that start over have in common.

use super::Evaluator;

/// Calls `run` with a seed of its own each time, until the budget is spent.
pub(super) fn until_spent<'a>(
    evaluator: &mut Evaluator<'a>,
    seed: u64,
    mut run: impl FnMut(&mut Evaluator<'a>, u64),
) {
    let mut seeds = seeds(seed);
    let mut left = evaluator.left();
    while left > 0 {
        run(evaluator, seeds());
        // A run that evaluates nothing never will: settings that a crate refuses.
        if evaluator.left() == left {
            return;
        }
        left = evaluator.left();
    }
}

/// `seed`, and further ones at the distance that Weyl sequences use, so that the restarts of
/// neighbouring seeds do not coincide.
fn seeds(seed: u64) -> impl FnMut() -> u64 {
    const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;
    let mut next = seed;
    move || {
        let this = next;
        next = next.wrapping_add(GOLDEN);
        this
    }
}

/// Whether all points lie within `tolerance` of the first in every coordinate.
pub(super) fn together(points: &[Vec<f64>], tolerance: f64) -> bool {
    let Some((first, others)) = points.split_first() else {
        return false;
    };
    let close = |other: &Vec<f64>| {
        other
            .iter()
            .zip(first)
            .all(|(a, b)| (a - b).abs() <= tolerance)
    };
    others.iter().all(close)
}
