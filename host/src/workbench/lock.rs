//! One program on a session at a time: two would overwrite each other's work.

use crate::error::Error;
use std::fs::{File, OpenOptions, TryLockError};
use std::path::{Path, PathBuf};

/// A session that is this program's until it is dropped. The system takes the lock away from a program that dies.
pub(super) struct Lock {
    file: Option<File>,
    path: PathBuf,
}

impl Lock {
    /// Takes the session at `path`.
    ///
    /// # Errors
    /// [`Error::Usage`] where another program has it.
    pub(super) fn take(path: &Path) -> Result<Self, Error> {
        let beside = beside(path);
        let failed = |error: std::io::Error| {
            Error::Failed(format!("{}: cannot be locked: {error}", beside.display()))
        };
        // Not the session's own file, which is replaced by every change.
        let mut options = OpenOptions::new();
        let file = options
            .create(true)
            .truncate(false)
            .write(true)
            .open(&beside);
        let file = file.map_err(failed)?;
        match file.try_lock() {
            Ok(()) => Ok(Lock {
                file: Some(file),
                path: beside,
            }),
            Err(TryLockError::WouldBlock) => Err(Error::Usage(format!(
                "--session {}: another servoid has it open; close that one first, or name another file",
                path.display()
            ))),
            // A file system without locks protects nothing, and is no reason to refuse work.
            Err(TryLockError::Error(_)) => Ok(Lock {
                file: None,
                path: beside,
            }),
        }
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // While the lock is held, so that nobody else's is taken away.
        let _ = std::fs::remove_file(&self.path);
        drop(self.file.take());
    }
}

fn beside(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(".lock");
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_session_is_one_programs_until_that_one_ends() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kept.json");
        let first = Lock::take(&path).unwrap();
        let refused = Lock::take(&path).err().unwrap().to_string();
        assert!(refused.contains("another servoid has it open"), "{refused}");
        drop(first);
        let again = Lock::take(&path).unwrap();
        drop(again);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
