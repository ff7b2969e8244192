//! What is certain of a recording and a model, as text of 80 columns.

use super::style::{HEADING, painted};
use super::text::wrapped;
use crate::number_text::interval;
use servoid_identify::certificate::{Certificate, Contradicting};
use std::fmt::Write;

pub(super) fn write(out: &mut String, certificate: &Certificate) -> std::fmt::Result {
    let Certificate {
        readings,
        reproduced,
        room_counts,
        ..
    } = certificate;
    writeln!(
        out,
        "{}: {reproduced} of {readings} readings are reproduced",
        painted(HEADING, "certificate")
    )?;
    if certificate.is_feasible() {
        writeln!(
            out,
            "  beyond these bounds a model near the fit contradicts at least one reading:"
        )?;
        for bounds in &certificate.bounds {
            let text = interval([bounds.low, bounds.high], bounds.unit)
                .unwrap_or_else(|| "not bounded by these readings".to_owned());
            writeln!(out, "  {:26} {text}", bounds.name)?;
        }
        return Ok(());
    }
    out.push_str(&wrapped(&format!(
        "no model of this structure near the fit reproduces all: each misses some reading by {:.3} counts at least",
        -room_counts
    )));
    match certificate.contradiction.len() {
        0 => {}
        1 => out.push_str(&wrapped("no model near the fit meets this one reading:")),
        many => out.push_str(&wrapped(&format!(
            "these {many} readings already contradict each other:"
        ))),
    }
    for reading in &certificate.contradiction {
        writeln!(out, "    {}", stated(reading))?;
    }
    Ok(())
}

fn stated(reading: &Contradicting) -> String {
    let side = if reading.above { "above" } else { "below" };
    format!(
        "{:>10.4} s, {} counts: models that meet the others lie {side} it",
        reading.time_s, reading.counts
    )
}
