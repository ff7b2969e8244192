//! Text files that were compressed, read as if they were not.

use flate2::bufread::MultiGzDecoder;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read};
use std::path::Path;

const GZIP: &[u8] = &[0x1f, 0x8b];
const ZSTD: &[u8] = &[0x28, 0xb5, 0x2f, 0xfd];

/// The content of a file, decompressed where its first bytes are those of gzip or zstd.
///
/// Nothing is held but a window of the content, and the file may be a pipe.
///
/// # Errors
/// The file cannot be read. What is damaged in it is an error of the reader, at its place.
pub fn decompressed(path: &Path) -> io::Result<Box<dyn BufRead + Send>> {
    decompressed_from(File::open(path)?)
}

/// As [`decompressed`], of the bytes of a file.
///
/// # Errors
/// They cannot be read.
pub fn decompressed_from(
    mut file: impl Read + Send + 'static,
) -> io::Result<Box<dyn BufRead + Send>> {
    let mut head = Vec::new();
    file.by_ref()
        .take(ZSTD.len() as u64)
        .read_to_end(&mut head)?;
    let is_gzip = head.starts_with(GZIP);
    let is_zstd = head.starts_with(ZSTD);
    let whole = BufReader::new(Cursor::new(head).chain(file));
    Ok(if is_gzip {
        Box::new(BufReader::new(MultiGzDecoder::new(whole)))
    } else if is_zstd {
        let content = zstd::stream::read::Decoder::with_buffer(whole)?;
        Box::new(BufReader::new(content))
    } else {
        Box::new(whole)
    })
}
