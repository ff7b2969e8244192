//! A zip archive of arrays.

use super::arrays::{Arrays, Store};
use super::header::Header;
use super::single;
use super::strip;
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::Log;
use crate::origin::Origin;
use crate::plan::Plan;
use crate::window::Window;
use flate2::Crc;
use flate2::read::DeflateDecoder;
use std::io::{self, Read};
use std::path::Path;
use zip::result::ZipError;
use zip::{CompressionMethod, ZipArchive};

/// How the name of an array in an archive ends.
const ENDING: &str = ".npy";
const LOCAL_FILE: &[u8] = b"PK\x03\x04";
/// Where a local header of a zip archive has its name.
const NAME: usize = 30;

/// Whether a file with this beginning is an archive whose first member is an array.
pub(crate) fn is_archive(head: &[u8]) -> bool {
    let Some(&[low, high]) = head.get(NAME - 4..NAME - 2) else {
        return false;
    };
    let length = usize::from(u16::from_le_bytes([low, high]));
    let name = head.get(NAME..NAME + length).unwrap_or(&[]);
    head.starts_with(LOCAL_FILE) && name.ends_with(ENDING.as_bytes())
}

/// A member of an archive.
#[derive(Clone, Copy, Debug)]
struct Member {
    start: u64,
    packed: u64,
    is_packed: bool,
    checksum: u32,
}

/// The archive.
struct Archive {
    origin: Origin,
    file: Window,
    /// The members, in the order of the arrays.
    members: Vec<Member>,
    /// Where the data of each begins in it.
    data: Vec<u64>,
}

impl Member {
    fn reader(self, file: &Window) -> Checked<Box<dyn Read>> {
        let packed = file.part(self.start, self.start.saturating_add(self.packed));
        let reader: Box<dyn Read> = if self.is_packed {
            Box::new(DeflateDecoder::new(packed))
        } else {
            Box::new(packed)
        };
        Checked {
            reader,
            seen: Crc::new(),
            expected: self.checksum,
        }
    }
}

/// A reader that verifies the checksum of what it read to the end.
struct Checked<R> {
    reader: R,
    seen: Crc,
    expected: u32,
}

impl<R: Read> Read for Checked<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let read = self.reader.read(buffer)?;
        self.seen.update(buffer.get(..read).unwrap_or(&[]));
        if read == 0 && !buffer.is_empty() && self.seen.sum() != self.expected {
            let why = "the checksum of the archive differs";
            return Err(io::Error::new(io::ErrorKind::InvalidData, why));
        }
        Ok(read)
    }
}

impl Store for Archive {
    fn data(&self, array: usize, start: u64) -> Result<Box<dyn Read + '_>, FormatError> {
        let absent = || self.origin.error("", FormatFault::Absent);
        let member = self.members.get(array).ok_or_else(absent)?;
        let before = self.data.get(array).ok_or_else(absent)?;
        let mut reader = member.reader(&self.file);
        let skip = before.saturating_add(start);
        let failed = |error| self.origin.failed_read("", "an array", error);
        let skipped = io::copy(&mut reader.by_ref().take(skip), &mut io::sink());
        if skipped.map_err(failed)? < skip {
            return Err(failed(io::ErrorKind::UnexpectedEof.into()));
        }
        Ok(Box::new(reader))
    }
}

/// Opens the archive.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Log>, FormatError> {
    let format = Format::Npz;
    let origin = Origin::new(path, format);
    let file = Window::open(path).map_err(|error| origin.error("", error))?;
    let mut archive = ZipArchive::new(file.clone()).map_err(|error| fault(&origin, "", error))?;
    let mut found = Archive {
        origin: origin.clone(),
        file,
        members: Vec::new(),
        data: Vec::new(),
    };
    let (mut arrays, mut unread, mut facts) = (Vec::new(), Vec::new(), Vec::new());
    for at in 0..archive.len() {
        let place = format!("member {at}");
        let entry = archive
            .by_index_raw(at)
            .map_err(|error| fault(&origin, &place, error))?;
        let Some(name) = entry.name().strip_suffix(ENDING).map(str::to_owned) else {
            continue;
        };
        let is_packed = match entry.compression() {
            CompressionMethod::Stored => Some(false),
            CompressionMethod::DEFLATE => Some(true),
            _ => None,
        };
        let Some(is_packed) = is_packed.filter(|_| !entry.encrypted()) else {
            let what = "an encrypted or unusually compressed member";
            let remedy = "save it again with `numpy.savez` or `numpy.savez_compressed`";
            return Err(origin.unsupported(name, what, remedy));
        };
        let member = Member {
            start: entry.data_start(),
            packed: entry.compressed_size(),
            is_packed,
            checksum: entry.crc32(),
        };
        let mut reader = member.reader(&found.file);
        match Header::read(&origin, &name, &mut reader) {
            Ok(header) if header.axes.is_empty() => {
                let value = single::value(&header, &mut reader);
                let what = "a single value";
                let value = value.map_err(|error| origin.failed_read(&name, what, error))?;
                facts.extend(value.map(|value| (name, value)));
            }
            Ok(header) => {
                found.members.push(member);
                found.data.push(header.bytes);
                arrays.push((name, header));
            }
            Err(error) => match error.fault {
                FormatFault::Unsupported { what, remedy } => unread.push((name, what, remedy)),
                _ => return Err(error),
            },
        }
    }
    let mut plan: Plan = strip::plan(&arrays).map_err(|fault| origin.error("", fault))?;
    for (name, value) in facts {
        plan.fact(name, value);
    }
    for (name, what, remedy) in unread {
        plan.unread(name, what, remedy);
    }
    Ok(Box::new(Arrays {
        origin,
        format,
        plan,
        arrays,
        store: found,
    }))
}

fn fault(origin: &Origin, place: &str, error: ZipError) -> FormatError {
    match error {
        ZipError::Io(error) => origin.failed_read(place, "the list of arrays", error),
        error => origin.damaged(place, error.to_string()),
    }
}
