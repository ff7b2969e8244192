//! The cost of a model: its distance from the recording.

use crate::encoder::{FLOOR_OFFSET_COUNTS, FLOOR_RMS_COUNTS};
use crate::model::{Model, State};
use crate::recording::Recording;
use crate::scalar::{ErrorValue, Readable, Scalar};

/// What a sample costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Cost {
    /// Integral of the absolute error, as the paper's IAE. The reading is floored; the model is
    /// floored too ("QQ": the truth costs nothing) or not ("QU", the paper's figures: the truth
    /// costs half a count throughout, and the optimum is biased).
    Absolute {
        /// Whether the model's angle is floored before it is compared.
        model_floored: bool,
    },
    /// Squared distance from the centre of the count's cell.
    Squared,
    /// Negative log likelihood that the angle, with normal noise of this many counts, lies in the
    /// cell of the count that was read: the likelihood of a quantised reading.
    Interval {
        /// Standard deviation of the noise before quantisation, counts.
        noise_counts: f64,
    },
}

impl Cost {
    /// Cost of one sample.
    #[inline(always)]
    pub fn sample<E: ErrorValue>(self, error: E) -> E {
        match self {
            Cost::Absolute {
                model_floored: false,
            } => error.abs(),
            Cost::Absolute {
                model_floored: true,
            } => error.floor().abs(),
            Cost::Squared => (error + E::from_f64(-FLOOR_OFFSET_COUNTS)).squared(),
            Cost::Interval { noise_counts } => {
                E::from_f64(interval_surprise(error.to_f64(), noise_counts))
            }
        }
    }

    /// RMS in counts of a squared-error sum over `samples`.
    pub fn rms(sum: f64, samples: usize) -> f64 {
        libm::sqrt(sum / (samples.max(1)) as f64)
    }
}

/// `−ln P(reading | angle)` where the angle lies `error` counts above the floored reading.
fn interval_surprise(error: f64, noise: f64) -> f64 {
    let noise = noise.max(1e-3 * FLOOR_RMS_COUNTS);
    // By symmetry about the centre of the cell.
    let beyond = (error - FLOOR_OFFSET_COUNTS).abs() - FLOOR_OFFSET_COUNTS;
    let z = beyond / noise;
    let width = 1.0 / noise;
    if z < 5.0 {
        let tail = |x: f64| 0.5 * libm::erfc(x * core::f64::consts::FRAC_1_SQRT_2);
        -libm::log(tail(z) - tail(z + width))
    } else {
        // Tail of the normal distribution (Abramowitz, Stegun 26.2.12): no underflow, and smooth.
        let square = z * z;
        0.5 * square + libm::log(z) + 0.918_938_533_204_672_7 + 1.0 / (square + 2.0)
    }
}

/// A cost, or the partial sum that exceeded the limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sum<E> {
    /// Sum over the samples that were run.
    pub value: E,
    /// Samples that were run.
    pub samples: usize,
    /// Whether that is all of them.
    pub complete: bool,
}

/// Runs `model` from `start` along the recording and sums the cost, until the end or until it
/// exceeds `limit`: an optimiser that only compares costs loses nothing by stopping there.
pub fn evaluate<S: Scalar<Angle: Readable<S>>>(
    model: &Model<S>,
    start: State<S>,
    recording: &Recording<'_, S>,
    cost: Cost,
    limit: Option<<S::Angle as Readable<S>>::Error>,
) -> Sum<<S::Angle as Readable<S>>::Error> {
    let mut state = start;
    let mut value = Default::default();
    for k in 0..recording.len() {
        value = value + cost.sample(model.reading(&state).minus(recording.counts[k]));
        if limit.is_some_and(|limit| value > limit) {
            return Sum {
                value,
                samples: k + 1,
                complete: false,
            };
        }
        if let Some(temperature) = recording.temperature_at(k) {
            state.temperature = temperature;
        }
        model.step(&mut state, recording.command[k], recording.is_open(k));
    }
    Sum {
        value,
        samples: recording.len(),
        complete: true,
    }
}
