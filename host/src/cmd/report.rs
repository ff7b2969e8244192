//! `servoid report`: a result as a page, from its JSON and its recordings.

use super::motor;
use crate::cli::{PageArgs, ReportArgs};
use crate::error::Error;
use crate::session::Session;
use crate::titled::titled;
use serde::Serialize;
use servoid_engine::problem::Data;
use servoid_io::output::write_whole;
use servoid_io::recording::Recording;
use servoid_results::device_run::Folder;
use servoid_results::report::fold::folded;
use servoid_results::report::html::{self, Recordings};
use servoid_results::schema::{Diagnosis, Document, Fit};
use shared::wire::Stage;
use std::path::{Path, PathBuf};

/// The output of `--json`.
#[derive(Serialize)]
struct ReportJson {
    schema: &'static str,
    page: String,
    title: String,
    words: Vec<String>,
    recording: Option<String>,
    validate: Option<String>,
}

pub(super) fn run(session: &Session, args: &ReportArgs) -> Result<(), Error> {
    session.check_outputs(&[("--out", &args.out)], &[("the result", &args.result)])?;
    if let Some(recording) = &args.recording {
        let outputs = [("--out", args.out.as_path())];
        let validate = args.validate.as_deref();
        motor::check_outputs(session, &outputs, &args.motor, recording, validate)?;
    }
    let document = Document::read(&args.result)?;
    let (fitted, held_out) = sources(&document);
    let fitted = place(session, args, "--recording", &args.recording, fitted);
    let held_out = place(session, args, "--validate", &args.validate, held_out);
    // The recordings that the result names must not be written over either.
    for path in [&fitted, &held_out].into_iter().flatten() {
        let outputs = [("--out", args.out.as_path())];
        motor::check_outputs(session, &outputs, &args.motor, path, None)?;
    }
    let read = |path: Option<PathBuf>| {
        path.map(|path| motor::recording(session, &args.motor, &path))
            .transpose()
    };
    let (fitted, name) = read(fitted)?
        .map(|(recording, motor)| (recording, motor.name))
        .unzip();
    let held_out = read(held_out)?.map(|(recording, _)| recording);
    let name = name.flatten();
    let doubts = html::doubts(&document, fitted.as_ref(), held_out.as_ref())?;
    let data = |recording: Option<Recording>| recording.map(|r| Data::new(&r)).transpose();
    let (fitted, held_out) = (data(fitted)?, data(held_out)?);
    let recordings = Recordings {
        fitted: fitted.as_ref(),
        held_out: held_out.as_ref(),
    };
    let mut page = titled(html::page(&document, recordings)?, name.as_deref());
    for doubt in doubts {
        session.remark(&folded(&doubt, "  "));
        page.lead.push(doubt);
    }
    write_whole(&args.out, |out| out.write_all(page.render().as_bytes()))?;
    let json = ReportJson {
        schema: "servoid.report/1",
        page: args.out.display().to_string(),
        title: page.title.clone(),
        words: page.lead.clone(),
        recording: fitted.map(|data| data.source),
        validate: held_out.map(|data| data.source),
    };
    let mut text = format!("{}\n", page.title);
    for words in &page.lead {
        text += &format!("{}\n", folded(words, ""));
    }
    text += &format!("page with the drawings: {}\n", args.out.display());
    session.deliver(&text, &json)
}

/// Where a verb's own page goes, for the check of its outputs.
pub(super) fn output(args: &PageArgs) -> Option<(&'static str, &Path)> {
    args.report.as_deref().map(|path| ("--report", path))
}

/// Writes the page of a verb's own result, if it is asked for; `motor` is the motor's name.
pub(super) fn write(
    session: &Session,
    args: &PageArgs,
    motor: Option<&str>,
    json: &impl Serialize,
    recordings: Recordings<'_>,
) -> Result<(), Error> {
    let Some(path) = &args.report else {
        return Ok(());
    };
    let page = titled(html::page(&document(json)?, recordings)?, motor);
    write_whole(path, |out| out.write_all(page.render().as_bytes()))?;
    session.remark(&format!("page: {}", path.display()));
    Ok(())
}

/// A result as it will be read again from its file: a page made now is the page made from the file.
pub(super) fn document(json: &impl Serialize) -> Result<Document, Error> {
    let failed = |error: &dyn std::fmt::Display| {
        Error::Failed(format!("the result cannot be made a page: {error}"))
    };
    let value = serde_json::to_value(json).map_err(|error| failed(&error))?;
    Document::from_json(value).map_err(|fault| failed(&fault))
}

/// The recordings that a result was made from.
fn sources(document: &Document) -> (Option<PathBuf>, Option<PathBuf>) {
    let diagnosed = |diagnosis: &Diagnosis| {
        let source = diagnosis.held_out.source.as_ref();
        (
            Some(PathBuf::from(&diagnosis.recording)),
            source.map(PathBuf::from),
        )
    };
    let fitted = |fit: &Fit| {
        (
            Some(PathBuf::from(&fit.recording)),
            fit.validate.as_ref().map(PathBuf::from),
        )
    };
    match document {
        Document::Fit(fit) => fitted(fit),
        Document::Demo(demo) => fitted(&demo.fit),
        Document::Diagnosis(diagnosis) => diagnosed(diagnosis),
        Document::Verification(verification) => verification
            .diagnosis
            .as_ref()
            .map_or((None, None), |diagnosis| diagnosed(diagnosis)),
        Document::Device(_, folder) => {
            let folder = Folder::at(folder);
            (
                folder.recording_of(Stage::Record),
                folder.recording_of(Stage::Verify),
            )
        }
        Document::Steady(_) | Document::Contest(_) => (None, None),
    }
}

/// Where the recording is that is named, or that the result names: where that was, or beside the result.
fn place(
    session: &Session,
    args: &ReportArgs,
    flag: &str,
    named: &Option<PathBuf>,
    source: Option<PathBuf>,
) -> Option<PathBuf> {
    if named.is_some() {
        return named.clone();
    }
    let source = source?;
    let beside = source
        .file_name()
        .map(|name| args.result.with_file_name(name));
    let mut places = std::iter::once(source.clone()).chain(beside);
    let found = places.find(|path| path.is_file());
    if found.is_none() {
        session.remark(&format!(
            "{} is not there: the drawings that need it are left out; name it with {flag}",
            source.display()
        ));
    }
    found
}
