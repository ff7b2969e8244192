//! Results as text for a terminal of 80 columns.

use super::diagnosis::bars;
use super::fold::folded;
use super::position_loop;
use super::style::{GOOD, HEADING, painted};
use super::systematic;
use crate::number_text::{short, stated, with_error};
use crate::schema::contest::least_cost;
use servoid_engine::compare::{Row, quantile};
use servoid_engine::problem::Data;
use servoid_identify::fit::{
    Fit, LEAST_NOISE, LadderEntry, Parameter, ReadingNoise, RecordingError,
};
use servoid_io::recording::Drive;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::fmt::Write;

pub(super) fn parameter(p: &Parameter, converged: bool) -> String {
    let value = match (p.std, p.identifiable) {
        (None, _) if !converged => {
            return format!(
                "  {:26} {} {}, error unknown\n",
                p.name,
                short(p.value),
                p.unit
            );
        }
        (None, _) if p.at_bound => format!(
            "{} {}, held by a bound of its search range",
            short(p.value),
            p.unit
        ),
        (None, _) => return format!("  {:26} not determined by this recording\n", p.name),
        (Some(std), true) => {
            let (number, error) = stated(p.value, std, p.largest_systematic());
            let (usual, spread) = (usual(p), spread(p.spread));
            format!("{number} {}{usual}{error}{spread}", p.unit)
        }
        (Some(std), false) => {
            format!(
                "below {} {} (twice its standard error)",
                short(p.value.abs() + 2.0 * std),
                p.unit
            )
        }
    };
    format!("  {:26} {value}\n", p.name)
}

/// The noise that model and encoder leave.
pub(super) fn reading_noise(noise: &ReadingNoise) -> String {
    match noise.std {
        Some(std) => format!("{} counts", with_error(noise.counts, Some(std))),
        None => format!("at most {LEAST_NOISE} counts, the least that is followed"),
    }
}

/// The value in its usual unit, where the line has room for it.
fn usual(p: &Parameter) -> String {
    match (p.usual, p.spread) {
        (Some(usual), None) => format!(" = {} {}", short(usual.value), usual.unit),
        _ => String::new(),
    }
}

/// How far the recordings differ that were fitted alone.
fn spread(spread: Option<f64>) -> String {
    spread.map_or_else(String::new, |s| {
        format!(", spread {} between recordings", short(s))
    })
}

/// Open-loop error above which windows are shown unasked, counts.
const WINDOWS_ABOVE_COUNTS: f64 = 5.0;

/// A fit.
pub fn fit(fit: &Fit, data: &Data) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = write_fit(&mut out, fit, data);
    out
}

fn write_fit(out: &mut String, fit: &Fit, data: &Data) -> std::fmt::Result {
    let effects = if fit.effects.is_empty() {
        "linear motor".to_owned()
    } else {
        format!("linear motor + {}", fit.effects.join(" + "))
    };
    writeln!(
        out,
        "{}: {} samples, {:.3} s, worth {:.0} independent ones",
        data.source,
        data.len(),
        data.duration_s(),
        fit.effective_samples
    )?;
    out.push_str(&position_loop::lines(data));
    writeln!(
        out,
        "{effects}, by {} in {} model evaluations (seed {})",
        fit.algorithm, fit.evaluations, fit.seed
    )?;
    writeln!(out)?;
    writeln!(
        out,
        "{}   {:.4} counts RMS (encoder floor {FLOOR_RMS_COUNTS:.4})",
        painted(HEADING, "open-loop error"),
        fit.rms_counts
    )?;
    if let Some(rms) = fit.validate_rms_counts {
        writeln!(
            out,
            "{}    {rms:.4} counts RMS on the other recording, never fitted",
            painted(HEADING, "held-out error")
        )?;
    }
    out.push_str(&recordings(&fit.recordings));
    if !fit.error_ladder.is_empty() {
        write!(out, "\n{}\n", ladder(&fit.error_ladder))?;
    }
    // Beside a good open-loop error, windows would only show how roughly their starts are known.
    let worth_showing = fit.window_asked || fit.rms_counts > WINDOWS_ABOVE_COUNTS;
    if let Some(w) = fit.windowed.as_ref().filter(|_| worth_showing) {
        writeln!(
            out,
            "free runs of {} s  {:.4} counts RMS, {:.2} % of the motion",
            w.window_s,
            w.rms_counts,
            100.0 * w.relative
        )?;
    }
    if let Some(part) = fit.equation_error {
        writeln!(
            out,
            "equation error    {:.2} % of the drive is unexplained along the measured motion",
            100.0 * part
        )?;
    }
    writeln!(out, "cost ({})    {:.6}", fit.cost_kind, fit.cost)?;
    if let Some(found) = fit.lack_of_fit {
        write!(
            out,
            "{}",
            wrapped(&super::repeats::sentences(&found.into()))
        )?;
    }
    if let Some(noise) = &fit.reading_noise {
        writeln!(out, "noise before the counter    {}", reading_noise(noise))?;
    }
    writeln!(out)?;
    if data.drive == Drive::Voltage {
        let r = &fit.response;
        writeln!(out, "theta/V = gain / (s (a2 s^2 + a1 s + 1)):")?;
        writeln!(
            out,
            "  gain {:.6} rad/(s V), a1 {:.6e} s, a2 {:.6e} s^2",
            r.gain, r.a1, r.a2
        )?;
        if let Some(m) = &fit.margins {
            writeln!(
                out,
                "  position loop in radians: gain margin {:.2} dB, phase margin {:.2} deg",
                m.gain_db, m.phase_deg
            )?;
        }
        writeln!(out)?;
    }
    writeln!(
        out,
        "{}, with the standard error of the last digits in brackets:",
        painted(HEADING, "parameters")
    )?;
    for p in &fit.parameters {
        out.push_str(&parameter(p, fit.converged));
    }
    out.push_str(&systematic::table(&fit.parameters));
    out.push_str(&super::profile::lines(&fit.profiles));
    if let Some(own) = &fit.likelihood {
        super::likelihood::write(out, own)?;
    }
    if let Some(certificate) = &fit.certificate {
        super::certificate::write(out, certificate)?;
    }
    for note in &fit.notes {
        write!(out, "{}", wrapped(note))?;
    }
    Ok(())
}

