//! A file in memory, where the system has a place for such: readers of logs take a path.

use std::cell::RefCell;
use std::fs::File;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

thread_local! {
    static PLACE: RefCell<(PathBuf, File)> = RefCell::new(place());
}

fn place() -> (PathBuf, File) {
    let memory = PathBuf::from("/dev/shm");
    let folder = if memory.is_dir() { memory } else { std::env::temp_dir() };
    let path = folder.join(format!("servoid-fuzz-{}", std::process::id()));
    let file = File::create(&path).expect("a file");
    (path, file)
}

/// Hands a file that holds `data` to `read`.
pub fn with_file(data: &[u8], read: impl FnOnce(&Path)) {
    PLACE.with_borrow_mut(|(path, file)| {
        file.set_len(0).expect("emptied");
        file.seek(SeekFrom::Start(0)).expect("begun");
        file.write_all(data).expect("written");
        read(path);
    });
}
