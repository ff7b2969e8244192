//! What the page may ask.

use super::job::{self, Watch};
use super::loaded::{Loaded, Source};
use super::model::Recordings;
use super::preview::{Mapping, preview};
use super::session_file::SessionFile;
use super::state::{Bench, Telling};
use super::words::on_the_page;
use super::{blind, download, guard, shown, work};
use crate::error::Error;
use axum::extract::{DefaultBodyLimit, Query, State};
use axum::http::StatusCode;
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
use shared::effects::Kind;
use std::convert::Infallible;
use std::sync::Arc;
use tokio::sync::broadcast::error::RecvError;

/// Most bytes of a recording that a page may send.
const MOST_BYTES: usize = 1 << 30;
const PAGE: &str = include_str!("assets/bench.html");
const SCRIPT: &str = include_str!("assets/bench.js");
const STYLE: &str = include_str!("assets/bench.css");

type Shared = State<Arc<Bench>>;

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

/// An error as the page shows it: the words of a terminal, but for its flags.
struct Refusal(Error);

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        Refusal(error)
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        let body = Json(json!({ "error": on_the_page(&self.0.to_string()) }));
        (StatusCode::UNPROCESSABLE_ENTITY, body).into_response()
    }
}

type Answer = Result<Json<Value>, Refusal>;

fn done() -> Answer {
    Ok(Json(json!({})))
}

/// Work of more than a moment must not hold up the server.
async fn aside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Error> + Send + 'static,
) -> Result<T, Refusal> {
    let done = tokio::task::spawn_blocking(work).await;
    Ok(done.map_err(|error| Error::Failed(format!("the work broke off: {error}")))??)
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

#[derive(Deserialize)]
struct Sent {
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

async fn recording(State(bench): Shared, Json(sent): Json<Sent>) -> Answer {
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

async fn session(State(bench): Shared, body: String) -> Answer {
    aside(move || {
        let file = SessionFile::parse(&body, "the session")?;
        free(&bench)?;
        bench.change(|state| file.lay(state))
    })
    .await?;
    done()
}

#[derive(Deserialize)]
struct Drawn {
    seed: Option<u64>,
}

async fn demo(State(bench): Shared, Json(drawn): Json<Drawn>) -> Answer {
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

async fn reveal(State(bench): Shared) -> Answer {
    bench.act(|state| {
        if let Some(secret) = &mut state.secret {
            secret.told = true;
        }
    });
    done()
}

/// A piece of work.
#[derive(Deserialize)]
#[serde(tag = "what", rename_all = "snake_case")]
enum Work {
    Fit {
        #[serde(default)]
        effects: Vec<String>,
        #[serde(default)]
        algorithm: Option<String>,
    },
    Suggest {
        model: usize,
    },
    Diagnose,
    Race {
        #[serde(default)]
        effects: Vec<String>,
        algorithms: Vec<String>,
        /// Numbers as they were typed: a fraction is refused in words, not by its type.
        budget: f64,
        seeds: f64,
    },
}

/// Most evaluations and seeds of a race on the page; `servoid compare` has no such limit.
const MOST_BUDGET: f64 = 20_000.0;
const MOST_SEEDS: f64 = 100.0;

async fn begin(State(bench): Shared, Json(asked): Json<Work>) -> Answer {
    match asked {
        Work::Fit { effects, algorithm } => {
            let effects = kinds(&effects)?;
            let algorithm = algorithm.unwrap_or_else(|| "lm".to_owned());
            job::start(&bench, "fit", move |bench| {
                work::fit(bench, &effects, &algorithm)
            })?;
        }
        Work::Suggest { model } => {
            job::start(&bench, "suggest", move |bench| work::suggest(bench, model))?;
        }
        Work::Diagnose => job::start(&bench, "diagnose", work::diagnose)?,
        Work::Race {
            effects,
            algorithms,
            budget,
            seeds,
        } => {
            let effects = kinds(&effects)?;
            let whole = |name: &str, asked: f64, most: f64| -> Result<u64, Error> {
                if asked.fract() != 0.0 || !(1.0..=most).contains(&asked) {
                    return Err(Error::Usage(format!(
                        "{name} of the race: {asked} does not do; take a whole number from 1 to {most}"
                    )));
                }
                Ok(asked as u64)
            };
            if algorithms.is_empty() {
                let text = "a race needs at least one search method; tick some".to_owned();
                return Err(Error::Usage(text).into());
            }
            let budget = whole("evaluations", budget, MOST_BUDGET)?;
            let seeds = whole("seeds", seeds, MOST_SEEDS)?;
            job::start(&bench, "race", move |bench| {
                work::race(bench, &effects, &algorithms, budget as usize, seeds)
            })?;
        }
    }
    done()
}

fn kinds(names: &[String]) -> Result<Vec<Kind>, Error> {
    let mut kinds = Vec::new();
    for name in names {
        let kind = Kind::by_name(name)
            .ok_or_else(|| Error::Usage(format!("there is no effect `{name}`")))?;
        if kinds.contains(&kind) {
            return Err(Error::Usage(format!("{name} is in the model already")));
        }
        kinds.push(kind);
    }
    Ok(kinds)
}

async fn stop(State(bench): Shared) -> Answer {
    bench.job.stop();
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
        let data = &recordings.fitted.data;
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