/// The error on each of several recordings; nothing where there is one.
pub(super) fn recordings(errors: &[RecordingError]) -> String {
    let mut out = String::new();
    for error in errors {
        let role = if error.held_out { "held out" } else { "fitted" };
        out += &format!(
            "  {role:9} {:>12.4} counts RMS  {}\n",
            error.rms_counts, error.source
        );
        if let Some(replayed) = error.replay_rms_counts {
            out += &format!(
                "  {:9} {replayed:>12.4} counts RMS  driven by its position loop\n",
                ""
            );
        }
        for own in &error.own {
            let value = match own.std {
                Some(_) => with_error(own.value, own.std),
                None => short(own.value),
            };
            out += &format!("{:26}{} = {value} {}\n", "", own.name, own.unit);
        }
    }
    out
}

/// Errors as effects were added, and the encoder's own.
fn ladder(entries: &[LadderEntry]) -> String {
    let name = |entry: &LadderEntry| match entry.added {
        Some(effect) => format!("+ {effect}"),
        None => "linear motor".to_owned(),
    };
    let held_out = |entry: &LadderEntry| entry.validate_rms_counts.unwrap_or(f64::NAN);
    let mut lines: Vec<_> = (entries.iter())
        .map(|entry| (name(entry), entry.rms_counts, held_out(entry)))
        .collect();
    let floor = entries
        .iter()
        .all(|entry| entry.validate_rms_counts.is_some());
    lines.push((
        "encoder's own".to_owned(),
        FLOOR_RMS_COUNTS,
        if floor { FLOOR_RMS_COUNTS } else { f64::NAN },
    ));
    bars::ladder(&lines, None)
}

/// A remark, folded to 80 columns behind a dash.
pub(super) fn wrapped(note: &str) -> String {
    let words: Vec<&str> = note.split_whitespace().collect();
    folded(&format!("- {}", words.join(" ")), "  ") + "\n"
}

/// A comparison of search methods.
pub fn compare(rows: &[Row], budget: usize, seeds: usize) -> String {
    let least = least_cost(rows);
    let most = rows.iter().map(|row| row.runs.len()).max().unwrap_or(0);
    let head = format!(
        "{:12}{:>10}{:>11}{:>11}{:>10}{:>10}{:>8}{:>8}",
        "method", "median", "quartile 1", "quartile 3", "best", "worst", "evals", "CPU s",
    );
    let mut out = format!(
        "{most} of {seeds} runs each, at most {budget} model evaluations a run; least cost {}\n\n\
         {}\n{:12}{:>10}{:>42}{:>8}\n",
        short(least),
        painted(HEADING, head),
        "",
        "cost",
        "",
        "to 1 %",
    );
    for row in rows {
        let costs = row.costs();
        let [median, q1, q3, best, worst] =
            [0.5, 0.25, 0.75, 0.0, 1.0].map(|q| short(quantile(&costs, q)));
        let evaluations = row
            .median_evaluations_to(1.01 * least)
            .map_or("-".to_owned(), |n| format!("{n:.0}"));
        out += &format!(
            "{:12}{median:>10}{q1:>11}{q3:>11}{best:>10}{worst:>10}{evaluations:>8}{:>8.2}\n",
            row.algorithm, row.wall_s,
        );
    }
    out + &curves(rows, budget)
}

/// The median cost of each method over the evaluations.
fn curves(rows: &[Row], budget: usize) -> String {
    let curves: Vec<(&str, Vec<f64>)> = rows
        .iter()
        .map(|row| {
            let curve = row.curve(budget, 0.5).into_iter();
            (&*row.algorithm, curve.map(|(_, cost)| cost).collect())
        })
        .collect();
    let costs = || curves.iter().flat_map(|(_, costs)| costs);
    let finite = || costs().copied().filter(|cost| cost.is_finite());
    let (least, most) = (
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(0.0, f64::max),
    );
    if !(0.0 < least && least < most) {
        return String::new();
    }
    let mut out = format!(
        "\n{} over evaluations, both logarithmic, 1 to {budget}\n",
        painted(HEADING, "median cost")
    );
    for (name, costs) in &curves {
        let line: String = costs
            .iter()
            .map(|cost| bars::height((cost / least).ln() / (most / least).ln()))
            .collect();
        out += &format!("  {name:14}{}\n", painted(GOOD, line));
    }
    out
}
