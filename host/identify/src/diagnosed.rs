//! The front door of a diagnosis: every face comes through here.

use crate::datasets::Datasets;
use crate::diagnose::{self, Budget, Diagnosis, HeldOut, Remark, pair};
use crate::discovery::{self, Proposed};
use crate::error::Error;
use crate::findings::{Findings, findings};
use crate::fit::recordings::{loop_remarks, recording_errors};
use crate::fit::{Fit, Options, RecordingError};
use crate::likelihood;
use crate::progress::Progress;
use servoid_engine::problem::Data;
use servoid_io::recording::Recording;
use std::sync::atomic::Ordering;

/// A diagnosis with all that a report says of it.
pub struct Diagnosed {
    /// The verdict, the effects that were named, and what they were chosen from.
    pub diagnosis: Diagnosis,
    /// The last model, fitted to its end: parameters with intervals.
    pub last: Fit,
    /// Where the models fail.
    pub findings: Findings,
    /// Remarks on the recordings.
    pub remarks: Vec<Remark>,
    /// The error of the last model on each recording, where there are several.
    pub recordings: Vec<RecordingError>,
    /// Whether the search for effects was stopped.
    pub interrupted: bool,
    /// Laws that were proposed for what the catalogue leaves; none where they were not looked for.
    pub proposed: Option<Vec<Proposed>>,
}

/// Names the physical effects that a recording shows and the linear motor lacks. `validation` is another recording of the
/// same motor, never fitted; without one the end of the recording is held out.
///
/// # Errors
/// A recording that cannot be used, with the remedy; [`Error::Failed`] where not even the linear motor can be fitted.
///
/// # Example
/// ```
/// use servoid_identify::{Silent, diagnose, fit::Options};
/// use servoid_io::showcase;
/// use servoid_plant::Hidden;
///
/// let hidden = Hidden::typical("coulomb", &showcase::machine())?;
/// let recording = showcase::record(std::slice::from_ref(&hidden), 1, "fitted")?;
/// let other = showcase::record(std::slice::from_ref(&hidden), 2, "held out")?;
///
/// let found = diagnose(&recording, Some(&other), &Options::default(), &Silent::default())?;
/// let named: Vec<&str> = found.diagnosis.steps.iter().map(|step| step.added.name()).collect();
/// assert_eq!(named, ["coulomb"]);
/// assert!(found.last.rms_counts < 0.3, "counts RMS, at the encoder's floor");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn diagnose(
    recording: &Recording,
    validation: Option<&Recording>,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Diagnosed, Error> {
    let datasets = Datasets::new(recording.clone(), validation.cloned(), options)?;
    let budget = Budget::usual(progress.stop());
    diagnose_datasets(&datasets, options, &budget, progress)
}

/// As [`diagnose()`], for recordings that are checked and lowered, within a budget.
///
/// # Errors
/// As [`diagnose()`].
pub fn diagnose_datasets(
    datasets: &Datasets,
    options: &Options,
    budget: &Budget<'_>,
    progress: &dyn Progress,
) -> Result<Diagnosed, Error> {
    let mut diagnosed = diagnose_data(
        &datasets.fitted,
        &datasets.held_out,
        &datasets.kind,
        options,
        budget,
        progress,
    )?;
    let mut remarks = datasets.remarks.clone();
    remarks.append(&mut diagnosed.remarks);
    diagnosed.remarks = remarks;
    Ok(diagnosed)
}

/// As [`diagnose_datasets`], of recordings that the caller has lowered and checked; the remarks are on the pair alone.
///
/// # Errors
/// As [`diagnose()`].
pub fn diagnose_data(
    fitted: &Data,
    held_out: &Data,
    kind: &HeldOut,
    options: &Options,
    budget: &Budget<'_>,
    progress: &dyn Progress,
) -> Result<Diagnosed, Error> {
    let stop = progress.stop();
    let tried = || progress.tried();
    let (diagnosis, proposed) =
        discovery::search_with_laws(fitted, held_out, options, budget, &tried)?;
    let interrupted = stop.load(Ordering::Relaxed);
    let mut last = diagnose::settle(&diagnosis, fitted, held_out, options, stop)?;
    // Where a score gave the standard errors, a likelihood of its own would be a second table of the same numbers.
    if !interrupted && diagnosis.last.standard_errors.is_empty() {
        last.likelihood = likelihood::section(fitted, &last, &diagnosis.last.effects, stop);
    }
    let findings = findings(&diagnosis, fitted, held_out)?;
    let mut remarks = if interrupted || diagnosis.ran_out {
        Vec::new()
    } else {
        pair::remarks(&diagnosis, fitted, held_out, kind, options, stop)?
    };
    let recordings = recording_errors(fitted, Some(held_out), &last.candidate, last.method)?;
    remarks.extend(loop_remarks(&recordings).map(Remark::aside));
    Ok(Diagnosed {
        recordings,
        diagnosis,
        last,
        findings,
        remarks,
        interrupted,
        proposed,
    })
}
