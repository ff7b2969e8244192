//! Residuals: model minus reading over a horizon, and their root mean square.

use crate::data::Data;
use crate::simulation::{Candidate, Horizon, Method, Simulation, StartAngle, segments};
use shared::cost::Cost;
use shared::error::ModelError;

/// Offset that is added to an error before the cost, counts: costs expect the distance above a floored reading, and an
/// analogue reading is the angle itself.
pub(crate) fn reading_shift(data: &Data) -> f64 {
    if data.quantised {
        0.0
    } else {
        shared::encoder::FLOOR_OFFSET_COUNTS
    }
}

/// Model minus reading of a candidate over a horizon, counts, one entry a sample; see [`FitProblem::errors`](super::FitProblem::errors).
///
/// # Errors
/// Parameters from which no model can be made.
pub fn errors(
    data: &Data,
    candidate: &Candidate,
    method: Method,
    horizon: &Horizon,
    start_angle: StartAngle,
    cost: Cost,
) -> Result<Vec<f64>, ModelError> {
    let simulation = Simulation::new(data, candidate, method)?;
    let segments = segments(data, candidate, horizon, start_angle);
    let mut errors = simulation.errors(horizon.mode(), &segments);
    centre(data, candidate, horizon, start_angle, cost, &mut errors);
    Ok(errors)
}

/// Whether the errors are shifted by a free start angle.
pub(super) fn is_centred(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
) -> bool {
    // Where effects depend on the angle it is absolute, and a shift would be one freedom too many.
    let absolute = data.quantised && candidate.needs_angle();
    *horizon == Horizon::Whole && start_angle == StartAngle::Free && !absolute
}

/// Shifts the errors of each recording to its best start angle where it is free: the median for absolute costs, else the mean.
pub(super) fn centre(
    data: &Data,
    candidate: &Candidate,
    horizon: &Horizon,
    start_angle: StartAngle,
    cost: Cost,
    errors: &mut [f64],
) {
    if *horizon != Horizon::Whole || start_angle != StartAngle::Free {
        return;
    }
    let centre = data.centre(0) - data.counts[0];
    // Only the first recording's start angle can be an unknown of the model.
    let known = usize::from(!is_centred(data, candidate, horizon, start_angle));
    let ranges = data.recordings.ranges().skip(known);
    for range in ranges.filter(|range| !range.is_empty()) {
        let errors = &mut errors[range];
        let middle = match cost {
            Cost::Absolute { .. } => median(errors),
            Cost::Squared | Cost::Interval { .. } => mean(errors),
        };
        for error in errors {
            *error += centre - middle;
        }
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    let middle = sorted.len() / 2;
    *sorted.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// Root mean square of model minus measurement, in counts, where the measurement is the centre of
/// the cell that was read.
pub fn rms_counts(data: &Data, errors: &[f64]) -> f64 {
    let centre = if data.quantised {
        shared::encoder::FLOOR_OFFSET_COUNTS
    } else {
        0.0
    };
    let sum: f64 = errors.iter().map(|e| (e - centre) * (e - centre)).sum();
    Cost::rms(sum, errors.len())
}
