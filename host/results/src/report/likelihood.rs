//! The fit with process noise as text: at most six lines of 80 columns.

use super::style::{HEADING, painted};
use super::text::wrapped;
use servoid_identify::likelihood::{Likelihood, Value};
use std::fmt::Write;

/// Numbers of which the free run's are shown where they differ.
const MOST_DIFFERENCES: usize = 2;

pub(super) fn write(out: &mut String, own: &Likelihood) -> std::fmt::Result {
    writeln!(
        out,
        "{} (95 % intervals): inertia {},",
        painted(HEADING, "likelihood"),
        stated(&own.inertia),
    )?;
    writeln!(
        out,
        "  EMF+viscous {}, delay {},",
        stated(&own.damping),
        in_ms(&own.delay)
    )?;
    writeln!(
        out,
        "  Coulomb {}, offset {}",
        stated(&own.coulomb),
        stated(&own.offset)
    )?;
    if !own.disagreements.is_empty() {
        let shown = own.disagreements.iter().take(MOST_DIFFERENCES);
        let each: Vec<String> = shown
            .map(|d| format!("{} {} {}", words(d.name), plain(d.free_run), d.unit))
            .collect();
        writeln!(out, "  model error: free run {}", each.join(", "))?;
    }
    if !own.delay_separable {
        let lag = &own.total_lag;
        out.push_str(&wrapped(&format!(
            "delay cannot be told from inertia by this recording; their sum {} can",
            in_ms(lag)
        )));
    }
    Ok(())
}

fn words(key: &str) -> &str {
    match key {
        "back_emf_viscous" => "EMF+viscous",
        "coulomb" => "Coulomb",
        other => other,
    }
}

fn stated(value: &Value) -> String {
    format!(
        "{}{} {}",
        plain(value.value),
        interval(value, 1.0),
        value.unit
    )
}

fn in_ms(value: &Value) -> String {
    format!("{}{} ms", plain(1e3 * value.value), interval(value, 1e3))
}

fn interval(value: &Value, scale: f64) -> String {
    value.interval.map_or_else(String::new, |[low, high]| {
        format!(" [{}, {}]", plain(scale * low), plain(scale * high))
    })
}

/// Three significant digits.
fn plain(x: f64) -> String {
    if x == 0.0 {
        "0".to_owned()
    } else if (1e-2..1e4).contains(&x.abs()) {
        let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 5) as usize;
        format!("{x:.digits$}")
    } else {
        format!("{x:.2e}")
    }
}
