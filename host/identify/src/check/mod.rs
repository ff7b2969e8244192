//! The recording doctor: what a recording can be trusted for, before anything is fitted to it.
//!
//! [`examine()`] is the first step of a fit and of a diagnosis, and all that `servoid check` says.
//!
//! | file | looks at |
//! |---|---|
//! | `finding` | what one look finds |
//! | `command` | commands against the supply, and cut-off tops |
//! | `position` | targets of a position loop against the readings, and its gain |
//! | `clock` | the sample times |
//! | `readings` | held readings, and readings that are no whole counts |
//! | `standstill` | a reading that stands still although the motor is driven |
//! | `response` | whether and in which sense the motor follows its command, and how late |
//! | `speed_loop` | a command that is the setpoint of a speed loop |
//! | `reach` | what the motion reaches |

mod clock;
mod command;
mod finding;
mod position;
mod reach;
mod readings;
mod response;
mod speed_loop;
mod standstill;

pub use finding::{Finding, Severity};
#[cfg(test)]
pub(crate) use response::edges_after_rest;
pub(crate) use response::{BEGUN, DriveResponse, Driven, begun_s, drive_response, usual_answer};

use crate::error::Error;
use servoid_io::recording::Recording;

/// The findings that matter to a fit of a recording, the gravest first.
///
/// # Errors
/// [`Error::Failed`] with the finding that refuses the recording, unless `force` is set.
pub fn passed(recording: &Recording, force: bool) -> Result<Vec<Finding>, Error> {
    let mut findings = examine(recording);
    findings.retain(|finding| finding.severity > Severity::Remark);
    match findings.iter().find(|f| f.severity == Severity::Refusal) {
        Some(refusal) if !force => Err(Error::Failed(format!(
            "{}: {}",
            recording.source,
            refusal.text()
        ))),
        _ => Ok(findings),
    }
}

/// All findings on a recording, those that refuse it first.
pub fn examine(recording: &Recording) -> Vec<Finding> {
    let mut findings: Vec<Finding> = [
        command::findings,
        position::findings,
        clock::findings,
        standstill::findings,
        readings::findings,
        response::findings,
        speed_loop::findings,
        reach::findings,
    ]
    .iter()
    .flat_map(|look| look(recording))
    .collect();
    findings.sort_by_key(|finding| std::cmp::Reverse(finding.severity));
    findings
}
