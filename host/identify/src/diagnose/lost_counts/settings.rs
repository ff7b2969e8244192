//! The numbers of this stage that decide.

// detect

/// Fewer clear losses than this, and single counts are not looked for.
pub const FEWEST_CLEAR: usize = 2;
/// Samples to each side of a change of level within which it must be a jump.
pub const AROUND: usize = 32;
/// Least height of such a jump, counts.
pub const HEIGHT: f64 = 0.6;
/// Mean square of the encoder's own error.
pub const NOISE: f64 = 1.0 / 12.0;
/// Largest error beside a jump, counts.
pub const LARGEST: f64 = 1.0;
/// By how much a smooth course must explain a jump worse, in the encoder's mean squares.
pub const WORSE: f64 = 9.0;
/// A shaft that is slower than this many counts a sample loses none.
pub const MOVES: f64 = 0.1;
/// Rounds over all samples: what was hidden by a loss nearby is seen when that is taken away.
pub const ROUNDS: usize = 4;
/// Two readings' quantisation, and that of the slope around them.
pub const SPREAD: f64 = 1.6;

// fit_influence

/// Step of the finite differences, as a share of the cube's side.
pub const STEP: f64 = 1e-5;
/// Rounds of reweighting.
pub const INFLUENCE_ROUNDS: usize = 8;
/// Differences below this many counts are as good as none: two readings' quantisation.
pub const QUANTUM: f64 = 0.4;
/// Damping of the shift, relative: a direction that does nothing is left alone.
pub const DAMPING: f64 = 1e-9;

// jump_sizes

/// RMS error, counts, up to which the model is right but for its parameters and the jumps.
pub const RIGHT: f64 = 0.45;
/// Damping, relative.
pub const SIZES_DAMPING: f64 = 1e-9;

// levels

/// Most levels; a residual that needs more is not near the encoder's own error.
pub const MOST: usize = 48;
/// What a change of level costs, as a logarithm of odds: about one change in a thousand samples, of any of ten
/// sizes.
pub const CHANGE: f64 = 9.0;
/// Samples that are averaged where the levels' common fraction is looked for: readings alone spread evenly
/// over a whole count, and have none.
pub const AVERAGED: usize = 24;

// rate

/// Thresholds that are tried, as parts of the fastest speed.
pub const THRESHOLDS: usize = 40;
/// Gain in the log likelihood that a threshold must bring: about two standard deviations.
pub const EARNED: f64 = 2.0;

// lost_counts

/// Most rounds of finding and fitting.
pub const REPAIR_ROUNDS: usize = 6;
/// RMS error on the fitted recording, counts, that a last fit may bring down to the encoder's own.
pub const PROMISING: f64 = 1.0;
/// RMS error, counts, up to which smaller ones are believed.
pub const NEAR: f64 = 0.4;
/// Fewest samples for each loss: what jumps more often is no loss.
pub const SAMPLES_EACH: usize = 40;
