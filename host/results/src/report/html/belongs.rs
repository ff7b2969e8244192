//! Whether recordings are those that a result was made from: its model must miss them by what the result says.

use super::fit::model;
use crate::error::Error;
use crate::picture::Run;
use crate::report::diagnosis::bars::counts;
use crate::schema::{self, Diagnosis, Document, Fit};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{HeldOut, holdout};
use servoid_io::recording::Recording;

/// Errors that differ by more than this part are of different recordings: the same one gives the same bits, and two of one
/// motor differ by chance in the third digit.
const SAME: f64 = 1e-5;

/// A sentence for each recording that cannot be the one that the result was made from.
///
/// # Errors
/// A model that is none, or that cannot run along the recordings.
pub fn doubts(
    document: &Document,
    fitted: Option<&Recording>,
    held_out: Option<&Recording>,
) -> Result<Vec<String>, Error> {
    let claim = match document {
        Document::Fit(fit) => fitted_to(fit),
        Document::Demo(demo) => match &demo.diagnosis {
            Some(diagnosis) => diagnosed(diagnosis),
            None => fitted_to(&demo.fit),
        },
        Document::Diagnosis(diagnosis) => diagnosed(diagnosis),
        Document::Verification(verification) => match &verification.diagnosis {
            Some(diagnosis) => diagnosed(diagnosis),
            None => return Ok(Vec::new()),
        },
        Document::Device(..) | Document::Steady(_) | Document::Contest(_) => return Ok(Vec::new()),
    };
    let model = model("model", claim.model, "model")?;
    let mut doubts = Vec::new();
    if let Some((recording, rms)) = fitted.zip(claim.rms_counts) {
        let data = claim.fitted(recording)?;
        let run = data.map(|data| model.run(&data)).transpose()?;
        doubts.extend(doubt(&recording.source, claim.recording, rms, run.as_ref()));
    }
    if let Some(((recording, rms), name)) = held_out.zip(claim.other_rms_counts).zip(claim.other) {
        let run = model.run_unseen(&Data::new(recording)?)?;
        doubts.extend(doubt(&recording.source, name, rms, Some(&run)));
    }
    Ok(doubts)
}

/// What a result says of its recordings.
struct Claim<'a> {
    model: &'a schema::Model,
    recording: &'a str,
    rms_counts: Option<f64>,
    other: Option<&'a str>,
    other_rms_counts: Option<f64>,
    /// Whether the end of the only recording was held out.
    is_cut: bool,
}

fn fitted_to(fit: &Fit) -> Claim<'_> {
    Claim {
        model: &fit.model,
        recording: &fit.recording,
        rms_counts: Some(fit.rms_counts),
        other: fit.validate.as_deref(),
        other_rms_counts: fit.validate_rms_counts,
        is_cut: false,
    }
}

fn diagnosed(diagnosis: &Diagnosis) -> Claim<'_> {
    Claim {
        model: &diagnosis.last.model,
        recording: &diagnosis.recording,
        rms_counts: diagnosis.last.rms_counts,
        other: diagnosis.held_out.source.as_deref(),
        other_rms_counts: diagnosis.last.validate_rms_counts,
        is_cut: diagnosis.held_out.from_s.is_some(),
    }
}

impl Claim<'_> {
    /// What was fitted of the recording; `None` where it is too short for its end to have been held out.
    fn fitted(&self, recording: &Recording) -> Result<Option<Data>, Error> {
        if !self.is_cut {
            return Ok(Some(Data::new(recording)?));
        }
        match holdout::cut(recording) {
            Some((first, _, HeldOut::End { .. })) => Ok(Some(Data::new(&first)?)),
            _ => Ok(None),
        }
    }
}

fn doubt(seen: &str, named: &str, claim: f64, run: Option<&Run>) -> Option<String> {
    let why = match run {
        Some(run) => {
            let squares: f64 = run.residual.iter().map(|e| e * e).sum();
            let rms = (squares / run.residual.len() as f64).sqrt();
            if (rms - claim).abs() <= SAME * claim {
                return None;
            }
            let (rms, claim) = (counts(rms), counts(claim));
            format!("the model misses it by {rms} counts RMS, and the result says {claim}")
        }
        None => "it is too short for its end to have been held out".to_owned(),
    };
    Some(format!(
        "{seen} is not the recording that this result was made from ({named}): {why}. The drawings show another recording \
         than the numbers."
    ))
}
