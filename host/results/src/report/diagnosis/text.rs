//! A diagnosis as text for a terminal of 80 columns.

use super::bars::{counts, sparkline};
use super::residual::{table, whiteness_text};
use super::{DiagnosisReport, names};
use crate::number_text::short;
use crate::report::fold::folded;
use crate::report::likelihood;
use crate::report::position_loop;
use crate::report::style::{BAD, GOOD, HEADING, painted};
use crate::report::text::{parameter, recordings, wrapped};
use anstyle::Style;
use servoid_identify::diagnose::{Errors, HeldOut, Step, Verdict, evidence};
use servoid_identify::discovery::Proposed;
use shared::encoder::FLOOR_RMS_COUNTS;
use std::fmt::Write;

/// Characters of the residual over time.
const LINE: usize = 60;

impl DiagnosisReport<'_> {
    /// As text for a terminal.
    pub fn text(&self) -> String {
        let mut out = String::new();
        // Writing to a String cannot fail.
        let _ = self.write(&mut out);
        out
    }

    fn write(&self, out: &mut String) -> std::fmt::Result {
        let end = self.data.duration_s();
        let samples = self.data.len();
        writeln!(out, "{}: {samples} samples, {end:.3} s", self.data.source)?;
        out.push_str(&position_loop::lines(self.data));
        writeln!(out, "{}\n", folded(&self.held_out_text(), ""))?;
        writeln!(out, "{}\n", verdict(self.verdict(), &self.verdict_text()))?;
        self.ladder(out)?;
        out.push_str(&recordings(self.recordings));
        self.over_time(out)?;
        for index in 0..self.diagnosis.steps.len() {
            self.step(out, index)?;
        }
        out.push_str(&proposed_text(self.proposed));
        if self.verdict() == Verdict::Unexplained {
            let (what, found) = if self.diagnosis.fits_only_its_own() {
                ("on what was held out", &self.findings.held_out)
            } else {
                ("on the fitted recording", &self.findings.last)
            };
            let heading = painted(HEADING, "where the last model fails,");
            writeln!(out, "\n{heading} {what}")?;
            out.push_str(&table(found, None, self.data.drive.symbol()));
        }
        let white = whiteness_text(self.findings.last_whiteness.as_ref());
        writeln!(out, "\n{}", folded(&white, ""))?;
        self.parameters(out)?;
        for remark in &self.remarks {
            out.push_str(&wrapped(&remark.to_string()));
        }
        let heading = painted(HEADING, "what these recordings cannot tell:");
        writeln!(out, "\n{heading}")?;
        for text in self.cannot_tell() {
            out.push_str(&wrapped(&text));
        }
        let advice = self.advice();
        if !advice.is_empty() {
            writeln!(out, "\n{}", painted(HEADING, "next:"))?;
            for advice in advice {
                out.push_str(&wrapped(&advice));
            }
        }
        Ok(())
    }

    fn held_out_text(&self) -> String {
        match self.held_out {
            HeldOut::Recording(source) => format!("held out, never fitted: {source}"),
            HeldOut::End {
                from_s,
                seconds,
                at_rest,
                ..
            } => {
                let at = if *at_rest {
                    "where the motor stood still"
                } else {
                    "while the motor was driven or turning"
                };
                format!(
                    "held out, never fitted: its last {seconds:.3} s, cut off at {from_s:.3} s {at}; another recording \
                     given with --validate would be a harder test"
                )
            }
            HeldOut::Nothing => {
                "nothing is held out: --validate is the recording itself, so that the second error is no test"
                    .to_owned()
            }
        }
    }

    /// Errors from the linear motor to the last model, and the encoder's own.
    fn ladder(&self, out: &mut String) -> std::fmt::Result {
        let diagnosis = self.diagnosis;
        let mut entries = Vec::new();
        let mut enter = |name: String, ran: Errors| entries.push((name, ran.fitted, ran.held_out));
        enter("linear motor".to_owned(), diagnosis.base.ran());
        if let Some(baseline) = &diagnosis.baseline {
            enter("baseline".to_owned(), self.over_span(&baseline.prediction));
        }
        for step in &diagnosis.steps {
            if let Some(after) = step.candidates.first() {
                enter(format!("+ {}", step.added.name()), after.ran());
            }
        }
        if let Some(last) = entries.last_mut().filter(|_| !diagnosis.steps.is_empty()) {
            (last.1, last.2) = self.last_over_span();
        }
        if let Some(floor) = self.repeats_itself() {
            entries.push((
                "not repeated by the motor".to_owned(),
                floor.counts,
                f64::NAN,
            ));
        }
        entries.push((
            "encoder's own".to_owned(),
            FLOOR_RMS_COUNTS,
            FLOOR_RMS_COUNTS,
        ));
        out.push_str(&super::bars::ladder(&entries, diagnosis.span.window_s));
        if let Some(baseline) = &diagnosis.baseline {
            let text = format!(
                "baseline: linear motor + {}",
                names(&baseline.effects).join(" + ")
            );
            writeln!(out, "{}", folded(&text, "  "))?;
        }
        Ok(())
    }

    /// The residual over time, of the linear motor and of the last model.
    fn over_time(&self, out: &mut String) -> std::fmt::Result {
        let (base, last) = (&self.findings.base_errors, &self.findings.last_errors);
        let size = |errors: &[f64]| errors.iter().fold(0.0, |m: f64, e| m.max(e.abs()));
        let most = size(base);
        writeln!(
            out,
            "{}, logarithmic up to {}",
            painted(HEADING, "residual over time"),
            counts(most)
        )?;
        let mut line = |name: &str, errors: &[f64], style: Style| {
            let line = painted(style, sparkline(errors, most, LINE));
            writeln!(out, "  {name:14}{line}")
        };
        line("linear motor", base, BAD)?;
        if self.diagnosis.steps.is_empty() {
            return Ok(());
        }
        line("last model", last, GOOD)
    }

    fn step(&self, out: &mut String, index: usize) -> std::fmt::Result {
        let step = &self.diagnosis.steps[index];
        let description = step.added.description();
        let name = painted(HEADING, step.added.name());
        writeln!(out, "\n{}. {name}: {}", index + 1, description.title)?;
        let mut say = |name: &str, text: &str| {
            writeln!(
                out,
                "{}",
                folded(&format!("   {name:12}{text}"), "               ")
            )
        };
        say("equation", description.equation)?;
        say("why", &self.evidence(index))?;
        say("look-alikes", &self.company_text(step))?;
        if let Some(after) = step.candidates.first() {
            // A model that was not screened has no prediction.
            if after.predicted_rms_counts.is_finite() {
                say(
                    "foreseen",
                    &format!(
                        "{} counts RMS before the refit; {} reached",
                        counts(after.predicted_rms_counts),
                        counts(after.rms_counts)
                    ),
                )?;
            }
            if let Some(windowed) = after.windowed {
                say(
                    "judged by",
                    &format!(
                        "errors in windows run from the measured state: {} fitted, {} held out",
                        counts(windowed.fitted),
                        counts(windowed.held_out)
                    ),
                )?;
            }
            if let Some(tracked) = after.observed {
                say(
                    "judged by",
                    &format!(
                        "errors that are forgotten within {} s, since the free run is chaotic: {} fitted, {} held out",
                        tracked.memory_s,
                        counts(tracked.errors.fitted),
                        counts(tracked.errors.held_out)
                    ),
                )?;
            }
        }
        let curve = self.findings.curves.get(index).and_then(Option::as_ref);
        if let Some((curve, [from, to])) = curve.and_then(|curve| Some((curve, curve.leaves()?))) {
            let (variable, unit) = (curve.carrier.name(), curve.carrier.unit());
            say(
                "but",
                &format!(
                    "a curve of the {variable} that has no stated form leaves its band around the effect between {} and {} {unit}: \
                     the effect is not the whole story",
                    short(from),
                    short(to)
                ),
            )?;
        }
        say("confidence", &format!("{:.2}", step.confidence))?;
        if let Some(found) = self.findings.steps.get(index).and_then(Option::as_ref) {
            out.push_str(&table(
                found,
                evidence::axis(step.added),
                self.data.drive.symbol(),
            ));
        }
        Ok(())
    }

    /// Other effects that explain the data as well.
    fn company_text(&self, step: &Step) -> String {
        let (alike, refine) = (self.look_alikes(step), self.refinements(step));
        let sums = self.other_sets(step.added);
        let mut text = if alike.is_empty() && sums.is_empty() {
            nothing_else(self.interrupted || self.diagnosis.ran_out).to_owned()
        } else if alike.is_empty() {
            format!("{} would explain these data as well", sums.join(", or "))
        } else {
            format!(
                "{} would explain these data as well",
                names(&alike).join(", ")
            )
        };
        if !refine.is_empty() {
            text += &format!(
                "; {} would refine it, and these data do not ask for that",
                names(&refine).join(" or ")
            );
        }
        text
    }

    fn parameters(&self, out: &mut String) -> std::fmt::Result {
        let heading = painted(HEADING, "parameters of the last model");
        writeln!(
            out,
            "\n{heading}, standard error of the last digits in brackets:"
        )?;
        for p in &self.last.parameters {
            out.push_str(&parameter(p, self.last.converged));
        }
        if let Some(own) = &self.last.likelihood {
            likelihood::write(out, own)?;
        }
        for note in &self.last.range_notes {
            writeln!(out, "{}", folded(&format!("- {note}"), "  "))?;
        }
        Ok(())
    }
}

