//! All parameters as JSON.

use super::error::ExportError;
use super::format::Options;
use super::side::Side;
use super::subject::Subject;
use super::table::{Row, rows};
use super::written::{Lack, Written};
use serde::Serialize;

#[derive(Serialize)]
struct Motor<'a> {
    schema: &'static str,
    source: &'a str,
    recording: Option<&'a str>,
    drive: &'static str,
    side: Side,
    supply_v: Option<f64>,
    counts_per_rev: Option<f64>,
    sample_s: Option<f64>,
    effects: Vec<&'static str>,
    parameters: Vec<Row>,
    cannot_carry: &'a [Lack],
    version: &'static str,
}

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let parameters = rows(subject, &mut written);
    let motor = Motor {
        schema: "servoid.motor/1",
        source: &subject.source,
        recording: subject.recording.as_deref(),
        drive: subject.drive.name(),
        side: subject.side,
        supply_v: subject.supply_v,
        counts_per_rev: subject.counts_per_rev,
        sample_s: subject.sample_s,
        effects: subject.terms.iter().map(|term| term.kind.name()).collect(),
        parameters,
        cannot_carry: &written.cannot_carry,
        version: env!("CARGO_PKG_VERSION"),
    };
    let text = serde_json::to_string_pretty(&motor);
    written.text = text.map_err(|e| ExportError::Loop(e.to_string()))? + "\n";
    Ok(written)
}
