//! The recordings of a fit, checked: those that are fitted together, and those that are scored.

use crate::check;
use crate::error::Error;
use crate::fit::{Fit, Options};
use crate::identify::identify_data;
use crate::prepared::prepare;
use crate::progress::Progress;
use servoid_engine::problem::Data;
use servoid_io::recording::Recording;

/// What a fit fits, and what it is scored by.
#[derive(Clone, Debug)]
pub struct FitSets {
    /// Fitted.
    pub fitted: Data,
    /// Never fitted; none where none is given, or only copies of what is fitted.
    pub held_out: Option<Data>,
    /// What a user should know of the recordings.
    pub remarks: Vec<String>,
}

impl FitSets {
    /// Checks the recordings and lowers them; `force` passes what a check refuses.
    ///
    /// # Errors
    /// A recording without a response, or that the [check](crate::check) refuses; recordings that cannot be taken together.
    pub fn of_several(
        mut fitted: Vec<Recording>,
        mut held_out: Vec<Recording>,
        force: bool,
    ) -> Result<Self, Error> {
        for recording in fitted.iter().chain(&held_out) {
            recording.check_excited()?;
        }
        let mut remarks = Vec::new();
        for recording in &fitted {
            let findings = check::passed(recording, force)?;
            remarks.extend(findings.iter().map(check::Finding::text));
        }
        let given = held_out.len();
        held_out.retain(|other| !fitted.iter().any(|one| one.is_copy_of(other)));
        if held_out.len() < given {
            remarks.push(
                "--validate is the recording itself: nothing is held out; give another recording of the same motor"
                    .to_owned(),
            );
        }
        remarks.extend(prepare(&mut fitted, &mut held_out));
        let scored = !held_out.is_empty();
        Ok(FitSets {
            fitted: Data::joined(fitted)?,
            held_out: scored.then(|| Data::joined(held_out)).transpose()?,
            remarks,
        })
    }

    /// Fits a model to them.
    ///
    /// # Errors
    /// As [`identify()`](crate::identify()).
    pub fn identify(&self, options: &Options, progress: &dyn Progress) -> Result<Fit, Error> {
        identify_data(&self.fitted, self.held_out.as_ref(), options, progress)
    }
}
