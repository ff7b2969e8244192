//! The rows of a run while it is under way, on disk as they arrive: what a program that is killed leaves.

use super::folder::{MOTOR, RECORDINGS, motor_file};
use super::lines::{COLUMNS, Lines};
use super::{DutyScale, FolderError};
use servoid_io::input::Known;
use servoid_io::output::write_whole;
use shared::wire::Rows;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// Part of the name of an unfinished recording, before its extension.
const UNFINISHED: &str = "unfinished";
/// What was written reaches the disk, not only the system, this often.
const SYNCED: Duration = Duration::from_secs(1);

/// Files that grow with a run: one a stage, in the format of recordings, and the motor file that they need.
#[derive(Debug)]
pub struct Live {
    folder: PathBuf,
    period_us: u32,
    scale: DutyScale,
    files: BTreeMap<&'static str, (File, Lines)>,
    /// To the thread that syncs: a disk that is slow must not keep the program from speaking to the device.
    synced: Sender<File>,
}

impl Live {
    /// For a run into `folder`.
    ///
    /// # Errors
    /// A motor file that cannot be written.
    pub fn begin(
        folder: &Path,
        period_us: u32,
        scale: DutyScale,
        counts_per_rev: f64,
    ) -> Result<Self, FolderError> {
        let motor = motor_file(scale.supply_v, counts_per_rev, Known::default());
        write_whole(&folder.join(MOTOR), |out| out.write_all(motor.as_bytes()))?;
        Ok(Live {
            folder: folder.to_owned(),
            period_us,
            scale,
            files: BTreeMap::new(),
            synced: syncs(),
        })
    }

    /// Appends rows.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn take(&mut self, rows: &Rows) -> Result<(), FolderError> {
        let Some((name, _)) = RECORDINGS.iter().find(|(_, stage)| *stage == rows.stage) else {
            return Ok(());
        };
        let path = unfinished(&self.folder, name);
        self.append(name, &path, rows)
            .map_err(|error| FolderError::Unusable {
                path,
                why: format!("{error}; the device stops by itself: check the free space"),
            })
    }

    fn append(&mut self, name: &'static str, path: &Path, rows: &Rows) -> io::Result<()> {
        let (file, lines) = match self.files.entry(name) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => {
                let mut file = File::create_new(path)?;
                writeln!(
                    file,
                    "# unfinished: the program that recorded this did not come to its end"
                )?;
                file.write_all(COLUMNS.as_bytes())?;
                let _ = self.synced.send(file.try_clone()?);
                entry.insert((file, Lines::new(self.period_us, self.scale)))
            }
        };
        // In one piece: a program that is killed leaves whole lines.
        file.write_all(lines.of(rows).as_bytes())?;
        Ok(())
    }

    /// The run has its whole files: those that grew with it go.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn finish(self) -> Result<(), FolderError> {
        for name in self.files.keys() {
            let path = unfinished(&self.folder, name);
            fs::remove_file(&path).map_err(|error| FolderError::Unusable {
                path,
                why: format!("{error}; the run beside it is whole: remove this file"),
            })?;
        }
        Ok(())
    }
}

/// A thread that brings the files that it is sent to the disk, again and again, until there is no sender.
fn syncs() -> Sender<File> {
    let (sender, receiver) = channel::<File>();
    thread::spawn(move || {
        let mut files = Vec::new();
        loop {
            match receiver.recv_timeout(SYNCED) {
                Ok(file) => files.push(file),
                Err(RecvTimeoutError::Timeout) => {
                    for file in &files {
                        // The program itself finds out what cannot be written.
                        let _ = file.sync_data();
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return,
            }
        }
    });
    sender
}

/// Path of a recording while it is unfinished.
fn unfinished(folder: &Path, name: &str) -> PathBuf {
    folder
        .join(name)
        .with_extension(format!("{UNFINISHED}.csv"))
}

/// An unfinished recording that a folder holds.
pub(super) fn left_in(folder: &Path) -> Option<PathBuf> {
    RECORDINGS
        .iter()
        .map(|(name, _)| unfinished(folder, name))
        .find(|path| path.exists())
}
