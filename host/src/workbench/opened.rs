//! What a page puts on the bench: a recording, a session, a blind demonstration.

use super::answer::{Answer, aside, done};
use super::blind;
use super::loaded::{Loaded, Source};
use super::model::Recordings;
use super::preview::Mapping;
use super::routes::Shared;
use super::session_file::SessionFile;
use super::state::Bench;
use crate::error::Error;
use axum::Json;
use axum::extract::State;
use serde::Deserialize;
use std::sync::Arc;

#[derive(Deserialize)]
pub(super) struct Sent {
    name: String,
    csv: String,
    #[serde(default)]
    held_out: bool,
    mapping: Option<Mapping>,
    /// A `motor.toml` in the place of a mapping.
    motor: Option<String>,
    /// Whether it is only tried.
    #[serde(default)]
    check: bool,
}

pub(super) async fn recording(State(bench): Shared, Json(sent): Json<Sent>) -> Answer {
    aside(move || {
        let mapping = sent.mapping.map(|mapping| mapping.motor());
        let motor = sent.motor.or(mapping).unwrap_or_default();
        let loaded = Arc::new(Loaded::read(Source {
            name: sent.name,
            csv: sent.csv,
            motor,
        })?);
        if sent.check {
            return Ok(());
        }
        let before = bench.state().recordings.clone();
        let copied = before.as_ref().is_some_and(|before| loaded.is_copy_of(&before.fitted));
        if sent.held_out && copied {
            return Err(Error::Usage(format!(
                "{}: is the recording that is fitted, which is no test of it; take another run of the same motor",
                loaded.source.name
            )));
        }
        let recordings = match (sent.held_out, before) {
            (true, Some(before)) => Recordings {
                held_out: Some(loaded),
                ..before
            },
            _ => Recordings {
                fitted: loaded,
                held_out: None,
            },
        };
        free(&bench)?;
        bench.change(|state| state.begin(recordings));
        Ok(())
    })
    .await?;
    done()
}

/// Recordings are not changed under work that is going on.
fn free(bench: &Bench) -> Result<(), Error> {
    match bench.job.running() {
        None => Ok(()),
        Some(what) => Err(Error::Usage(format!(
            "the bench is busy ({what}): wait for it, or stop it first"
        ))),
    }
}

pub(super) async fn session(State(bench): Shared, body: String) -> Answer {
    aside(move || {
        let file = SessionFile::parse(&body, "the session")?;
        free(&bench)?;
        bench.change(|state| file.lay(state))
    })
    .await?;
    done()
}

#[derive(Deserialize)]
pub(super) struct Drawn {
    seed: Option<u64>,
}

pub(super) async fn demo(State(bench): Shared, Json(drawn): Json<Drawn>) -> Answer {
    aside(move || {
        free(&bench)?;
        let seed = match drawn.seed {
            Some(seed) => seed,
            None => u64::from(
                getrandom::u32().map_err(|error| Error::Failed(error.to_string()))? % 10_000,
            ),
        };
        let (recordings, secret) = blind::demonstration(seed)?;
        bench.change(|state| {
            state.begin(recordings);
            state.secret = Some(secret);
        });
        Ok(())
    })
    .await?;
    done()
}
