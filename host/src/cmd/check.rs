//! `servoid check`: what recordings can be trusted for, before anything is fitted to them.

use super::motor;
use crate::cli::CheckArgs;
use crate::error::Error;
use crate::session::Session;
use servoid_engine::problem::Data;
use servoid_identify::LateDriver;
use servoid_identify::check::{Severity, examine};
use servoid_identify::diagnose::Span;
use servoid_identify::repeats::Repeats;
use servoid_io::recording::Recording;
use servoid_results::report::check;
use servoid_results::schema::check::{Check, Checked, Parting};
use servoid_results::schema::read::Read;

pub(super) fn run(session: &Session, args: &CheckArgs) -> Result<(), Error> {
    let mut recordings = Vec::new();
    let mut usable = Vec::new();
    let mut refused = Vec::new();
    let mut read: Option<Read> = None;
    for path in &args.recordings {
        motor::check_outputs(session, &[], &args.motor, path, None)?;
        let reading = motor::all_of(session, &args.motor, path)?;
        read.get_or_insert_with(|| Read::of(&reading.motor, Vec::new()))
            .remarks
            .extend(reading.notes);
        for recording in reading.recordings {
            let late = LateDriver::of(&recording);
            let mut findings = examine(&recording);
            findings.extend(late.map(|late| late.finding()));
            if findings.iter().any(|f| f.severity == Severity::Refusal) {
                refused.push(recording.source.clone());
            }
            recordings.push(Checked::new(&recording, &findings));
            usable.push(match late {
                Some(late) => late.cut(&recording),
                None => recording,
            });
        }
    }
    let json = Check {
        repeats: partings(usable),
        read,
        ..Check::new(recordings)
    };
    session.deliver(&check::text(&json), &json)?;
    if refused.is_empty() {
        return Ok(());
    }
    Err(Error::Failed(format!(
        "{} cannot be fitted as it stands: see the refusals, or override them with --force",
        refused.join(", ")
    )))
}

/// How far recordings of one command part.
fn partings(recordings: Vec<Recording>) -> Vec<Parting> {
    let lowered = recordings.into_iter().map(Data::taken);
    let data: Vec<Data> = lowered.filter_map(Result::ok).collect();
    let sets: Vec<&Data> = data.iter().collect();
    let (Some(repeats), Some(first)) = (Repeats::among(&sets), data.first()) else {
        return Vec::new();
    };
    let partings = repeats.partings(Span::usual_window_s(first));
    partings.into_iter().map(Into::into).collect()
}
