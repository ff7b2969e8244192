//! The numbers that decide whether a recording begins at another angle of the shaft. Measured on recordings of the bench with one effect each, three
//! seeds, the second recording as it was and with its counts shifted. Cogging and unbalance explained 26 to 97 % of what the motor with Coulomb
//! friction left, by one wave or by one and its side lobes at up to 16 %; a Stribeck curve showed chance waves of 5 to 8 %.

/// Part of the equation's residual that a wave must explain in both recordings to be compared: an unbalance beside friction half as large again explained
/// 7 % of what its poor start left, and a false wave turns nothing, since no model errs less by it.
pub const CLEAR: f64 = 0.03;
/// The same, parts of what the clearest wave explains: what is less may be its side lobe.
pub const BESIDE: f64 = 0.5;
/// Angles that are tried for each wave of the highest order.
pub const TRIED_PER_WAVE: usize = 32;
/// Agreement of the waves at the angle that is found, 1 where they are the same. It was 0.990 and more where one was there; 0.8 leaves an amplitude
/// a factor of two.
pub const AGREE: f64 = 0.8;
/// Agreement from which on recordings are taken as they were read, at once: 8 degrees of a wave. It was 0.997 and more where nothing was shifted; of
/// encoders that were zeroed anywhere one in twenty lies within.
pub const ALIKE: f64 = 0.99;
/// Runs of the recording that a fit of the model may take: it need not converge over detents, where its run is held to the readings.
pub const RUNS: u64 = 500;
/// Farthest that the angle by a fitted model is from that by the waves, parts of a wave of the highest order.
pub const REACH: f64 = 0.25;
/// Steps of the golden section to it: to a thousandth of its reach.
pub const STEPS: usize = 16;
/// The run of the model is held to the readings so that an error is forgotten within this time, s: over detents a free run is chaotic.
pub const MEMORY_S: f64 = 0.1;
/// A recording is turned where the error falls below this part of what it is as the angles were read, and of what a model without the waves leaves. At
/// 0.8 a Stribeck curve once passed for a cogging torque of order 9.
pub const BETTER: f64 = 0.5;
/// And by more than so many counts: where in its cell a reading lies is found elsewhere.
pub const LEAST_COUNTS: f64 = 1.0;
/// Samples of a recording, from its first, that are looked at: they take 0.1 s, and 60,000 of them made a fit of two such logs take 0.85 s for 0.55 s.
pub const MOST_SAMPLES: usize = 20_000;
