//! The recordings of a diagnosis, checked: those that are fitted, and those that judge.

use crate::diagnose::{HeldOut, Remark, holdout, usable};
use crate::error::Error;
use crate::fit::{self, Options};
use crate::prepared::prepare;
use servoid_engine::problem::Data;
use servoid_io::recording::Recording;
use std::slice;
use std::sync::Arc;

/// What a diagnosis fits and what it judges by.
#[derive(Clone, Debug)]
pub struct Datasets {
    /// Fitted.
    pub fitted: Data,
    /// Never fitted: other recordings of the same motor, or the end of the only one.
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
        Self::of_several(vec![recording], validation.into_iter().collect(), options)
    }

    /// As [`new`](Self::new), for several recordings of one motor. Where none is given to judge by, the last of several is
    /// held out, or the end of the only one.
    ///
    /// # Errors
    /// As [`new`](Self::new), and where the recordings have another encoder or drive.
    pub fn of_several(
        mut fitted: Vec<Recording>,
        mut held_out: Vec<Recording>,
        options: &Options,
    ) -> Result<Self, Error> {
        for recording in fitted.iter().chain(&held_out) {
            recording.check_excited()?;
        }
        if held_out.is_empty() && fitted.len() > 1 {
            held_out.extend(fitted.pop());
        }
        if let (1, true) = (fitted.len(), held_out.is_empty()) {
            return Self::of_one(fitted.swap_remove(0), options);
        }
        let mut remarks = Vec::new();
        for recording in &fitted {
            remarks.extend(usable::check(recording, options.force)?);
        }
        let copied = |other: &Recording| fitted.iter().any(|one| one.is_copy_of(other));
        let copies = held_out.iter().filter(|other| copied(other)).count();
        let nothing = copies == held_out.len();
        if nothing {
            remarks.push(Remark::aside(
                "--validate is the recording itself: nothing is held out, and an effect that only bends itself to this one \
                 recording would not be found out"
                    .to_owned(),
            ));
        } else {
            held_out.retain(|other| !copied(other));
            if copies > 0 {
                remarks.push(Remark::aside(format!(
                    "--validate: {copies} of the recordings are fitted, too, and are not held out"
                )));
            }
            for other in &held_out {
                remarks.extend(usable::check(other, options.force)?);
            }
        }
        let prepared = prepare(&mut fitted, &mut held_out);
        remarks.extend(prepared.into_iter().map(Remark::aside));
        let (fitted, held_out) = (Data::joined(fitted)?, Data::joined(held_out)?);
        for data in [&fitted, &held_out] {
            if fit::is_reversed(data, options) {
                // The message with its remedy.
                fit::problem(data, options)?;
            }
        }
        let kind = if nothing {
            HeldOut::Nothing
        } else {
            HeldOut::Recording(held_out.source.clone())
        };
        Ok(Datasets {
            fitted,
            held_out,
            kind,
            remarks,
            whole: None,
        })
    }

    fn of_one(mut recording: Recording, options: &Options) -> Result<Self, Error> {
        let mut remarks = usable::check(&recording, options.force)?;
        let prepared = prepare(slice::from_mut(&mut recording), &mut []);
        remarks.extend(prepared.into_iter().map(Remark::aside));
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
}
