//! The recordings of a diagnosis, checked: the one that is fitted, and the one that judges.

use crate::diagnose::{HeldOut, Remark, holdout, usable};
use crate::error::Error;
use crate::fit::{self, Options};
use servoid_engine::problem::Data;
use servoid_io::recording::Recording;
use std::sync::Arc;

/// What a diagnosis fits and what it judges by.
#[derive(Clone, Debug)]
pub struct Datasets {
    /// Fitted.
    pub fitted: Data,
    /// Never fitted: another recording of the same motor, or the end of the only one.
    pub held_out: Data,
    /// Which of the two.
    pub kind: HeldOut,
    /// Remarks on the recordings.
    pub remarks: Vec<Remark>,
    /// The only recording, where its end is held out.
    pub whole: Option<Arc<Data>>,
}

impl Datasets {
    /// Checks the recordings and lowers them; without `validation` the end of the recording is held out.
    ///
    /// # Errors
    /// A recording that is too short, was not driven, or is in other units than it says.
    pub fn new(
        recording: Recording,
        validation: Option<Recording>,
        options: &Options,
    ) -> Result<Self, Error> {
        match validation {
            Some(other) => Self::of_two(recording, other, options),
            None => Self::of_one(recording, options),
        }
    }

    fn of_one(recording: Recording, options: &Options) -> Result<Self, Error> {
        let remarks = usable::check(&recording, options.force)?;
        let (first, rest, kind) = holdout::cut(&recording).ok_or_else(|| {
            Error::Failed(format!(
                "{}: {:.3} s are too short to hold a part of them out; give another recording of the same motor with \
                 --validate, or record some seconds",
                recording.source,
                recording.duration_s()
            ))
        })?;
        first.check_excited()?;
        rest.check_excited()?;
        let whole = Arc::new(Data::taken(recording)?);
        Ok(Datasets {
            fitted: Data::taken(first)?,
            held_out: Data::taken(rest)?.at_end_of(Arc::clone(&whole)),
            kind,
            remarks,
            whole: Some(whole),
        })
    }

    fn of_two(recording: Recording, other: Recording, options: &Options) -> Result<Self, Error> {
        let mut remarks = usable::check(&recording, options.force)?;
        let copied = other.counts == recording.counts && other.command == recording.command;
        let kind = if copied {
            remarks.push(Remark::aside(
                "--validate is the recording itself: nothing is held out, and an effect that only bends itself to this one \
                 recording would not be found out"
                    .to_owned(),
            ));
            HeldOut::Nothing
        } else {
            remarks.extend(usable::check(&other, options.force)?);
            HeldOut::Recording(other.source.clone())
        };
        let (fitted, held_out) = (Data::taken(recording)?, Data::taken(other)?);
        for data in [&fitted, &held_out] {
            if fit::is_reversed(data, options) {
                // The message with its remedy.
                fit::problem(data, options)?;
            }
        }
        Ok(Datasets {
            fitted,
            held_out,
            kind,
            remarks,
            whole: None,
        })
    }
}
