//! All parameters as JSON.

use super::error::ExportError;
use super::options::Options;
use super::side::Side;
use super::subject::Subject;
use super::table::{Row, rows};
use super::written::{Lack, Written};
use crate::schema::device::Grade;
use schemars::JsonSchema;
use serde::Serialize;

/// `servoid.motor/1`: a motor for other programs.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Motor<'a> {
    /// `servoid.motor/1`.
    schema: &'static str,
    /// The file it was read from.
    source: &'a str,
    /// The recording behind it.
    recording: Option<&'a str>,
    /// What the command drives: `voltage` or `current`.
    drive: &'static str,
    /// The shaft that all numbers speak of.
    side: Side,
    /// Supply, V.
    supply_v: Option<f64>,
    /// Encoder counts a turn of the shaft on this side.
    counts_per_rev: Option<f64>,
    /// Sample interval of the recording, s.
    sample_s: Option<f64>,
    /// Effects beside the linear motor.
    effects: Vec<&'static str>,
    /// Every number.
    parameters: Vec<Row>,
    /// Numbers that the data do not determine.
    cannot_carry: &'a [Lack],
    /// What a device said they are good for: `floor`, `control` or `no`.
    #[serde(skip_serializing_if = "Option::is_none")]
    grade: Option<Grade>,
    /// Why for no more.
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
    /// Why they are not to be relied on, where a device said that they are not.
    #[serde(skip_serializing_if = "Option::is_none")]
    unverified: Option<String>,
    /// Version of the program.
    version: &'static str,
}

pub(super) fn write(subject: &Subject, _options: &Options) -> Result<Written, ExportError> {
    let mut written = Written::new(subject);
    let parameters = rows(subject, &mut written);
    let graded = subject.grade.as_ref();
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
        grade: graded.map(|graded| graded.grade),
        reason: graded.and_then(|graded| graded.reason.as_deref()),
        unverified: graded
            .filter(|graded| graded.grade == Grade::No)
            .and(subject.grade_text()),
        version: env!("CARGO_PKG_VERSION"),
    };
    let text = serde_json::to_string_pretty(&motor);
    written.text = text.map_err(|e| ExportError::Text(e.to_string()))? + "\n";
    Ok(written)
}
