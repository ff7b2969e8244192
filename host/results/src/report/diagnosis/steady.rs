//! What a curve of steady speeds says, as text and as JSON.

use super::text::verdict;
use crate::report::paint::{HEADING, painted};
use crate::report::text::wrapped;
use serde::Serialize;
use servoid_identify::diagnose::Verdict;
use servoid_identify::diagnose::steady::{SteadyDiagnosis, SteadyFit};
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

/// The keys of `servoid.diagnosis/1` that a curve can fill, and its own.
#[derive(Debug, Serialize)]
pub struct SteadyJson {
    schema: &'static str,
    quantization_floor_counts: Option<f64>,
    base: ModelJson,
    verdict: &'static str,
    summary: String,
    steps: [(); 0],
    #[serde(rename = "final")]
    last: ModelJson,
    advice: Vec<&'static str>,
    steady: CurveJson,
    recording: String,
    seed: u64,
    interrupted: bool,
    version: &'static str,
}

#[derive(Debug, Serialize)]
struct ModelJson {
    effects: [&'static str; 0],
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
    parameters: [(); 0],
}

#[derive(Debug, Serialize)]
struct CurveJson {
    points: usize,
    /// Voltage, V, and speed, rad/s.
    curve: Vec<(f64, f64)>,
    linear: FitJson,
    with_drop: FitJson,
    p_value: f64,
    indistinguishable: Vec<&'static str>,
}

#[derive(Debug, Serialize)]
struct FitJson {
    slope_v_s_rad: f64,
    drop_v: f64,
    relative: f64,
}

impl From<&SteadyFit> for FitJson {
    fn from(fit: &SteadyFit) -> Self {
        FitJson {
            slope_v_s_rad: fit.slope,
            drop_v: fit.drop_v,
            relative: fit.relative,
        }
    }
}

/// A curve has no encoder and no run to simulate.
const NOTHING_SIMULATED: ModelJson = ModelJson {
    effects: [],
    rms_counts: None,
    validate_rms_counts: None,
    parameters: [],
};

impl From<&SteadyReport<'_>> for SteadyJson {
    fn from(report: &SteadyReport<'_>) -> Self {
        let diagnosis = report.diagnosis;
        SteadyJson {
            schema: "servoid.diagnosis/1",
            quantization_floor_counts: None,
            base: NOTHING_SIMULATED,
            verdict: diagnosis.verdict.name(),
            summary: report.summary(),
            steps: [],
            last: NOTHING_SIMULATED,
            advice: diagnosis.advice.into_iter().collect(),
            steady: CurveJson {
                points: report.curve.points.len(),
                curve: report.curve.points.clone(),
                linear: (&diagnosis.linear).into(),
                with_drop: (&diagnosis.with_drop).into(),
                p_value: diagnosis.p_value,
                indistinguishable: report.names(),
            },
            recording: report.curve.source.clone(),
            seed: report.seed,
            interrupted: false,
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}
