//! What a page puts on the bench: a recording, a session, a blind demonstration.

use super::answer::{Answer, aside, done};
use super::blind;
use super::intake::Asked;
use super::loaded::Loaded;
use super::recordings::{self, Recordings};
use super::routes::Shared;
use super::state::Bench;
use crate::error::Error;
use axum::Json;
use axum::extract::State;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use servoid_engine::problem::Data;
use std::sync::Arc;

/// What a recording is taken as.
#[derive(Clone, Copy, Debug, PartialEq, Default, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Role {
    /// The one to fit, on a bench of its own.
    #[default]
    Fitted,
    /// Fitted together with what is fitted.
    Beside,
    /// Never fitted.
    HeldOut,
}

/// What a recording says under a mapping, in numbers that an engineer can check by feel.
pub(super) fn meaning(data: &Data) -> Value {
    let turns = |counts: f64| counts / data.units.counts_per_rev;
    let mut with = 0.0;
    for k in 1..data.len() {
        if !data.recordings.is_first(k) {
            with += data.command[k - 1] * (data.counts[k] - data.counts[k - 1]);
        }
    }
    let drive = data
        .command
        .iter()
        .fold(0.0f64, |most, v| most.max(v.abs()));
    json!({
        "drive": drive * data.units.volts,
        "drive_unit": data.drive.symbol(),
        "rpm": fastest(data) * 60.0 / data.units.counts_per_rev,
        "turns": turns(data.travel_counts()),
        "forward": with >= 0.0,
        "samples": data.len(),
        "interval_s": data.units.interval,
    })
}

/// Samples over which a speed is taken: a count in one sample is none.
const AROUND: usize = 10;

/// The largest speed over a few samples, counts/s.
fn fastest(data: &Data) -> f64 {
    (0..data.len()).step_by(AROUND / 2).fold(0.0, |most, k| {
        most.max(data.rate_of(&data.counts, k, AROUND).abs())
    })
}

/// What is said of a log, as a `motor.toml`.
pub(super) async fn motor(Json(asked): Json<Asked>) -> Answer {
    Ok(Json(json!({ "text": asked.text() })))
}

/// The recordings of the bench with one more.
pub(super) fn placed(
    loaded: Loaded,
    role: Role,
    before: Option<Recordings>,
) -> Result<Recordings, Error> {
    let Some(before) = before.filter(|_| role != Role::Fitted) else {
        return Ok(Recordings::new(Arc::new(loaded), None));
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
        let fitted = together(&before.fitted)?;
        return Ok(Recordings::new(fitted, before.held_out).ignoring(before.ignored));
    }
    // Another encoder or another drive would judge nothing.
    together(&before.fitted)?;
    let held_out = match &before.held_out {
        Some(others) => together(others)?,
        None => Arc::new(loaded),
    };
    Ok(Recordings::new(before.fitted, Some(held_out)).ignoring(before.ignored))
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
pub(super) struct Drawn {
    seed: Option<u64>,
    /// Whether what is in the motor is hidden.
    #[serde(default)]
    blind: bool,
}

pub(super) async fn demo(State(bench): Shared, Json(drawn): Json<Drawn>) -> Answer {
    aside(move || {
        free(&bench)?;
        if !drawn.blind {
            let recordings = blind::story()?;
            bench.change(|state| state.begin(recordings));
            return Ok(());
        }
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

#[derive(Deserialize)]
pub(super) struct Roles {
    roles: Vec<recordings::Role>,
}

/// Gives the recordings on the bench other roles.
pub(super) async fn roles(State(bench): Shared, Json(asked): Json<Roles>) -> Answer {
    aside(move || {
        let recordings = bench.state().recordings()?.in_roles(&asked.roles)?;
        free(&bench)?;
        bench.change(|state| state.begin(recordings));
        Ok(())
    })
    .await?;
    done()
}

/// A span of a recording: samples of what is drawn, or a recording that is to be whole again.
#[derive(Deserialize)]
#[serde(tag = "what", rename_all = "snake_case")]
pub(super) enum Span {
    Samples {
        from: usize,
        to: usize,
        #[serde(default)]
        held_out: bool,
    },
    Whole {
        recording: usize,
    },
}

pub(super) async fn span(State(bench): Shared, Json(asked): Json<Span>) -> Answer {
    aside(move || {
        let recordings = bench.state().recordings()?;
        let (k, span_s) = match asked {
            Span::Whole { recording } => (recording, None),
            Span::Samples { from, to, held_out } => {
                let found = recordings.span_of(&(from..to), held_out);
                let (k, span) = found.ok_or_else(|| {
                    Error::Usage("there are no such samples in what is drawn".to_owned())
                })?;
                (k, Some(span))
            }
        };
        let recordings = recordings.spanned(k, span_s)?;
        free(&bench)?;
        bench.change(|state| state.begin(recordings));
        Ok(())
    })
    .await?;
    done()
}
