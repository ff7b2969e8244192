//! Who may ask: only a page that came from this program, on this machine.
//!
//! The server listens on the loopback address only. Every path begins with a secret that only the printed address holds,
//! so that other programs and other users of the machine find nothing; the host's name is checked, so that no foreign
//! site can reach it by a name that it made to point here; and the page may load nothing from anywhere else.

use axum::extract::Request;
use axum::http::header::{CACHE_CONTROL, CONTENT_SECURITY_POLICY, HOST, ORIGIN, REFERRER_POLICY};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// Scripts and data from this server alone; plotly writes its styles into the page.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; connect-src 'self'; \
                      img-src 'self' data: blob:; font-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A secret that cannot be guessed, as 32 hexadecimal digits.
///
/// # Errors
/// Where the system has no randomness to give.
pub(super) fn secret() -> Result<String, getrandom::Error> {
    let mut bytes = [0u8; 16];
    getrandom::fill(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

/// Lets pass what asks for this host, from a page of this host if from any.
pub(super) async fn check(request: Request, next: Next) -> Response {
    if !is_own(request.headers()) {
        return (StatusCode::FORBIDDEN, "not from here\n").into_response();
    }
    let mut response = next.run(request).await;
    let headers = response.headers_mut();
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (REFERRER_POLICY, "no-referrer"),
        (HeaderName::from_static("x-content-type-options"), "nosniff"),
        (CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Whether a request names this host, and comes from a page of this host if from any.
fn is_own(headers: &HeaderMap) -> bool {
    let text = |name: HeaderName| {
        let value = headers.get(name);
        value.map(|value| value.to_str().unwrap_or("?"))
    };
    let host = text(HOST).unwrap_or_default();
    let origin = text(ORIGIN);
    is_loopback(host) && origin.is_none_or(|origin| origin == format!("http://{host}"))
}

fn is_loopback(host: &str) -> bool {
    let name = host.rsplit_once(':').map_or(host, |(name, _)| name);
    matches!(name, "127.0.0.1" | "localhost")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_loopback_s_own_names_pass() {
        for (host, passes) in [
            ("127.0.0.1:8080", true),
            ("localhost:1", true),
            ("localhost", true),
            ("127.0.0.1.evil.example:80", false),
            ("evil.example", false),
            ("", false),
            ("[::1]:80", false),
        ] {
            assert_eq!(is_loopback(host), passes, "{host}");
        }
    }

    #[test]
    fn secrets_are_long_and_never_the_same() {
        let (a, b) = (secret().expect("randomness"), secret().expect("randomness"));
        assert!(a.len() == 32 && a != b && a.chars().all(|c| c.is_ascii_hexdigit()));
    }
}
