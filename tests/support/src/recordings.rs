//! Recordings measured by others, in the units and columns of their makers.

use crate::left_out::skipped;
use flate2::read::GzDecoder;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn here(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The motor file that tells how recordings of one source are read.
#[must_use]
pub fn map(name: &str) -> PathBuf {
    here("../maps").join(name)
}

/// The recordings in `tests/recordings`, unpacked as they are asked for; gone with their owner.
pub struct Vendored {
    folder: TempDir,
}

impl Vendored {
    /// None yet, and a folder for them.
    #[must_use]
    pub fn new() -> Self {
        Vendored {
            folder: tempfile::tempdir().expect("a temporary folder"),
        }
    }

    /// Unpacks `file`, such as `un_dcmotor/prbs_open.csv`.
    #[must_use]
    pub fn unpack(&self, file: &str) -> PathBuf {
        let path = self.folder.path().join(file);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a new folder");
        let packed = here("../recordings").join(format!("{file}.gz"));
        let packed = File::open(&packed).unwrap_or_else(|error| panic!("{packed:?}: {error}"));
        let mut plain = File::create(&path).expect("a new file");
        io::copy(&mut GzDecoder::new(packed), &mut plain)
            .unwrap_or_else(|error| panic!("{file}: {error}"));
        path
    }

    /// The names of all of them.
    #[must_use]
    pub fn names() -> Vec<String> {
        let entries = |folder: &Path| -> Vec<PathBuf> {
            let entries = fs::read_dir(folder).expect("a folder");
            entries
                .map(|entry| entry.expect("an entry").path())
                .collect()
        };
        let mut names: Vec<String> = entries(&here("../recordings"))
            .iter()
            .filter(|path| path.is_dir())
            .flat_map(|folder| entries(folder))
            .filter(|path| path.extension().is_some_and(|extension| extension == "gz"))
            .map(|path| {
                let inside = path.strip_prefix(here("../recordings")).expect("inside");
                inside
                    .with_extension("")
                    .to_str()
                    .expect("text")
                    .replace('\\', "/")
            })
            .collect();
        names.sort();
        names
    }
}

impl Default for Vendored {
    fn default() -> Self {
        Vendored::new()
    }
}

/// A recording that states no licence and therefore cannot be part of the project: below `SERVOID_DATA`, else in `shared/data`
/// beside the workspace. Where there is no such folder the test says so and passes.
#[must_use]
pub fn elsewhere(file: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("SERVOID_DATA")
        .map_or_else(|| here("../../../shared/data"), PathBuf::from);
    if !folder.is_dir() {
        skipped(&format!(
            "no {file}: it states no licence and is not kept here"
        ));
        return None;
    }
    Some(folder.join(file))
}
