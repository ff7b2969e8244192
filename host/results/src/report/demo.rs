//! The story of the demonstration, as text and as a document.

use super::diagnosis::DiagnosisReport;
use super::fold::folded;
use crate::schema::fit::Miss;
use crate::schema::{Demo, Diagnosis, Fit, finite};
use servoid_identify::truth::{self, ParameterError};
use servoid_plant::{Hidden, Machine};
use shared::effects::Kind;

/// What was hidden in the motor, and what the diagnosis made of it.
pub struct DemoReport<'a> {
    /// The diagnosis.
    pub diagnosis: DiagnosisReport<'a>,
    /// The motor on the bench.
    pub machine: Machine,
    /// What is hidden in it.
    pub hidden: &'a Hidden,
    /// The same in words.
    pub described: String,
    /// True if it is revealed at the end only.
    pub blind: bool,
    /// Encoder counts per revolution.
    pub counts_per_rev: u32,
}

impl From<&DemoReport<'_>> for Demo {
    fn from(report: &DemoReport<'_>) -> Self {
        let [gain, a1] = report.response_errors();
        let misses = report.parameter_errors().into_iter();
        Demo {
            fit: Fit::new(
                report.diagnosis.last,
                report.diagnosis.data,
                report.diagnosis.held_out.source(),
            ),
            hidden: Some(report.described.clone()),
            named: report.named(),
            parameter_errors: misses.map(Miss::from).collect(),
            gain_error_percent: finite(gain),
            a1_error_percent: finite(a1),
            diagnosis: Some(Box::new(Diagnosis::from(&report.diagnosis))),
        }
    }
}

impl DemoReport<'_> {
    /// As text for a terminal.
    pub fn text(&self) -> String {
        format!(
            "{}\n{}\n{}",
            self.opening(),
            self.diagnosis.text(),
            self.truth()
        )
    }

    fn opening(&self) -> String {
        let secret = if self.blind {
            "something that is told at the end".to_owned()
        } else {
            self.described.clone()
        };
        format!(
            "The virtual bench records a gearmotor twice. Hidden in it:\n{}\nThe first recording is fitted, the second one \
             is held out.\n",
            folded(&format!("  {secret}"), "    ")
        )
    }

    /// What was hidden, and how far off the diagnosis is, which only a bench can tell.
    fn truth(&self) -> String {
        let hidden = format!("the bench knows the truth: hidden was {}", self.described);
        let named = match (self.named(), self.diagnosis.names()) {
            (true, _) => "  the diagnosis named it".to_owned(),
            (false, Some(names)) => format!("  the diagnosis named {names} instead"),
            (false, None) => "  the diagnosis named nothing".to_owned(),
        };
        let mut text = format!("{}\n{}\n", folded(&hidden, "  "), folded(&named, "    "));
        let [gain, a1] = self.response_errors();
        for (name, percent) in [("gain", gain), ("a1", a1)] {
            text += &format!("  {name:28} off by {percent:.4} %\n");
        }
        for error in self.parameter_errors() {
            let name = format!("{}.{}", error.effect, error.parameter);
            text += &format!("  {name:28} off by {:.4} %\n", error.percent);
        }
        text
    }

    /// Whether the hidden effect is in the last model.
    fn named(&self) -> bool {
        let mut effects = self.diagnosis.diagnosis.last.effects.iter();
        effects.any(|kind| kind.name() == self.hidden.name())
    }

    fn parameter_errors(&self) -> Vec<ParameterError> {
        let Some(kind) = Kind::by_name(self.hidden.name()) else {
            return Vec::new();
        };
        let truth = self.hidden.truth(&self.machine, self.counts_per_rev);
        let found = values_of(self, kind);
        if found.is_empty() {
            return Vec::new();
        }
        truth::errors(kind, &found, &truth)
    }

    /// Errors of gain and a1, per cent.
    fn response_errors(&self) -> [f64; 2] {
        let truth = truth::physical(&self.machine).machine().response();
        let found = self.diagnosis.last.response;
        let percent = |found: f64, truth: f64| 100.0 * (found / truth - 1.0).abs();
        [percent(found.gain, truth.gain), percent(found.a1, truth.a1)]
    }
}

/// Values that the last model, fitted to its end, has for an effect.
fn values_of(report: &DemoReport<'_>, kind: Kind) -> Vec<f64> {
    let mut effects = report.diagnosis.last.candidate.effects.iter();
    let found = effects.find(|(own, _)| *own == kind);
    match found {
        Some((_, values)) => values.to_vec(),
        None => report.diagnosis.diagnosis.last.values_of(kind),
    }
}
