//! The most likely course of a residual that stays on levels a whole number of counts apart.

use super::settings::{AVERAGED, CHANGE, MOST};

/// Changes of level in `y`, of which those with the direction of motion are allowed (`direction` is 1, −1, or 0
/// for a shaft at rest): samples and sizes, in order. `None` where the levels are too many. Exact, by dynamic
/// programming (A. J. Viterbi, *IEEE Trans. Inf. Theory* 13, 260, 1967, doi:10.1109/TIT.1967.1054010).
pub fn changes(y: &[f64], direction: impl Fn(usize) -> i8) -> Option<Vec<(usize, f64)>> {
    let fraction = fraction(y);
    let (low, high) = y
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &v| {
            (l.min(v), h.max(v))
        });
    let lowest = (low - fraction).round();
    let count = (high - fraction).round() - lowest + 1.0;
    if !(count >= 1.0 && count <= MOST as f64) {
        return None;
    }
    let count = count as usize;
    // Squares in the encoder's own mean squares, halved: a logarithm of likelihood.
    let misfit =
        |value: f64, level: usize| 6.0 * (value - fraction - lowest - level as f64).powi(2);
    let mut cost: Vec<f64> = (0..count).map(|level| misfit(y[0], level)).collect();
    let mut from = vec![0u8; y.len() * count];
    for (k, &value) in y.iter().enumerate().skip(1) {
        let came = &mut from[k * count..(k + 1) * count];
        for (level, came) in came.iter_mut().enumerate() {
            *came = level as u8;
        }
        let direction = direction(k);
        if direction != 0 {
            let mut best = (f64::INFINITY, 0u8);
            for i in 0..count {
                let level = if direction > 0 { i } else { count - 1 - i };
                let here = cost[level];
                if best.0 + CHANGE < here {
                    cost[level] = best.0 + CHANGE;
                    came[level] = best.1;
                }
                if here < best.0 {
                    best = (here, level as u8);
                }
            }
        }
        for (level, cost) in cost.iter_mut().enumerate() {
            *cost += misfit(value, level);
        }
    }
    let mut level = (0..count).min_by(|&a, &b| cost[a].total_cmp(&cost[b]))?;
    let mut changes = Vec::new();
    for k in (1..y.len()).rev() {
        let before = usize::from(from[k * count + level]);
        if before != level {
            changes.push((k, level as f64 - before as f64));
            level = before;
        }
    }
    changes.reverse();
    Some(changes)
}

/// The part of a count that all levels have in common: the direction in which the averages' phases point.
fn fraction(y: &[f64]) -> f64 {
    let (mut sine, mut cosine) = (0.0, 0.0);
    for window in y.windows(AVERAGED) {
        let mean = window.iter().sum::<f64>() / AVERAGED as f64;
        let (s, c) = libm::sincos(core::f64::consts::TAU * mean);
        sine += s;
        cosine += c;
    }
    libm::atan2(sine, cosine) / core::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;
    use shared::rng::{self, Generator};

    #[test]
    fn changes_between_noisy_levels_are_found_where_they_are() {
        for seed in 0..20 {
            let mut draws: Generator = rng::seeded(seed);
            let mut truth = Vec::new();
            let mut level = rng::uniform::<f64>(&mut draws);
            let up = |k: usize| (k / 500).is_multiple_of(2);
            let y: Vec<f64> = (0..5000)
                .map(|k| {
                    // Now and then two close to each other.
                    if k % 100 == 50 || k % 300 == 55 {
                        let size = f64::from(1 + rng::below(&mut draws, 3));
                        let size = if up(k) { size } else { -size };
                        truth.push((k, size));
                        level += size;
                    }
                    level + rng::uniform::<f64>(&mut draws) - 0.5
                })
                .collect();
            let found = changes(&y, |k| if up(k) { 1 } else { -1 }).unwrap();
            let near = |a: &(usize, f64), b: &(usize, f64)| a.0.abs_diff(b.0) <= 1 && a.1 == b.1;
            let hits = truth
                .iter()
                .filter(|t| found.iter().any(|f| near(f, t)))
                .count();
            assert!(
                hits * 20 >= truth.len() * 19 && found.len() <= truth.len() + 2,
                "seed {seed}: {hits} of {}, {} found",
                truth.len(),
                found.len()
            );
        }
    }
}
