//! Finds the places where a residual jumps by whole counts and stays.
//!
//! A jump must be all between two neighbouring samples, with nothing but the encoder's own error to both
//! sides of it; a smooth course must explain it much worse; and it must be of a loss: model minus reading
//! rises in the direction of motion.

use super::levels::changes;
use super::settings::{AROUND, FEWEST_CLEAR, HEIGHT, LARGEST, MOVES, NOISE, ROUNDS, SPREAD, WORSE};
use super::step::{beside, filter, filtered, smooth, with_step};
use crate::diagnose::models::Loss;

/// A window and what must be seen in it.
struct Scale {
    /// Samples to each side.
    half: usize,
    /// Degree of the smooth course beside the step.
    degree: usize,
    /// Least height, counts.
    least: f64,
}

/// Large losses, even close to each other, then ordinary ones.
const CLEAR: [Scale; 2] = [
    Scale {
        half: 5,
        degree: 1,
        least: 3.0,
    },
    Scale {
        half: 16,
        degree: 3,
        least: 1.5,
    },
];
/// Single counts.
const FINE: Scale = Scale {
    half: 32,
    degree: 1,
    least: 0.65,
};

/// RMS error beside a jump, counts, and three standard deviations of it for a window of one sample.
const BESIDE: (f64, f64) = (0.33, 1.35);
/// How small the losses are that are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Down to single counts: for a model that is right but for them.
    Single,
    /// Only what is clear whatever else the model lacks.
    Clear,
}

/// Losses in `y`, model minus reading, where the model moves by `speed` counts before each sample. `None` where
/// single counts cannot be told, since the rest is far from the encoder's own error.
pub fn losses(y: &[f64], speed: &[f64], depth: Depth) -> Option<Vec<Loss>> {
    let mut rest = y.to_vec();
    let mut found: Vec<Loss> = Vec::new();
    for scale in &CLEAR {
        scale.take(&mut rest, speed, &mut found);
    }
    if depth == Depth::Clear {
        return Some(joined(found));
    }
    if found.len() >= FEWEST_CLEAR {
        FINE.take(&mut rest, speed, &mut found);
    }
    let direction = |k: usize| {
        if speed[k].abs() < MOVES {
            0
        } else {
            speed[k].signum() as i8
        }
    };
    let changes = changes(&rest, direction)?;
    let change = |(sample, counts)| Loss { sample, counts };
    found.extend(changes.into_iter().map(change));
    Some(confirmed(y, speed, joined(found)))
}

/// Those of the losses that are jumps in `y`, all others taken for true: a drift that crosses from one level
/// to the next is none.
fn confirmed(y: &[f64], speed: &[f64], mut losses: Vec<Loss>) -> Vec<Loss> {
    loop {
        let jumps: Vec<Option<Loss>> = (0..losses.len())
            .map(|i| jump(y, speed, &losses, i))
            .collect();
        let before = losses.len();
        losses = jumps.into_iter().flatten().collect();
        if losses.len() == before {
            return losses;
        }
    }
}

/// Loss `index` with its own height, if it is a jump.
fn jump(y: &[f64], speed: &[f64], losses: &[Loss], index: usize) -> Option<Loss> {
    let sample = losses[index].sample;
    let window = sample.saturating_sub(AROUND)..(sample + AROUND).min(y.len());
    let others: Vec<usize> = losses
        .iter()
        .map(|loss| loss.sample)
        .filter(|&at| at != sample && at > window.start && at < window.end)
        .collect();
    let found = beside(y, window, sample, &others, 1)?;
    let counts = found.height.round();
    (counts * speed[sample].signum() > 0.0 && found.height.abs() > HEIGHT)
        .then_some(Loss { sample, counts })
}

/// In order, those of one sample as one.
fn joined(mut found: Vec<Loss>) -> Vec<Loss> {
    found.sort_by_key(|loss| loss.sample);
    let mut losses: Vec<Loss> = Vec::with_capacity(found.len());
    for loss in found {
        match losses.last_mut() {
            Some(last) if last.sample == loss.sample => last.counts += loss.counts,
            _ => losses.push(loss),
        }
    }
    losses
}

impl Scale {
    /// Moves what it finds from `rest` to `found`, the largest first.
    fn take(&self, rest: &mut [f64], speed: &[f64], found: &mut Vec<Loss>) {
        let filter = filter(self.half, self.degree);
        for _ in 0..ROUNDS {
            let before = found.len();
            for at in self.candidates(rest, speed, &filter) {
                if let Some(loss) = self.loss(rest, speed, at) {
                    for value in &mut rest[loss.sample..] {
                        *value -= loss.counts;
                    }
                    found.push(loss);
                }
            }
            if found.len() == before {
                return;
            }
        }
    }

    /// Samples where a jump with the motion is the largest around, largest first.
    fn candidates(&self, y: &[f64], speed: &[f64], filter: &[f64]) -> Vec<usize> {
        let height = |at: usize| -> f64 {
            if speed[at].abs() < MOVES {
                return 0.0;
            }
            filtered(y, at, filter).map_or(0.0, |height| height * speed[at].signum())
        };
        let heights: Vec<f64> = (0..y.len()).map(height).collect();
        let mut places: Vec<usize> = (2..y.len().saturating_sub(2))
            .filter(|&at| {
                let here = heights[at];
                here >= self.least
                    && heights[at - 2..=at + 2].iter().all(|h| *h <= here)
                    && jumps(y, at) >= here - SPREAD
            })
            .collect();
        places.sort_by(|&a, &b| heights[b].total_cmp(&heights[a]).then(a.cmp(&b)));
        places
    }

    /// The loss just before sample `at` or next to it, if it is one.
    fn loss(&self, y: &[f64], speed: &[f64], at: usize) -> Option<Loss> {
        let window = at.checked_sub(self.half)?..at + self.half;
        if window.end > y.len() {
            return None;
        }
        let (sample, step) = (at - 1..=at + 1)
            .filter_map(|k| Some((k, with_step(y, window.clone(), k, self.degree)?)))
            .min_by(|a, b| a.1.squares.total_cmp(&b.1.squares))?;
        let samples = window.len() as f64;
        let limit = BESIDE.0 * (1.0 + BESIDE.1 / samples.sqrt());
        let counts = step.height.round();
        let lost = step.height * speed[sample].signum() >= self.least
            && counts != 0.0
            && step.squares < limit * limit * samples
            && step.largest < LARGEST
            && smooth(y, window)? - step.squares > WORSE * NOISE;
        lost.then_some(Loss { sample, counts })
    }
}

/// How much the residual jumps before a sample or one next to it, beyond what it does around there.
fn jumps(y: &[f64], at: usize) -> f64 {
    (at.max(3) - 1..=(at + 1).min(y.len() - 3))
        .map(|k| {
            let around = 0.25 * ((y[k - 1] - y[k - 3]) + (y[k + 2] - y[k]));
            ((y[k] - y[k - 1]) - around).abs()
        })
        .fold(0.0, f64::max)
}
