//! The numbers that decide about repeats. Those of the commands were chosen on 18 recordings of five waveforms, where repeats differ by
//! nothing and other waveforms by 0.9 and more.

/// RMS difference of two commands that are one, as a part of the command's RMS: measured volts of one command differ a little.
pub const ONE_COMMAND: f64 = 0.03;
/// Part of the longer recording that both must hold.
pub const COMMON: f64 = 0.8;
/// Relative difference of two sample intervals that are one.
pub const ONE_INTERVAL: f64 = 1e-3;
/// Parts of a sample interval by which a sample may lie beside its even place.
pub const EVEN: f64 = 0.5;
/// Fewest windows that say anything.
pub const FEWEST_WINDOWS: usize = 4;
/// Times that the signs of windows are drawn.
pub const FLIPS: usize = 400;
/// Seed of the draws.
pub const SEED: u64 = 1;
/// A model's error is the motor's own repeatability up to so many times it: of a model that a kit's sines confirm it was 1.02, of those
/// that lack friction by direction 1.3 to 1.6 times.
pub const REPEATED: f64 = 1.1;
