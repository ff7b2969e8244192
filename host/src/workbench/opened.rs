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
use axum::extract::{Query, State};
use serde::Deserialize;
use std::sync::Arc;

/// What a recording is taken as.
#[derive(Clone, Copy, PartialEq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Role {
    /// The one to fit, on a bench of its own.
    #[default]
    Fitted,
    /// Fitted together with what is fitted.
    Beside,
    /// Never fitted.
    HeldOut,
}

#[derive(Deserialize)]
pub(super) struct Sent {
    name: String,
    csv: String,
    #[serde(default)]
    role: Role,
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
        let loaded = Loaded::read(vec![Source {
            name: sent.name,
            csv: sent.csv,
            motor,
        }])?;
        if sent.check {
            return Ok(());
        }
        let before = bench.state().recordings.clone();
        let recordings = placed(loaded, sent.role, before)?;
        free(&bench)?;
        bench.change(|state| state.begin(recordings));
        Ok(())
    })
    .await?;
    done()
}

/// The recordings of the bench with one more.
fn placed(loaded: Loaded, role: Role, before: Option<Recordings>) -> Result<Recordings, Error> {
    let Some(before) = before.filter(|_| role != Role::Fitted) else {
        return Ok(Recordings {
            fitted: Arc::new(loaded),
            held_out: None,
        });
    };
    let together = |those: &Loaded| those.with(&loaded).map(Arc::new);
    let judged_by = match role {
        Role::HeldOut => Some(&before.fitted),
        _ => before.held_out.as_ref(),
    };
    if judged_by.is_some_and(|other| loaded.has_copy_of(other)) {
        return Err(Error::Usage(format!(
            "{}: is fitted and held out, which is no test; take another run of the same motor",
            loaded.data.source
        )));
    }
    if role == Role::Beside {
        return Ok(Recordings {
            fitted: together(&before.fitted)?,
            ..before
        });
    }
    // Another encoder or another drive would judge nothing.
    together(&before.fitted)?;
    let held_out = match &before.held_out {
        Some(others) => together(others)?,
        None => Arc::new(loaded),
    };
    Ok(Recordings {
        held_out: Some(held_out),
        ..before
    })
}

/// What lies on the bench is not exchanged under work that is going on.
pub(super) fn free(bench: &Bench) -> Result<(), Error> {
    match bench.job.running() {
        None => Ok(()),
        Some(what) => Err(Error::Usage(format!(
            "the bench is busy ({what}): wait for it, or stop it first"
        ))),
    }
}

#[derive(Deserialize)]
pub(super) struct Tried {
    /// Whether it is only tried.
    #[serde(default)]
    check: bool,
}

pub(super) async fn session(
    State(bench): Shared,
    Query(tried): Query<Tried>,
    body: String,
) -> Answer {
    aside(move || {
        let file = SessionFile::parse(&body, "the session")?;
        if tried.check {
            return Ok(());
        }
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
