//! The recordings with their lost counts put back.

use crate::diagnose::context::Context;
use crate::diagnose::models::{Loss, Losses};
use servoid_engine::problem::Data;

/// Counts lost up to each sample.
pub fn lost(losses: &[Loss], samples: usize) -> Vec<f64> {
    let mut lost = vec![0.0; samples];
    for loss in losses {
        lost[loss.sample] += loss.counts;
    }
    let mut sum = 0.0;
    for value in &mut lost {
        sum += *value;
        *value = sum;
    }
    lost
}

/// The recording with the lost counts put back.
pub fn repaired(data: &Data, losses: &[Loss]) -> Data {
    let mut data = data.clone();
    let lost = lost(losses, data.len());
    for (count, lost) in data.counts.iter_mut().zip(lost) {
        *count += lost;
    }
    data
}

/// Both recordings with the lost counts put back.
pub struct Repaired {
    /// The fitted one.
    pub data: Data,
    /// The held-out one.
    pub held_out: Data,
}

impl Repaired {
    /// Puts the `losses` back.
    pub fn new(context: &Context<'_>, losses: &Losses) -> Self {
        Repaired {
            data: repaired(context.data, &losses.fitted),
            held_out: repaired(context.held_out, &losses.held_out),
        }
    }

    /// What models of them are fitted with.
    pub fn context<'a>(&'a self, of: &Context<'a>) -> Context<'a> {
        of.with_recordings(&self.data, &self.held_out)
    }
}
