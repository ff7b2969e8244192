//! A file with one array.

use super::arrays::{Arrays, Store};
use super::header::Header;
use super::strip;
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::Log;
use crate::origin::Origin;
use crate::window::Window;
use std::io::Read;
use std::path::Path;

/// The file.
struct Whole {
    file: Window,
    data: u64,
}

impl Store for Whole {
    fn data(&self, _: usize, start: u64) -> Result<Box<dyn Read + '_>, FormatError> {
        let start = self.data.saturating_add(start);
        Ok(Box::new(self.file.part(start, self.file.length())))
    }
}

/// Opens the file.
pub(crate) fn open(path: &Path) -> Result<Box<dyn Log>, FormatError> {
    let format = Format::Npy;
    let origin = Origin::new(path, format);
    let file = Window::open(path).map_err(|error| origin.error("", error))?;
    let header = Header::read(&origin, "", &mut file.clone())?;
    let ends = header.bytes.checked_add(header.data);
    if ends.is_none_or(|ends| ends > file.length()) {
        let what = "the values";
        return Err(origin.error("", FormatFault::CutShort { what }));
    }
    let data = header.bytes;
    let arrays = vec![(String::new(), header)];
    let plan = strip::plan(&arrays).map_err(|fault| origin.error("", fault))?;
    Ok(Box::new(Arrays {
        origin,
        format,
        plan,
        arrays,
        store: Whole { file, data },
    }))
}
