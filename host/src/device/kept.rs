//! A run, and a run into a folder: what arrives is on disk as it comes, and stays there if the link breaks.

use super::{Conversation, DeviceError, Expected, Order, Progress, Run, broken, follow, report};
use crate::error::Error;
use servoid_results::device_run::{Folder, Live, Recorded};
use servoid_results::schema::DeviceRun;
use shared::wire::{About, Segment};
use std::sync::atomic::AtomicBool;

/// Runs an order to its report; the motor turns. What arrives is in `recorded`, also where the link breaks.
///
/// # Errors
/// An order beyond the device, a start that it refuses, and as [`follow`].
pub fn drive(
    conversation: &mut Conversation,
    about: &About,
    order: &Order,
    plan: &[Segment],
    stop: &AtomicBool,
    recorded: &mut Vec<Recorded>,
    progress: impl FnMut(Progress<'_>) -> Result<(), DeviceError>,
) -> Result<Run, DeviceError> {
    let job = order.job(about, plan)?;
    let expected = Expected::of(&job, plan, about);
    let course = match &order.course {
        Some(course) => course.set_points(about, order.counts_per_rev)?,
        None => Vec::new(),
    };
    conversation.start(job, plan)?;
    let run = follow(
        conversation,
        about,
        &expected,
        &course,
        stop,
        recorded,
        progress,
    )?;
    // It has nothing more to report: let it go back to idle.
    let _ = conversation.about();
    Ok(run)
}

/// A run that is on disk.
pub struct Kept {
    /// What the device reported.
    pub saved: DeviceRun,
    /// All that arrived.
    pub run: Run,
    /// Names of the recordings in the folder.
    pub written: Vec<String>,
}

impl Kept {
    /// Whether the folder has the recording of this name.
    pub fn has_written(&self, name: &str) -> bool {
        self.written.iter().any(|written| written == name)
    }
}

/// As [`drive`], into a folder.
///
/// # Errors
/// As [`drive`], then with the partial run in the folder; a folder that cannot be written.
pub fn keep(
    conversation: &mut Conversation,
    about: &About,
    order: &Order,
    plan: &[Segment],
    folder: &Folder,
    stop: &AtomicBool,
    mut progress: impl FnMut(Progress<'_>),
) -> Result<Kept, Error> {
    let current = about.senses_current;
    let mut live = Live::begin(
        folder.path(),
        about.period_us,
        order.scale(about),
        order.counts_per_rev,
    )?;
    let mut recorded = Vec::new();
    let run = drive(
        conversation,
        about,
        order,
        plan,
        stop,
        &mut recorded,
        |told| {
            progress(told);
            match told {
                Progress::Rows(rows) => Ok(live.take(rows)?),
                _ => Ok(()),
            }
        },
    );
    let run = match run {
        Ok(run) => run,
        Err(error) if recorded.is_empty() => return Err(error.into()),
        Err(error) => {
            folder.write(&broken(about, order, &recorded), &recorded, current)?;
            live.finish()?;
            return Err(Error::Failed(format!(
                "{error}\nwhat had arrived is in {}, and says that it is partial",
                folder.path().display()
            )));
        }
    };
    let saved = report(&run, order);
    let written = folder.write(&saved, &run.recorded, current)?;
    live.finish()?;
    Ok(Kept {
        saved,
        run,
        written,
    })
}