/// The verdict's name, and what it says, folded.
pub(super) fn verdict(verdict: Verdict, text: &str) -> String {
    let name = verdict.name();
    let style = match verdict {
        Verdict::Unexplained => BAD,
        _ => GOOD,
    };
    let folded = folded(&format!("{name}: {text}"), "");
    folded.replacen(name, &painted(style.bold(), name), 1)
}

/// Where no other effect explains the data as well: a diagnosis that was stopped has not tried all of them.
pub(in crate::report) fn nothing_else(stopped: bool) -> &'static str {
    if stopped {
        "the work was stopped before all others had been tried"
    } else {
        "nothing else of the catalogue explains these data as well"
    }
}

/// Laws that were proposed for what the catalogue leaves.
fn proposed_text(proposed: Option<&[Proposed]>) -> String {
    let Some(proposed) = proposed else {
        return String::new();
    };
    let mut out = format!("\n{}\n", painted(HEADING, "not in the catalogue:"));
    if proposed.is_empty() {
        out.push_str(&wrapped(
            "nothing simple explains what is left: no law of one or two terms holds on what was held out",
        ));
    }
    for law in proposed {
        let percent = 100.0 * law.explained;
        let like = law
            .resembles
            .map(|(kind, part)| format!("; {:.0} % like {}", 100.0 * part, kind.name()));
        let what = if law.named {
            "is named; before it was simulated, it explained"
        } else {
            "was simulated and is not confirmed; along the measured motion it explains"
        };
        out.push_str(&wrapped(&format!(
            "{} {what} {percent:.0} % of the missing volts on what was held out{}",
            law.name,
            like.unwrap_or_default()
        )));
        out.push_str(&wrapped(&format!("--effect \"{}\"", law.text)));
    }
    out
}
