//! What a page is answered.

use super::words::on_the_page;
use crate::error::Error;
use axum::Json;
use axum::http::StatusCode;
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};

/// An error as the page shows it: the words of a terminal, but for its flags.
pub(super) struct Refusal(Error);

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

pub(super) type Answer = Result<Json<Value>, Refusal>;

/// Nothing more to say than that it was done.
pub(super) fn done() -> Answer {
    Ok(Json(json!({})))
}

/// Work of more than a moment must not hold up the server.
pub(super) async fn aside<T: Send + 'static>(
    work: impl FnOnce() -> Result<T, Error> + Send + 'static,
) -> Result<T, Refusal> {
    let done = tokio::task::spawn_blocking(work).await;
    Ok(done.map_err(|error| Error::Failed(format!("the work broke off: {error}")))??)
}
