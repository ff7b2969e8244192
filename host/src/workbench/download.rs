//! What may be taken away from the bench as a file.

use super::model::Model;
use super::recordings::Recordings;
use super::session_file::SessionFile;
use super::state::Bench;
use crate::error::Error;
use crate::titled::titled;
use serde_json::Value;
use servoid_results::export::{Format, Options};
use servoid_results::report::html;
use servoid_results::schema::Document;

/// The file's name, and its text.
pub(super) fn file(bench: &Bench, format: &str) -> Result<(String, String), Error> {
    let pretty = |value: &Value| format!("{value:#}\n");
    let chosen = || -> Result<(Model, Recordings), Error> {
        let state = bench.state();
        Ok((state.chosen_model()?.clone(), state.recordings()?))
    };
    let named = |name: &str, text: String| Ok((name.to_owned(), text));
    match format {
        "report" => named("servoid-report.html", report(bench)?),
        "session" => named(
            "servoid-session.json",
            SessionFile::of(&bench.state()).text()?,
        ),
        "fit" => {
            let (model, recordings) = chosen()?;
            named("servoid-fit.json", pretty(&model.json(&recordings)?))
        }
        "diagnosis" => {
            let state = bench.state();
            let diagnosis = state.diagnosis.as_ref().ok_or_else(|| {
                Error::Usage("nothing is diagnosed yet; find what is missing first".to_owned())
            })?;
            named("servoid-diagnosis.json", pretty(diagnosis))
        }
        other => {
            let format = Format::by_name(other)
                .ok_or_else(|| Error::Usage(format!("there is no format `{other}`")))?;
            let (model, recordings) = chosen()?;
            let written = (format.write)(&model.subject(&recordings)?, &Options::default())?;
            Ok((
                format!("servoid-motor.{}", ending(format.name)),
                written.text,
            ))
        }
    }
}

/// What files of a format usually end in.
fn ending(format: &str) -> &str {
    match format {
        "c" => "h",
        "rust" => "rs",
        "python" => "py",
        "mujoco" | "urdf" => "xml",
        "modelica" => "mo",
        "bam" => "json",
        "mjlab" | "odrive" => "py",
        "simscape" => "m",
        "ros2-control" => "yaml",
        "vesc" => "lisp",
        "moteus" => "cfg",
        "wpilib" | "gains" => "txt",
        same => same,
    }
}

/// The report of the bench: of its diagnosis if there is one, else of the chosen model.
fn report(bench: &Bench) -> Result<String, Error> {
    let (recordings, json) = {
        let state = bench.state();
        let recordings = state.recordings()?;
        let json = match &state.diagnosis {
            Some(diagnosis) => diagnosis.clone(),
            None => state.chosen_model()?.json(&recordings)?,
        };
        (recordings, json)
    };
    let document = Document::from_json(json).map_err(|fault| Error::Failed(fault.to_string()))?;
    let drawn = html::Recordings {
        fitted: Some(recordings.shown()),
        held_out: recordings.judge(),
    };
    let page = html::page(&document, drawn)?;
    Ok(titled(page, recordings.motor().as_deref()).render())
}
