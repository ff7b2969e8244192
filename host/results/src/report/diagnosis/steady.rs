//! What a curve of steady speeds says, as text and as a document.

use super::text::verdict;
use crate::report::style::{HEADING, painted};
use crate::report::text::wrapped;
use crate::schema::diagnosis::SCHEMA;
use crate::schema::steady::{Curve, NotSimulated};
use crate::schema::{Steady, VERSION, finite};
use servoid_identify::diagnose::Verdict;
use servoid_identify::steady::{SteadyDiagnosis, SteadyFit};
use servoid_io::input::SteadyCurve;
use std::fmt::Write;

/// A curve, its diagnosis and where it came from.
pub struct SteadyReport<'a> {
    /// The curve.
    pub curve: &'a SteadyCurve,
    /// What it says.
    pub diagnosis: &'a SteadyDiagnosis,
    /// Seed of the run, though nothing here is random.
    pub seed: u64,
}

impl SteadyReport<'_> {
    fn summary(&self) -> String {
        let names: Vec<&str> = self.names();
        let drop = self.diagnosis.with_drop.drop_v;
        if self.diagnosis.verdict == Verdict::Unexplained {
            return "Steady speed does not follow the voltage in a straight line, and no constant drop mends that."
                .to_owned();
        }
        match names.split_last() {
            None => {
                "Steady speed follows the voltage in a straight line; nothing constant is lost."
                    .to_owned()
            }
            Some((last, rest)) => format!(
                "A constant {drop:.3} V is missing at every speed; steady speeds cannot tell whether {} or {last} takes it.",
                rest.join(", ")
            ),
        }
    }

    fn names(&self) -> Vec<&'static str> {
        let kinds = self.diagnosis.indistinguishable.iter();
        kinds.map(|kind| kind.name()).collect()
    }

    /// As text for a terminal.
    pub fn text(&self) -> String {
        let (linear, drop) = (&self.diagnosis.linear, &self.diagnosis.with_drop);
        let mut out = String::new();
        // Writing to a String cannot fail.
        let _ = writeln!(
            out,
            "{}: {} points of steady speed against voltage\n",
            self.curve.source,
            self.curve.points.len()
        );
        let verdict = verdict(self.diagnosis.verdict, &self.summary());
        let _ = writeln!(out, "{verdict}");
        let row = |fit: &SteadyFit| format!("errs by {:.2} % of the voltage", 100.0 * fit.relative);
        let _ = writeln!(
            out,
            "\nV = {:.5} V*s/rad * speed                   {}",
            linear.slope,
            row(linear)
        );
        let _ = writeln!(
            out,
            "V = {:.5} V*s/rad * speed {:+.4} V drop    {}",
            drop.slope,
            drop.drop_v,
            row(drop)
        );
        if let Some(advice) = self.diagnosis.advice {
            let _ = writeln!(out, "\n{}", painted(HEADING, "next:"));
            out.push_str(&wrapped(advice));
        }
        out
    }
}

impl From<&SteadyReport<'_>> for Steady {
    fn from(report: &SteadyReport<'_>) -> Self {
        let diagnosis = report.diagnosis;
        let owned = |name: &str| name.to_owned();
        Steady {
            schema: SCHEMA.to_owned(),
            quantization_floor_counts: None,
            base: NotSimulated::default(),
            verdict: diagnosis.verdict.name().to_owned(),
            summary: report.summary(),
            steps: [],
            last: NotSimulated::default(),
            advice: diagnosis.advice.into_iter().map(owned).collect(),
            steady: Curve {
                points: report.curve.points.len(),
                curve: report.curve.points.clone(),
                linear: (&diagnosis.linear).into(),
                with_drop: (&diagnosis.with_drop).into(),
                p_value: finite(diagnosis.p_value),
                indistinguishable: report.names().into_iter().map(owned).collect(),
            },
            recording: report.curve.source.clone(),
            seed: report.seed,
            interrupted: false,
            version: VERSION.to_owned(),
        }
    }
}
