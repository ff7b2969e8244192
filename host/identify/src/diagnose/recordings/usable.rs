//! What the recording doctor finds, in the terms of a diagnosis.

use super::remark::Remark;
use crate::check::{Severity, examine};
use crate::error::Error;
use servoid_io::recording::Recording;

/// Findings that the diagnosis says itself, where they matter.
const SAID_ELSEWHERE: [&str; 4] = ["one_way", "off_lattice", "reversed", "no_response"];

/// Remarks on a recording.
///
/// # Errors
/// [`Error::Failed`] where a finding refuses it, unless `force` is set.
pub fn check(recording: &Recording, force: bool) -> Result<Vec<Remark>, Error> {
    let mut remarks = Vec::new();
    for finding in examine(recording) {
        if SAID_ELSEWHERE.contains(&finding.code) {
            continue;
        }
        let text = format!("{}: {}", recording.source, finding.text());
        match finding.severity {
            Severity::Refusal if !force => return Err(Error::Failed(text)),
            Severity::Refusal | Severity::Warning => remarks.push(Remark::cause(text)),
            Severity::Remark => remarks.push(Remark::aside(text)),
        }
    }
    Ok(remarks)
}
