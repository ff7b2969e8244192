//! Whole series of samples for the lanes, as little-endian numbers: the page thins them for what is seen.

use super::answer::{Refusal, aside};
use super::details::drawn;
use super::recordings::Recordings;
use super::routes::Shared;
use super::state::Bench;
use crate::error::Error;
use axum::extract::{Path, Query, State};
use axum::http::HeaderName;
use axum::http::header::CONTENT_TYPE;
use serde::Deserialize;
use servoid_engine::problem::Data;
use servoid_io::channel::Measured;
use servoid_results::report::html::Model as Drawn;
use std::ops::Range;

/// Numbers as bytes, f32 each but for times.
pub(super) type Packed = ([(HeaderName, &'static str); 1], Vec<u8>);

/// Numbers as f32.
pub(super) fn packed(values: &[f64]) -> Packed {
    bytes(values.iter().flat_map(|x| (*x as f32).to_le_bytes()))
}

fn bytes(bytes: impl Iterator<Item = u8>) -> Packed {
    (
        [(CONTENT_TYPE, "application/octet-stream")],
        bytes.collect(),
    )
}

/// Evenly picked values of a range, `most` at most, each as `of` makes it.
pub(super) fn picked<T: Copy, U>(
    values: &[T],
    range: Range<usize>,
    most: usize,
    of: impl Fn(T) -> U,
) -> Vec<U> {
    let step = range.len().div_ceil(most).max(1);
    let values = values.get(range).unwrap_or_default();
    values
        .iter()
        .step_by(step)
        .map(|value| of(*value))
        .collect()
}

/// Which recordings.
#[derive(Clone, Copy, Deserialize)]
pub(super) struct Which {
    /// Those that are held out, instead of those that are fitted.
    #[serde(default)]
    held_out: bool,
}

impl Which {
    fn of(self, recordings: &Recordings) -> Result<&Data, Error> {
        if !self.held_out {
            return Ok(recordings.shown());
        }
        recordings.judge().ok_or_else(|| {
            Error::Usage("no recording of its own is held out on the bench".to_owned())
        })
    }
}

/// `time` (s, f64), `angle` (counts from the first reading), `drive` (V or A), `open` (1 where the bridge is open), `current` (A).
pub(super) async fn of_recording(
    State(bench): Shared,
    Path(what): Path<String>,
    Query(which): Query<Which>,
) -> Result<Packed, Refusal> {
    aside(move || {
        let recordings = bench.state().recordings()?;
        let data = which.of(&recordings)?;
        Ok(match what.as_str() {
            "time" => bytes(data.time_s.iter().flat_map(|t| t.to_le_bytes())),
            "angle" => {
                let first = data.counts.first().copied().unwrap_or(0.0);
                let counts: Vec<f64> = data.counts.iter().map(|c| c - first).collect();
                packed(&counts)
            }
            "drive" => {
                let drive: Vec<f64> = data.command.iter().map(|v| v * data.units.volts).collect();
                packed(&drive)
            }
            "open" => bytes((0..data.len()).map(|k| u8::from(data.is_open(k)))),
            "current" => packed(data.measured.get(Measured::Current).unwrap_or_default()),
            other => {
                return Err(Error::Usage(format!("there is no series `{other}`")));
            }
        })
    })
    .await
}

/// Model minus measured of a model on the bench over the span in which models are judged, counts.
pub(super) async fn of_model(
    State(bench): Shared,
    Path(id): Path<usize>,
    Query(which): Query<Which>,
) -> Result<Packed, Refusal> {
    residual(bench, which, move |bench| {
        let state = bench.state();
        let model = state.model(id)?;
        Ok(drawn(&model.name(), model))
    })
    .await
}

/// The same of a model that is proposed: with one effect more than model `id`.
pub(super) async fn of_proposal(
    State(bench): Shared,
    Path((id, effect)): Path<(usize, String)>,
    Query(which): Query<Which>,
) -> Result<Packed, Refusal> {
    residual(bench, which, move |bench| {
        let state = bench.state();
        let proposed = state.proposed.get(&id);
        let kind = servoid_formula::by_name(&effect);
        let found = proposed.and_then(|proposed| {
            let mut list = proposed.list.iter();
            list.find(|suggestion| Some(suggestion.effect) == kind)
        });
        let found = found
            .ok_or_else(|| Error::Usage(format!("`{effect}` is not proposed beside model {id}")))?;
        Ok(Drawn {
            name: effect,
            candidate: found.model.candidate,
            method: found.model.method,
        })
    })
    .await
}

async fn residual(
    bench: std::sync::Arc<Bench>,
    which: Which,
    model: impl FnOnce(&Bench) -> Result<Drawn, Error> + Send + 'static,
) -> Result<Packed, Refusal> {
    aside(move || {
        let recordings = bench.state().recordings()?;
        let model = model(&bench)?;
        let data = which.of(&recordings)?;
        let criterion = recordings.criterion();
        // A whole run along what it has not seen starts where that agrees with it best.
        if which.held_out && criterion.span.window_s.is_none() {
            return Ok(packed(&model.run_unseen(data)?.residual));
        }
        let residual = criterion.residual(data, &model.candidate, model.method);
        Ok(packed(&residual?))
    })
    .await
}
