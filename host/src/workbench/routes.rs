//! What the page may ask.

use super::answer::{Answer, Refusal, aside, done};
use super::begun::begin;
use super::details::Tab;
use super::files::files;
use super::job::Watch;
use super::opened::{demo, free, motor, roles, span};
use super::state::{Bench, Telling, Way};
use super::{
    catalogue, details, download, dropped, failing, guard, law, live, remedy, series, shown,
    sliders,
};
use crate::error::Error;
use axum::extract::{DefaultBodyLimit, Path, Query, State};
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router, middleware};
use futures_util::stream::{self, Stream};
use serde::Deserialize;
use serde_json::{Map, Value};
use std::convert::Infallible;
use std::sync::Arc;
use tokio::sync::broadcast::error::RecvError;

/// Most bytes of a recording that a page may send.
const MOST_BYTES: usize = 1 << 30;
/// The bench, as every answer gets it.
pub(super) type Shared = State<Arc<Bench>>;

/// Everything under the secret.
pub(super) fn routes(bench: Arc<Bench>, secret: &str) -> Router {
    let mut page = Router::new();
    for file in files() {
        let answer = get(move || async move { ([(CONTENT_TYPE, file.kind)], file.content) });
        page = page.route(&format!("/{}", file.name), answer);
    }
    let page = page
        .route("/state", get(state))
        .route("/events", get(events))
        .route("/details/{tab}", get(details))
        .route("/failing", get(failing))
        .route("/catalogue", get(catalogue))
        .route("/remedy", get(remedied))
        .route("/series/{what}", get(series::of_recording))
        .route("/series/model/{id}", get(series::of_model))
        .route("/series/proposal/{id}/{effect}", get(series::of_proposal))
        .route("/motor", post(motor))
        .route("/roles", post(roles))
        .route("/span", post(span))
        .route("/dropped", get(dropped::waiting).post(dropped::sent))
        .route("/dropped/proposal", post(dropped::proposed))
        .route("/dropped/read", post(dropped::read))
        .route("/dropped/session", post(dropped::session))
        .route("/demo", post(demo))
        .route("/reveal", post(reveal))
        .route("/work", post(begin))
        .route("/stop", post(stop))
        .route("/arm", post(arm))
        .route("/live", get(under_way))
        .route("/undo", post(undo))
        .route("/redo", post(redo))
        .route("/choose", post(choose))
        .route("/remove", post(remove))
        .route("/lock", post(lock))
        .route("/law", post(law_read))
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

/// The drawings of a tab.
async fn details(State(bench): Shared, Path(tab): Path<String>) -> Answer {
    let tab = Tab::by_name(&tab)?;
    drawn(&bench, tab.name(), move |bench| tab.drawn(bench)).await
}

/// Where the chosen model fails, and the one beside it.
async fn failing(State(bench): Shared) -> Answer {
    drawn(&bench, "failing", failing::of).await
}

/// The effects that servoid knows, with their signatures.
async fn catalogue() -> impl IntoResponse {
    ([(CONTENT_TYPE, "application/json")], catalogue::EFFECTS)
}

/// The speed loop of the chosen model.
async fn remedied(State(bench): Shared) -> Answer {
    drawn(&bench, "remedy", remedy::of).await
}

/// What is drawn of the models that are looked at: found once, however many ask for it.
async fn drawn(
    bench: &Arc<Bench>,
    what: &str,
    draw: impl FnOnce(&Bench) -> Result<Value, Error> + Send + 'static,
) -> Answer {
    let key = bench.state().looked_at(what);
    let from = Arc::clone(bench);
    let found = (bench.drawings)
        .get(key, aside(move || draw(&from)))
        .await?;
    Ok(Json((*found).clone()))
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

/// Lets the motor be started within the next seconds.
async fn arm(State(bench): Shared) -> Answer {
    free(&bench)?;
    bench.device()?.arm();
    bench.tell(Telling::Changed);
    done()
}

/// The run that is under way.
async fn under_way(State(bench): Shared) -> Answer {
    Ok(Json(aside(move || live::view(&bench)).await?))
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
    bench.act(|state| state.remove(which.model))?;
    done()
}

#[derive(Deserialize)]
struct Lock {
    effect: String,
    locked: bool,
}

/// Reads and draws a law that is being typed.
async fn law_read(State(bench): Shared, text: String) -> Answer {
    let definition = match law::read(&text) {
        Ok(definition) => definition,
        Err(fault) => return Ok(Json(fault)),
    };
    let Json(missing) = drawn(&bench, "missing", law::missing).await?;
    let found = aside(move || law::drawn(&bench, &definition, &missing)).await?;
    Ok(Json(found))
}

/// Takes an effect out of what is proposed, or lets it in again.
async fn lock(State(bench): Shared, Json(asked): Json<Lock>) -> Answer {
    let kind = servoid_formula::by_name(&asked.effect)
        .ok_or_else(|| Error::Usage(format!("there is no effect `{}`", asked.effect)))?;
    bench.act(|state| {
        state.locked.retain(|other| *other != kind);
        if asked.locked {
            state.locked.push(kind);
        }
    });
    done()
}

#[derive(Deserialize)]
struct Trial {
    model: usize,
    values: Map<String, Value>,
}

/// The residual of a model with some of its constants moved by hand.
async fn trial(State(bench): Shared, Json(trial): Json<Trial>) -> Result<series::Packed, Refusal> {
    let answer = aside(move || {
        let (recordings, model) = {
            let state = bench.state();
            (state.recordings()?, state.model(trial.model)?.clone())
        };
        let mut by_hand = details::drawn("moved by hand", &model);
        by_hand.candidate = sliders::moved(&by_hand.candidate, &trial.values)?;
        let (criterion, data) = (recordings.criterion(), recordings.shown());
        let residual = criterion.residual(data, &by_hand.candidate, by_hand.method)?;
        Ok(series::packed(&residual))
    })
    .await?;
    Ok(answer)
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
