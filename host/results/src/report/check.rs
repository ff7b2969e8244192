//! The findings on recordings as text.

use super::diagnosis::bars::counts;
use super::fold::folded;
use super::position_loop::described;
use crate::schema::check::{Check, Checked, Parting};

/// All recordings, a block each.
pub fn text(check: &Check) -> String {
    let blocks: Vec<String> = check.recordings.iter().map(block).collect();
    let partings: Vec<String> = check.repeats.iter().map(parting).collect();
    [blocks, partings].concat().join("\n")
}

fn parting(parting: &Parting) -> String {
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let repeated = match parting.recordings.as_slice() {
        [alone] => format!("{alone} runs its command {} times", parting.runs),
        several => format!("{} repeat one command", several.join(", ")),
    };
    let line = format!(
        "{repeated}: a run parts from their mean by {} counts RMS in windows of {} s and by {} over the whole run; no model of this \
         motor can come nearer than that",
        counts(number(parting.in_windows_counts)),
        number(parting.window_s),
        counts(number(parting.over_run_counts)),
    );
    folded(&line, "  ") + "\n"
}

fn block(checked: &Checked) -> String {
    let unit = if checked.drive == "current" { "A" } else { "V" };
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let mut out = format!(
        "{}: {} samples, {:.3} s, every {:.6} s, commands to {:.2} {unit}\n",
        checked.recording,
        checked.samples,
        number(checked.duration_s),
        number(checked.interval_s),
        number(checked.largest_command),
    );
    if let Some(control) = &checked.position_loop {
        out.push_str(&folded(&format!("  {}", described(control)), "    "));
        out.push('\n');
    }
    if checked.findings.is_empty() {
        out.push_str("  nothing to remark\n");
    }
    for finding in &checked.findings {
        let line = format!(
            "  {:8} {}: {}",
            finding.severity, finding.seen, finding.remedy
        );
        out.push_str(&folded(&line, "           "));
        out.push('\n');
    }
    out
}
