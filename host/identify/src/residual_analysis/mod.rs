//! Where a model fails: the volts that its equation misses along the measured motion, against everything that
//! could tell why.

mod bins;
mod cumulative;
mod own_volts;
mod signature;
mod spectrum;
pub mod whiteness;

pub use bins::{Against, Bin, Map};
pub use cumulative::{Cumulative, cumulative};
pub use own_volts::own_volts;
pub use signature::{Axis, Signature, signature};
pub use spectrum::{Line, Spectrum};
pub use whiteness::{Correlations, Whiteness, correlations, whiteness};

use crate::error::Error;
use crate::fit::scores::{EquationResidual, equation_residuals, whole};
use servoid_engine::problem::{Candidate, Data, Horizon, StartAngle};
use servoid_engine::simulation::{Method, Simulation};
use servoid_engine::simulation::{Mode, segments};

/// Filter time of the residual, sample intervals: long enough that the encoder's steps do not drown it, short
/// against a motor's time constants.
const FILTER_SAMPLES: f64 = 5.0;
/// The same, s.
fn filter_time(data: &Data) -> f64 {
    FILTER_SAMPLES * data.units.interval
}

/// Shares that differ by less than one part in so many are equal.
const ALIKE: f64 = 40.0;
/// Parts of the recording in which the free run's error is reported.
const PARTS: usize = 8;

/// Where a model fails.
#[derive(Clone, Debug)]
pub struct ResidualAnalysis {
    /// RMS of the volts that the model's equation misses along the measured motion, V.
    pub volts_rms: f64,
    /// What a perfect model would show here, V: the encoder's steps, and what the equation does not follow (the
    /// moments of a reversal, a load behind a spring).
    pub perfect_volts_rms: f64,
    /// The volts against each quantity, the one that explains most of them first.
    pub maps: Vec<Map>,
    /// Lines of the angle's spectrum.
    pub spectrum: Spectrum,
    /// Error of the free run in parts of equal length.
    pub free_run: Vec<Part>,
}

/// Error of the free run in one part of the recording.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Its begin, s after the first sample.
    pub from_s: f64,
    /// Its end, s.
    pub to_s: f64,
    /// Mean of model minus reading, counts.
    pub mean_counts: f64,
    /// RMS, counts.
    pub rms_counts: f64,
}

/// Looks at what `candidate` leaves of `data`. What a perfect model would show is found by letting `complete`, the
/// best that there is, make the readings.
///
/// # Errors
/// Where a model cannot run.
pub fn analyse_residual(
    data: &Data,
    candidate: &Candidate,
    complete: &Candidate,
    method: Method,
) -> Result<ResidualAnalysis, Error> {
    let time = filter_time(data);
    let residuals = equation_residuals(data, candidate, time);
    let perfect_volts_rms = perfect_volts(data, complete, method, time)?;
    let noise = perfect_volts_rms * perfect_volts_rms;
    let mut maps: Vec<Map> = Against::ALL
        .iter()
        .filter_map(|&against| Map::new(against, data, &candidate.machine, &residuals, noise))
        .collect();
    // Shares that are nearly equal stay in the order of the list.
    maps.sort_by_key(|map| -(map.share * ALIKE).round() as i64);
    bins::decompose(&mut maps, data, &candidate.machine, &residuals, noise);
    Ok(ResidualAnalysis {
        volts_rms: rms(&residuals),
        perfect_volts_rms,
        maps,
        spectrum: Spectrum::new(data, &residuals, time),
        free_run: free_run(data, candidate, method)?,
    })
}

impl ResidualAnalysis {
    /// The volts against one quantity, if there was enough to draw it from.
    pub fn map(&self, against: Against) -> Option<&Map> {
        self.maps.iter().find(|map| map.against == against)
    }

    /// The quantity that explains most, if any explains more than chance would. None where a perfect model
    /// would leave as much: the smear of the drawing's own filter correlates with something, too.
    pub fn most(&self) -> Option<&Map> {
        let left = self.volts_rms > NOTICEABLE * self.perfect_volts_rms;
        self.maps.first().filter(|map| left && map.beyond_chance)
    }

    /// The part of the recording in which the free run is worst.
    pub fn worst_part(&self) -> Option<&Part> {
        let parts = self.free_run.iter();
        parts.max_by(|a, b| a.rms_counts.total_cmp(&b.rms_counts))
    }
}

/// A residual is noticed if it is so many times a perfect model's.
const NOTICEABLE: f64 = 1.25;

fn rms(residuals: &[EquationResidual]) -> f64 {
    bins::mean_square(residuals).sqrt()
}

/// What a model leaves of its own readings once they are floored to counts, V RMS.
fn perfect_volts(
    data: &Data,
    complete: &Candidate,
    method: Method,
    time: f64,
) -> Result<f64, Error> {
    if !data.quantised {
        return Ok(0.0);
    }
    let mut own = simulated(data, complete, method)?;
    for sight in &mut own.counts {
        *sight = sight.floor();
    }
    Ok(rms(&equation_residuals(&own, complete, time)))
}

/// The recording as a model makes it: its angles in place of the readings.
pub(crate) fn simulated(data: &Data, candidate: &Candidate, method: Method) -> Result<Data, Error> {
    let mut own = data.clone();
    let simulation = Simulation::new(data, candidate, method)?;
    for segment in segments(data, candidate, &Horizon::Whole, StartAngle::Free) {
        simulation.run(Mode::Free, &segment, &mut own.counts);
    }
    Ok(own)
}

fn free_run(data: &Data, candidate: &Candidate, method: Method) -> Result<Vec<Part>, Error> {
    let errors = whole(data, candidate, method)?;
    let centre = data.half_cell();
    let length = errors.len().div_ceil(PARTS).max(1);
    let parts = errors.chunks(length).enumerate();
    Ok(parts
        .map(|(index, chunk)| {
            let n = chunk.len() as f64;
            let from = index * length;
            let mean = chunk.iter().map(|e| e - centre).sum::<f64>() / n;
            let square = chunk.iter().map(|e| (e - centre).powi(2)).sum::<f64>() / n;
            Part {
                from_s: data.time_s[from],
                to_s: data.time_s[from + chunk.len() - 1],
                mean_counts: mean,
                rms_counts: square.sqrt(),
            }
        })
        .collect())
}

#[cfg(test)]
mod tests;
