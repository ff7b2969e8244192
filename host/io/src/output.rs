//! Output files, written whole or not at all.

use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::columns::{Columns, ColumnsError, columns};
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
    /// The path is also something else of this run.
    #[error("is also {0} of this run; name another file")]
    Also(&'static str),
    /// The system refused.
    #[error("cannot be written: {0}; nothing was changed: check permissions and free space")]
    Io(io::Error),
}

/// Checks before long work that `path` can be written afterwards; nothing there is changed.
///
/// # Errors
/// As [`write_whole`] would fail: a folder, a missing folder, or one in which no file can be made.
pub fn check_writable(path: &Path) -> Result<(), WriteError> {
    try_check(path).map_err(|fault| WriteError {
        path: path.into(),
        fault,
    })
}

fn try_check(path: &Path) -> Result<(), WriteFault> {
    match destination(path)? {
        // Not opened: that would wait for a pipe's reader.
        Destination::Device => Ok(()),
        Destination::File { folder, .. } => tempfile::Builder::new()
            .prefix(".servoid-")
            .tempfile_in(folder)
            .map(drop)
            .map_err(WriteFault::Io),
    }
}

/// Whether writing to `a` would change `b`, neither of which need exist. A device can be both.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    match (destination(a), destination(b)) {
        (Ok(Destination::File { target: a, .. }), Ok(Destination::File { target: b, .. })) => {
            a == b
        }
        _ => false,
    }
}

/// What stands at a path, or will.
enum Destination {
    /// A file that is replaced whole.
    File {
        /// Its true path, without links.
        target: PathBuf,
        /// Its folder.
        folder: PathBuf,
    },
    /// A device or pipe, which cannot be replaced.
    Device,
}

/// Where a path leads when every link is followed.
fn destination(path: &Path) -> Result<Destination, WriteFault> {
    let asked = match fs::metadata(path) {
        Ok(there) if there.is_dir() => return Err(WriteFault::Folder),
        Ok(there) if !there.is_file() => return Ok(Destination::Device),
        Ok(_) => fs::canonicalize(path).map_err(WriteFault::Io)?,
        Err(_) => path.to_path_buf(),
    };
    let folder = match asked.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    if !folder.is_dir() {
        return Err(WriteFault::NoFolder(folder.into()));
    }
    let Some(name) = asked.file_name() else {
        return Err(WriteFault::Folder);
    };
    let folder = fs::canonicalize(folder).map_err(WriteFault::Io)?;
    Ok(Destination::File {
        target: folder.join(name),
        folder,
    })
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
    written(path, ANYBODYS, write)
}

/// The same for nobody's eyes but the user's: a file that is new is one that no other user of the machine can read.
///
/// # Errors
/// As [`write_whole`].
pub fn write_private(
    path: &Path,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    written(path, PRIVATE, write)
}

/// Permissions of a new file: like any, less the umask; and of one that is private.
const ANYBODYS: u32 = 0o666;
const PRIVATE: u32 = 0o600;

fn written(
    path: &Path,
    mode: u32,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    try_write(path, mode, write).map_err(|fault| WriteError {
        path: path.into(),
        fault,
    })
}

fn try_write(
    path: &Path,
    mode: u32,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteFault> {
    match destination(path)? {
        Destination::Device => write_direct(path, write),
        Destination::File { target, folder } => replace(&target, &folder, mode, write),
    }
    .map_err(WriteFault::Io)
}

fn replace(
    target: &Path,
    folder: &Path,
    mode: u32,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".servoid-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
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
/// `angle = "rev"` under `[units]` of the motor file; it comes back to the last digit but one. A position drive's targets
/// stand in place of its volts, which come back with the drive's motor file.
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
    write_comments(out, provenance)?;
    let angle = if recording.quantised {
        "angle_counts"
    } else {
        "angle_rev"
    };
    let command = match (&recording.position, recording.quantised) {
        (None, _) => "voltage_v",
        (Some(_), true) => "target_counts",
        (Some(_), false) => "target_rev",
    };
    write!(out, "t_s,{command},{angle}")?;
    for (channel, _) in recording.measured.told() {
        write!(out, ",{}", channel.facts().column)?;
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

/// A command sequence, which is what a recording has before it is recorded: columns of equal length.
#[derive(Clone, Debug, PartialEq)]
pub struct CommandSequence {
    /// Time of each command, s.
    pub time_s: Vec<f64>,
    /// Voltage from then until the next, V.
    pub voltage_v: Vec<f64>,
    /// False while the bridge is to be open.
    pub enabled: Option<Vec<bool>>,
}

impl CommandSequence {
    /// Reads what [`write_commands`] wrote, or another file with its columns.
    ///
    /// # Errors
    /// A file that cannot be read, a column that is missing, a cell that is no number, times that do not increase; with
    /// file and line.
    pub fn read(path: &Path) -> Result<Self, ColumnsError> {
        const USUAL: &str =
            "a plan has t_s,voltage_v and may have enabled, see servoid simulate --plan";
        let Columns {
            time_s,
            named: [voltage_v, enabled],
        } = columns(path, ["voltage_v", "enabled"], USUAL)?;
        let voltage_v = voltage_v
            .ok_or_else(|| ColumnsError::of(path, format!("no column `voltage_v`; {USUAL}")))?;
        Ok(CommandSequence {
            time_s,
            voltage_v,
            enabled: enabled.map(|column| column.iter().map(|number| *number != 0.0).collect()),
        })
    }
}

/// Writes a command sequence with the columns of a recording, less what only a recording knows.
///
/// # Errors
/// As [`write_whole`].
pub fn write_commands(
    path: &Path,
    commands: &CommandSequence,
    provenance: &[String],
) -> Result<(), WriteError> {
    write_whole(path, |out| {
        write_comments(out, provenance)?;
        let enabled = commands.enabled.as_deref();
        let header = if enabled.is_some() { ",enabled" } else { "" };
        writeln!(out, "t_s,voltage_v{header}")?;
        for (k, (time, volts)) in commands.time_s.iter().zip(&commands.voltage_v).enumerate() {
            write!(out, "{time:?},{volts:?}")?;
            if let Some(enabled) = enabled {
                write!(out, ",{}", u8::from(enabled[k]))?;
            }
            writeln!(out)?;
        }
        Ok(())
    })
}

fn write_comments(out: &mut dyn Write, provenance: &[String]) -> io::Result<()> {
    for line in provenance.iter().flat_map(|text| text.split(['\n', '\r'])) {
        writeln!(out, "# {line}")?;
    }
    Ok(())
}

/// Debug formatting prints the shortest digits that read back to the same double, with an exponent where
/// plain digits would be long.
fn write_row(out: &mut dyn Write, recording: &Recording, k: usize) -> io::Result<()> {
    let command = match &recording.position {
        None => recording.command[k],
        Some(position) if recording.quantised => position.target_counts[k],
        Some(position) => position.target_counts[k] / recording.counts_per_rev,
    };
    write!(out, "{:?},{command:?},", recording.time_s[k])?;
    if recording.quantised {
        write!(out, "{}", recording.counts[k])?;
    } else {
        write!(out, "{:?}", recording.counts[k] / recording.counts_per_rev)?;
    }
    for (_, values) in recording.measured.told() {
        write!(out, ",{:?}", values[k])?;
    }
    if let Some(enabled) = &recording.enabled {
        write!(out, ",{}", u8::from(enabled[k]))?;
    }
    writeln!(out)
}
