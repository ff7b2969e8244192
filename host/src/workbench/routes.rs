//! What the page may ask.

use super::answer::{Answer, Refusal, aside, done};
use super::begun::begin;
use super::job::Watch;
use super::opened::{demo, free, recording, session};
use super::preview::preview;
use super::state::{Bench, Telling, Way};
use super::{download, guard, shown};
use crate::error::Error;
use axum::extract::{DefaultBodyLimit, Query, State};
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router, middleware};
use futures_util::stream::{self, Stream};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use servoid_results::number_text::short;
use servoid_results::page::assets;
use std::convert::Infallible;
use std::sync::Arc;
use tokio::sync::broadcast::error::RecvError;

/// Most bytes of a recording that a page may send.
const MOST_BYTES: usize = 1 << 30;
const PAGE: &str = include_str!("assets/bench.html");
const SCRIPT: &str = include_str!("assets/bench.js");
const STYLE: &str = include_str!("assets/bench.css");

/// The bench, as every answer gets it.
pub(super) type Shared = State<Arc<Bench>>;

/// Everything under the secret.
pub(super) fn routes(bench: Arc<Bench>, secret: &str) -> Router {
    let text = |kind: &'static str, content: &'static str| {
        get(move || async move { ([(CONTENT_TYPE, kind)], content) })
    };
    let script = "text/javascript; charset=utf-8";
    let style = "text/css; charset=utf-8";
    let page = Router::new()
        .route("/", text("text/html; charset=utf-8", PAGE))
        .route("/bench.js", text(script, SCRIPT))
        .route("/plots.js", text(script, assets::PLOTS))
        .route("/plotly.js", text(script, assets::plotly()))
        .route("/page.css", text(style, assets::STYLE))
        .route("/bench.css", text(style, STYLE))
        .route("/state", get(state))
        .route("/events", get(events))
        .route("/pictures", get(pictures))
        .route("/preview", post(previewed))
        .route("/recording", post(recording))
        .route("/session", post(session))
        .route("/demo", post(demo))
        .route("/reveal", post(reveal))
        .route("/work", post(begin))
        .route("/stop", post(stop))
        .route("/undo", post(undo))
        .route("/redo", post(redo))
        .route("/choose", post(choose))
        .route("/remove", post(remove))
        .route("/trial", post(trial))
        .route("/export", get(export))
        .layer(DefaultBodyLimit::max(MOST_BYTES))
        .with_state(bench);
    Router::new()
        .nest(&format!("/{secret}/"), page)
        .layer(middleware::from_fn(guard::check))
}

async fn state(State(bench): Shared) -> Json<Value> {
    Json(shown::view(&bench))
}

/// Tells of changes and progress until the page is closed.
async fn events(State(bench): Shared) -> Sse<impl Stream<Item = Result<Event, Infallible>>> {
    let receiver = bench.tellings.subscribe();
    let watch = Watch::new(&bench);
    let first = Some(Event::default().event("changed").data("{}"));
    let tellings = stream::unfold(
        (receiver, watch, first),
        |(mut receiver, watch, mut first)| async move {
            let event = match first.take() {
                Some(event) => event,
                None => match receiver.recv().await {
                    Ok(Telling::Progress(value)) => {
                        Event::default().event("progress").data(value.to_string())
                    }
                    // What was missed shows in the state.
                    Ok(Telling::Changed) | Err(RecvError::Lagged(_)) => {
                        Event::default().event("changed").data("{}")
                    }
                    Err(RecvError::Closed) => return None,
                },
            };
            Some((Ok(event), (receiver, watch, first)))
        },
    );
    Sse::new(tellings).keep_alive(KeepAlive::default())
}

async fn pictures(State(bench): Shared) -> Answer {
    Ok(Json(aside(move || shown::pictures(&bench)).await?))
}

async fn previewed(body: String) -> Json<Value> {
    Json(json!(preview(&body)))
}

async fn reveal(State(bench): Shared) -> Answer {
    bench.act(|state| {
        if let Some(secret) = &mut state.secret {
            secret.revealed = true;
        }
    });
    done()
}

async fn stop(State(bench): Shared) -> Answer {
    bench.job.stop();
    done()
}

async fn undo(State(bench): Shared) -> Answer {
    go(&bench, Way::Undo)
}

async fn redo(State(bench): Shared) -> Answer {
    go(&bench, Way::Redo)
}

fn go(bench: &Bench, way: Way) -> Answer {
    free(bench)?;
    bench.go(way)?;
    done()
}

#[derive(Deserialize)]
struct Choice {
    chosen: usize,
    #[serde(default)]
    against: Option<usize>,
}

async fn choose(State(bench): Shared, Json(choice): Json<Choice>) -> Answer {
    bench.act(|state| -> Result<(), Error> {
        state.model(choice.chosen)?;
        if let Some(other) = choice.against {
            state.model(other)?;
        }
        state.chosen = Some(choice.chosen);
        state.against = choice.against.filter(|other| *other != choice.chosen);
        Ok(())
    })?;
    done()
}

#[derive(Deserialize)]
struct Which {
    model: usize,
}

async fn remove(State(bench): Shared, Json(which): Json<Which>) -> Answer {
    bench.act(|state| -> Result<(), Error> {
        state.model(which.model)?;
        state.models.retain(|model| model.id != which.model);
        if state.against == Some(which.model) {
            state.against = None;
        }
        if state.chosen == Some(which.model) {
            state.chosen = state.models.last().map(|model| model.id);
            state.against = None;
        }
        Ok(())
    })?;
    done()
}

#[derive(Deserialize)]
struct Trial {
    model: usize,
    values: Map<String, Value>,
}

/// A model with some of its constants moved by hand, beside the model.
async fn trial(State(bench): Shared, Json(trial): Json<Trial>) -> Answer {
    let answer = aside(move || {
        let (recordings, model) = {
            let state = bench.state();
            (state.recordings()?, state.model(trial.model)?.clone())
        };
        let mut by_hand = shown::drawn("moved by hand", &model);
        by_hand.candidate = shown::moved(&by_hand.candidate, &trial.values)?;
        let data = recordings.shown();
        let run = by_hand.run(data)?;
        let squares: f64 = run.residual.iter().map(|e| e * e).sum();
        let rms = (squares / data.len() as f64).sqrt();
        let models = [shown::drawn(&model.name(), &model), by_hand];
        Ok(json!({
            "rms_counts": rms,
            "said": short(rms),
            "timeline": shown::timeline(&recordings, &models)?,
        }))
    })
    .await?;
    Ok(Json(answer))
}

#[derive(Deserialize)]
struct Wanted {
    format: String,
}

/// The result as a file.
async fn export(State(bench): Shared, Query(wanted): Query<Wanted>) -> Result<Response, Refusal> {
    let from = Arc::clone(&bench);
    let (name, text) = aside(move || download::file(&from, &wanted.format)).await?;
    if bench.state().fault.is_some() {
        bench.act(|_| ());
    }
    let kind = match name.rsplit('.').next() {
        Some("html") => "text/html; charset=utf-8",
        Some("json") => "application/json",
        _ => "text/plain; charset=utf-8",
    };
    let disposition = format!("attachment; filename=\"{name}\"");
    Ok((
        [(CONTENT_TYPE, kind), (CONTENT_DISPOSITION, &disposition)],
        text,
    )
        .into_response())
}
