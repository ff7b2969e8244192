//! The numbers of the walk.

/// Most effects of a set.
pub const MOST_EFFECTS: usize = 5;
/// Most rings of neighbours.
pub const MOST_RINGS: usize = 8;
/// Nats by which the best must rise for its noise to be estimated once more.
pub const SETTLED_NATS: f64 = 2.0;
/// Sets within so many nats of the best are as probable as it: one class.
pub const CLASS_NATS: f64 = 3.0;
/// Nodes that are let converge at a time.
pub const LEADERS: usize = 6;
/// Most times that the leaders change by it.
pub const ROUNDS: usize = 4;
/// A node so many nats behind the best is not let converge, if that is more than this part of what the best gains over the linear
/// motor, too: a rough fit lacks less.
pub const FAR_NATS: f64 = 300.0;
/// See [`FAR_NATS`].
pub const FAR_PART: f64 = 0.1;
/// Best sets of which free runs are made at the end.
pub const FINALISTS: usize = 12;
/// Neighbours of a ring that are fitted: those that start with the best scores.
pub const PROMISING: usize = 10;
/// Estimates of the noise under the last model, each from where the one before ended.
pub const NOISE_ROUNDS: usize = 2;
/// Where whole runs tell that something is missing, the best nodes of each size from which the walk goes on.
pub const BEAM: usize = 3;
/// Rings that leave something unexplained before an effect that costs much to simulate is tried.
pub const PATIENCE: usize = 2;
/// A simpler set is polished beside one that explains the recording if the logarithm of its errors' product is behind by no more than this.
pub const NEAR: f64 = 3.0;

// answer

/// Most models that are shown beside a step.
pub const CANDIDATES: usize = 12;

// forms

/// Part of what a form must remove that its trial has to remove, since it ends before it has converged.
pub const FORM_PROMISING: f64 = 0.5;
