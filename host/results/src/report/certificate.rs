//! What is certain of a recording and a model, as text of 80 columns.

use super::style::{HEADING, painted};
use super::text::wrapped;
use servoid_identify::certificate::{Certificate, Contradicting, ParameterBounds};
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
            writeln!(out, "  {:26} {}", bounds.name, interval(bounds))?;
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

/// Both ends with as many digits as tell them apart.
fn interval(bounds: &ParameterBounds) -> String {
    let (Some(low), Some(high)) = (bounds.low, bounds.high) else {
        let one = |end: Option<f64>, word: &str| {
            end.map(|end| format!("{word} {} {}", crate::number_text::short(end), bounds.unit))
        };
        return one(bounds.low, "above")
            .or(one(bounds.high, "below"))
            .unwrap_or_else(|| "not bounded by these readings".to_owned());
    };
    let size = low.abs().max(high.abs()).max(f64::MIN_POSITIVE);
    let exponent = size.log10().floor();
    let shift = if (-3.0..6.0).contains(&exponent) {
        0.0
    } else {
        exponent
    };
    let unit = 10f64.powf(shift);
    let digits =
        (2.0 - ((high - low).max(1e-15 * size) / unit).log10().floor()).clamp(0.0, 15.0) as usize;
    let tail = if shift == 0.0 {
        String::new()
    } else {
        format!("e{shift}")
    };
    format!(
        "{:.digits$}{tail} to {:.digits$}{tail} {}",
        low / unit,
        high / unit,
        bounds.unit
    )
}
