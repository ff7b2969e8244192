//! The numbers of this stage that decide.

use crate::diagnose::models::NOISE_COUNTS;

// both

/// A held-out error of more than so many times the encoder's is no matter of how well parameters are determined.
pub const FAR_HELD_OUT: f64 = 10.0;

// continuation

/// Fewest samples that say anything.
pub const FEWEST: usize = 200;
/// The shortest step is the recording's length over this.
pub const SHORTEST: usize = 1000;
/// Most stretches.
pub const MOST: usize = 30;
/// A model that is lost before this part of the recording is not taken.
pub const FAR: f64 = 0.1;

// descent

/// Most parts to a sample in which a model is run.
pub const FINEST: u16 = 16;
/// Usual step of the finite differences, as a share of the cube's side.
pub const PROBE: f64 = 1e-5;
/// Distance from a wall at which a search that ended there is begun again, as a share of the cube's side.
pub const INSIDE: f64 = 0.02;
/// A second search is the better one if it lowers the sum of squares by more than this part.
pub const BETTER: f64 = 0.02;

// fit

/// A stage that leaves so many times the error of the one before has lost its way.
pub const ASTRAY: f64 = 2.0;
/// A simulation whose error is so many times the series-parallel one's has lost its way.
pub const LOST: f64 = 3.0;
/// Scores under an observer this near are as good as each other.
pub const AS_GOOD: f64 = 0.04;
/// How long errors are remembered, stage by stage.
pub const FIT_MEMORIES_S: [f64; 4] = [0.02, 0.1, 0.5, 2.5];

// observer

/// A model follows the readings if it errs by no more than this, counts RMS.
pub const FOLLOWS: f64 = 3.0 * NOISE_COUNTS;
/// An error is forgotten after so many times the time that it is remembered for.
pub const OBSERVER_SETTLED: f64 = 6.0;

// polish

/// An error is remembered so many times as long as where models are judged, while a model whose free run is chaotic is
/// polished.
pub const POLISHED: f64 = 5.0;
/// Factor between step sizes that are compared.
pub const FINER: u16 = 4;
/// A finer step that changes the RMS error by less is not worth its time: counts.
pub const STEP_ERROR: f64 = 0.02;
/// The same as a part of what an error is above a count: such a model lacks something else.
pub const STEP_PART: f64 = 0.1;

// several_horizons

/// Most rounds. The weights settle in two or three.
pub const ROUNDS: usize = 3;
/// A round that lowers the sum of the errors' logarithms by less is the last.
pub const HORIZONS_SETTLED: f64 = 0.01;
