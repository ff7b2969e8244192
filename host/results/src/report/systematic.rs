//! What parameters change by if the recording is not what it says, as a table of 80 columns.

use super::style::{HEADING, painted};
use crate::number_text::rough;
use servoid_identify::fit::{Cause, Parameter};

/// The table; nothing where nothing is known.
pub(super) fn table(parameters: &[Parameter]) -> String {
    let known = |p: &&Parameter| !p.systematic.is_empty();
    if !parameters.iter().any(|p| known(&p)) {
        return String::new();
    }
    let heads = Cause::ALL.map(|cause| format!("{:>16}", words(cause)));
    let mut out = format!(
        "{}: with an error of the recording a parameter is off by\n{:29}{}\n",
        painted(HEADING, "systematic"),
        "",
        heads.concat()
    );
    for p in parameters.iter().filter(known) {
        let change = |cause: Cause| {
            let own = p.systematic.iter().find(|s| s.cause == cause);
            own.map_or("-".to_owned(), |s| rough(s.change.abs()))
        };
        let changes = Cause::ALL.map(|cause| format!("{:>16}", change(cause)));
        out += &format!("  {:27}{}\n", p.name, changes.concat());
    }
    out
}

/// A cause with its size, in the unit in which people speak of it.
pub(super) fn words(cause: Cause) -> String {
    match cause {
        Cause::Latency => format!("{:.0} us latency", 1e6 * cause.size()),
        Cause::EncoderEdges => format!("edges {} count", cause.size()),
        Cause::CommandScale => format!("command {:.0} %", 100.0 * cause.size()),
    }
}
