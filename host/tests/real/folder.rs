//! Where the recordings measured by others are.

use std::path::{Path, PathBuf};

/// The folder of the recordings: `SERVOID_DATA`, else beside the workspace. They are not part of the
/// project: where they are missing the tests say so and pass.
pub fn folder() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/data");
    let folder = std::env::var_os("SERVOID_DATA").map_or(beside, PathBuf::from);
    if !folder.is_dir() {
        eprintln!("skipped: no recordings in {}", folder.display());
        return None;
    }
    Some(folder)
}
