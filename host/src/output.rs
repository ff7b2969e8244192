//! Output files, written whole or not at all.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::recording::Recording;

/// A file that could not be written; what stood there before still does.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", .path.display())]
pub struct WriteError {
    /// The file asked for.
    pub path: PathBuf,
    /// What went wrong and what to do.
    pub fault: WriteFault,
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
pub enum WriteFault {
    /// The path is a folder.
    #[error("is a folder; name a file inside it")]
    Folder,
    /// The folder is not there.
    #[error("cannot be written: the folder {} does not exist; make it first", .0.display())]
    NoFolder(PathBuf),
    /// The system refused.
    #[error("cannot be written: {0}; nothing was changed: check permissions and free space")]
    Io(io::Error),
}

/// Writes a file through `write`: first to a temporary file in the same folder, then renamed over `path`, so
/// that no reader ever sees half of it and a failure leaves the old file alone. A link is followed to its
/// file; a device or pipe such as `/dev/null` is written directly, since it cannot be replaced.
///
/// # Errors
/// Whatever `write` or the system fails with, with the path.
pub fn write_whole(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    try_write(path, write).map_err(|fault| WriteError {
        path: path.into(),
        fault,
    })
}

fn try_write(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteFault> {
    let target = match fs::metadata(path) {
        Ok(there) if there.is_dir() => return Err(WriteFault::Folder),
        Ok(there) if !there.is_file() => return write_direct(path, write).map_err(WriteFault::Io),
        Ok(_) => fs::canonicalize(path).map_err(WriteFault::Io)?,
        Err(_) => path.to_path_buf(),
    };
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(WriteFault::NoFolder(folder.into()));
    }
    replace(&target, folder, write).map_err(WriteFault::Io)
}

fn replace(
    target: &Path,
    folder: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".servoid-").suffix(".part");
    // Like any new file, not private as temporary files are; the umask still applies.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut temporary = builder.tempfile_in(folder)?;
    let mut buffer = BufWriter::new(temporary.as_file_mut());
    write(&mut buffer)?;
    buffer.flush()?;
    drop(buffer);
    if let Ok(old) = fs::metadata(target) {
        temporary.as_file().set_permissions(old.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(target)?;
    Ok(())
}

fn write_direct(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffer = BufWriter::new(fs::OpenOptions::new().write(true).open(path)?);
    write(&mut buffer)?;
    buffer.flush()
}

/// Writes a recording as the contract's CSV, which [`read_recording`](crate::input::read_recording) reads back to
/// the same numbers. Each line of `provenance` becomes a comment before the header.
///
/// An angle that is not in whole counts goes into the column `angle_rev` (revolutions), which needs
/// `angle = "rev"` under `[units]` of the motor file; it comes back to the last digit but one.
///
/// # Errors
/// As [`write_whole`].
pub fn write_recording(
    path: &Path,
    recording: &Recording,
    provenance: &[String],
) -> Result<(), WriteError> {
    write_whole(path, |out| write_csv(out, recording, provenance))
}

/// As [`write_recording`], to any writer.
///
/// # Errors
/// Whatever the writer fails with.
pub fn write_csv(
    out: &mut dyn Write,
    recording: &Recording,
    provenance: &[String],
) -> io::Result<()> {
    for line in provenance.iter().flat_map(|text| text.split(['\n', '\r'])) {
        writeln!(out, "# {line}")?;
    }
    let angle = if recording.quantised {
        "angle_counts"
    } else {
        "angle_rev"
    };
    write!(out, "t_s,voltage_v,{angle}")?;
    if recording.current_a.is_some() {
        write!(out, ",current_a")?;
    }
    if recording.enabled.is_some() {
        write!(out, ",enabled")?;
    }
    writeln!(out)?;
    for k in 0..recording.len() {
        write_row(out, recording, k)?;
    }
    Ok(())
}

/// Debug formatting prints the shortest digits that read back to the same double, with an exponent where
/// plain digits would be long.
fn write_row(out: &mut dyn Write, recording: &Recording, k: usize) -> io::Result<()> {
    write!(out, "{:?},{:?},", recording.time_s[k], recording.command[k])?;
    if recording.quantised {
        write!(out, "{}", recording.counts[k])?;
    } else {
        write!(out, "{:?}", recording.counts[k] / recording.counts_per_rev)?;
    }
    if let Some(current) = &recording.current_a {
        write!(out, ",{:?}", current[k])?;
    }
    if let Some(enabled) = &recording.enabled {
        write!(out, ",{}", u8::from(enabled[k]))?;
    }
    writeln!(out)
}
