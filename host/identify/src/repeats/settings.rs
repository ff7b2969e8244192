//! The numbers that decide about repeats. Those of the commands were chosen on 18 recordings of five waveforms, where repeats differ by
//! nothing and other waveforms by 0.9 and more.

/// RMS difference of two commands that are one, as a part of the command's RMS: measured volts of one command differ a little.
pub const ONE_COMMAND: f64 = 0.03;
/// The same within one recording, as a part of what unrelated values of the same spread would differ by.
pub const ONE_PERIOD: f64 = 0.03;
/// RMS difference beyond which a command is another, in the same parts: a lag below it that was never left is no period but a slow command.
pub const ANOTHER_PERIOD: f64 = 0.3;
/// Values of a command that tell at most lags that it is another.
pub const FEW_VALUES: usize = 256;
/// Shortest run that periods are taken together to, s: as long as the fewest windows of usual length.
pub const SHORTEST_S: f64 = 2.0;
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
