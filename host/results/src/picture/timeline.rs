//! Measured against model over time, the residual beneath with the quantiser's band, and the command. The page thins
//! the series for what is seen of them; here they are whole.

use super::{Drawing, Picture, colour};
use crate::error::Error;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::{Serialize, Serializer};
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use servoid_identify::fit::scores::whole;
use servoid_identify::fit::validation_errors;
use servoid_io::channel::Measured;
use servoid_io::recording::Drive;
use shared::encoder::FLOOR_RMS_COUNTS;

/// Samples of a page that stands alone; more are thinned before they go into it.
pub const IN_A_FILE: usize = 400_000;

/// A model's free run along a recording.
pub struct Run {
    /// Its name, as in `linear motor`.
    pub name: String,
    /// Model minus measured, counts, so that half a count is the encoder's own.
    pub residual: Vec<f64>,
}

impl Run {
    /// A model's run along the recording that it was fitted to.
    ///
    /// # Errors
    /// Where the model cannot run.
    pub fn fitted(
        name: &str,
        data: &Data,
        candidate: &Candidate,
        method: Method,
    ) -> Result<Self, Error> {
        Ok(Run::new(name, data, &whole(data, candidate, method)?))
    }

    /// A model's run along a recording that it has not seen, from the start that this one agrees with best.
    ///
    /// # Errors
    /// Where the model cannot run.
    pub fn held_out(
        name: &str,
        data: &Data,
        candidate: &Candidate,
        method: Method,
    ) -> Result<Self, Error> {
        Ok(Run::new(
            name,
            data,
            &validation_errors(data, candidate, method)?,
        ))
    }

    fn new(name: &str, data: &Data, errors: &[f64]) -> Self {
        let centre = data.half_cell();
        Run {
            name: name.to_owned(),
            residual: errors.iter().map(|error| error - centre).collect(),
        }
    }
}

/// What the page draws; names are those of its script.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub struct Timeline {
    time: Times,
    /// Counts from the first reading.
    measured: Packed,
    counts_per_rev: f64,
    runs: Vec<PackedRun>,
    command: Packed,
    command_name: &'static str,
    current: Option<Packed>,
    /// Half a count either way if the readings are floored.
    band: f64,
    held_out_from: Option<f64>,
    /// Where the last run fails most, s, if it fails anywhere.
    worst: Option<(f64, f64)>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
enum Times {
    /// Seconds between samples, and their number.
    Even(f64, usize),
    /// Seconds of each sample.
    Each(#[serde(serialize_with = "wide")] Vec<f64>),
}

#[derive(Serialize)]
struct PackedRun {
    name: String,
    colour: &'static str,
    residual: Packed,
}

/// Numbers as the base64 of little-endian f32.
struct Packed(Vec<f32>);

impl Serialize for Packed {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let bytes: Vec<u8> = self.0.iter().flat_map(|x| x.to_le_bytes()).collect();
        serializer.serialize_str(&STANDARD.encode(bytes))
    }
}

fn wide<S: Serializer>(values: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    let bytes: Vec<u8> = values.iter().flat_map(|x| x.to_le_bytes()).collect();
    serializer.serialize_str(&STANDARD.encode(bytes))
}

/// Draws `runs` along `data`, with `most` samples. `held_out_from` is where the part begins that was not fitted, s.
pub fn timeline(
    id: &str,
    title: &str,
    data: &Data,
    runs: &[Run],
    held_out_from: Option<f64>,
    most: usize,
) -> Picture {
    let drawn = drawn(data.len(), runs, most);
    let pick = |of: &dyn Fn(usize) -> f64| Packed(drawn.iter().map(|&k| of(k) as f32).collect());
    let names = [colour::BASE, colour::MODEL, colour::OTHER];
    let packed = runs.iter().enumerate().map(|(k, run)| PackedRun {
        name: run.name.clone(),
        // A model alone has the colour of the best one.
        colour: if runs.len() == 1 {
            colour::MODEL
        } else {
            names[k % names.len()]
        },
        residual: pick(&|k| run.residual[k]),
    });
    let interval = data.units.interval;
    let even = drawn.len() == data.len()
        && (data.time_s.iter().enumerate())
            .all(|(k, t)| (t - k as f64 * interval).abs() < 1e-3 * interval);
    let timeline = Timeline {
        time: if even {
            Times::Even(interval, data.len())
        } else {
            Times::Each(drawn.iter().map(|&k| data.time_s[k]).collect())
        },
        measured: pick(&|k| data.counts[k] - data.counts[0]),
        counts_per_rev: data.units.counts_per_rev,
        runs: packed.collect(),
        command: pick(&|k| data.command[k] * data.units.volts),
        command_name: match data.drive {
            Drive::Voltage => "drive, V",
            Drive::Current => "drive, A",
            Drive::Torque => "drive, N·m",
        },
        current: (data.measured.get(Measured::Current)).map(|current| pick(&|k| current[k])),
        band: if data.quantised { 0.5 } else { 0.0 },
        held_out_from,
        worst: runs.last().and_then(|run| worst(data, run)),
    };
    let thinned = if drawn.len() < data.len() {
        format!(
            " Of {} samples the extremes of {} blocks are drawn; the fit took all.",
            data.len(),
            drawn.len() / 2
        )
    } else {
        String::new()
    };
    Picture {
        id: id.to_owned(),
        title: title.to_owned(),
        caption: format!(
            "The shaft's angle as measured and as the model runs on its own from the start; beneath, model less \
             measured with the band of half a count that the encoder alone leaves (the stretch in which the best model \
             fails most is tinted), and the command. Drag to zoom, double click for the whole; click for cursor A, with \
             shift for B.{thinned}"
        ),
        drawing: Drawing::Timeline(Box::new(timeline)),
        table: None,
    }
}

/// Stretches of a recording that are compared.
const STRETCHES: usize = 24;
/// The worst one is marked where it has so many times the encoder's own error.
const FAILS: f64 = 3.0;

/// The stretch in which a run fails most, s.
fn worst(data: &Data, run: &Run) -> Option<(f64, f64)> {
    let long = run.residual.len().div_ceil(STRETCHES).max(1);
    let square = |part: &[f64]| part.iter().map(|e| e * e).sum::<f64>() / part.len() as f64;
    let (place, most) = run
        .residual
        .chunks(long)
        .map(square)
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    let from = place * long;
    let to = (from + long).min(data.len()) - 1;
    (most.sqrt() > FAILS * FLOOR_RMS_COUNTS).then(|| (data.time_s[from], data.time_s[to]))
}

/// Samples to draw: all, or the extremes of the last run's residual in blocks.
fn drawn(samples: usize, runs: &[Run], most: usize) -> Vec<usize> {
    if samples <= most {
        return (0..samples).collect();
    }
    let block = samples.div_ceil(most / 2);
    let Some(last) = runs.last() else {
        return (0..samples).step_by(block / 2).collect();
    };
    let mut drawn = Vec::with_capacity(most);
    for from in (0..samples).step_by(block) {
        let range = from..(from + block).min(samples);
        let by = |a: &usize, b: &usize| last.residual[*a].total_cmp(&last.residual[*b]);
        let least = range.clone().min_by(by);
        let most = range.max_by(by);
        let mut pair: Vec<usize> = least.into_iter().chain(most).collect();
        pair.sort_unstable();
        pair.dedup();
        drawn.extend(pair);
    }
    drawn
}
