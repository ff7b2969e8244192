//! Closed-loop replay: a position loop drives the model towards the recorded targets.
//!
//! The volts of a recording of targets follow from the measured angle, so along them the loop does not act on what the model does wrong. Here
//! it acts on the model's own angle, as it does in a simulation that uses the model (L. Ljung, *System Identification*, 2nd ed., 1999, §13.1).

use super::candidate::{Candidate, Method};
use super::single::{Simulation, models, step};
use crate::data::Data;
use servoid_io::recording::PositionDrive;
use shared::error::ModelError;
use shared::model::Model;
use std::f64::consts::TAU;
use std::ops::Range;

/// Instants at which the loop acts in an interval between samples, unless its rate is known to be less.
const INSTANTS: usize = 8;

/// RMS of model minus reading of each recording while its position loop drives the model, counts; `None` for one that no loop drove, and where
/// a model at the loop's instants does not exist, as of a delay of many of them.
pub fn replayed(data: &Data, candidate: &Candidate, method: Method) -> Vec<Option<f64>> {
    let drives = data.recordings.drives();
    if drives.iter().all(Option::is_none) {
        return vec![None; drives.len()];
    }
    let Ok(replay) = Replay::new(data, candidate, method) else {
        return vec![None; drives.len()];
    };
    let each = data.recordings.ranges().zip(drives);
    each.map(|(range, drive)| Some(replay.rms_counts(range, drive.as_ref()?)))
        .collect()
}

/// A model that is driven along a recording of targets.
struct Replay<'a> {
    data: &'a Data,
    simulation: Simulation<'a>,
    /// A model for each length of interval, which steps from instant to instant.
    models: Vec<Model<f64>>,
}

impl<'a> Replay<'a> {
    fn new(data: &'a Data, candidate: &Candidate, method: Method) -> Result<Self, ModelError> {
        Ok(Replay {
            data,
            simulation: Simulation::new(data, candidate, method)?,
            models: models(data, candidate, method, INSTANTS)?,
        })
    }

    fn rms_counts(&self, range: Range<usize>, drive: &PositionDrive) -> f64 {
        let data = self.data;
        let samples = range.len();
        let (first, last) = (range.start, range.end - 1);
        let mut state = (self.simulation).start(first, data.centre(first), data.start_speed(first));
        let (mut squares, mut volts, mut waited_s) = (0.0, 0.0, f64::INFINITY);
        let period_s = drive.control.rate_hz.map_or(0.0, f64::recip);
        for k in range {
            let model = &self.models[data.length_of[k] as usize];
            squares += (model.reading(&state) - data.centre(k)).powi(2);
            if k == last {
                break;
            }
            let instant_s = (data.time_s[k + 1] - data.time_s[k]) / INSTANTS as f64;
            let open = data.is_open(k);
            state.temperature = data.temperature(k);
            for _ in 0..INSTANTS {
                if waited_s + 0.5 * instant_s >= period_s {
                    let reading = model.reading(&state);
                    let read = if data.quantised {
                        reading.floor()
                    } else {
                        reading
                    };
                    let error =
                        (drive.target_counts[k - first] - read) * TAU / data.units.counts_per_rev;
                    volts = drive
                        .control
                        .volts(error, state.motion.speed * data.units.speed);
                    waited_s = 0.0;
                }
                let command = if open { 0.0 } else { volts / data.units.volts };
                step(model, &mut state, command, open);
                waited_s += instant_s;
            }
        }
        (squares / samples as f64).sqrt()
    }
}
