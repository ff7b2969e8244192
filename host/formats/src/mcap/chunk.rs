//! Chunks: records that were compressed together.

use super::records::{MOST_BYTES, damaged, too_large};
use crate::bytes::Bytes;
use crate::error::FormatFault;
use lz4_flex::frame::FrameDecoder;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};

/// Bytes of the name of a compression.
const MOST_NAME: u64 = 64;

/// What was taken out of a chunk, and what was wrong with the rest of it.
pub(super) struct Chunk {
    pub(super) records: Vec<u8>,
    pub(super) fault: Option<FormatFault>,
}

impl Chunk {
    /// Takes apart the chunk whose content begins here and has `length` bytes, of which the file has `left`.
    pub(super) fn read(
        file: &mut BufReader<File>,
        length: u64,
        left: u64,
    ) -> Result<Chunk, FormatFault> {
        const FIXED: u64 = 8 + 8 + 8 + 4 + 4;
        let cut = || FormatFault::CutShort { what: "a chunk" };
        let is_cut = length > left;
        let mut content = file.take(length.min(left));
        let mut head = Vec::new();
        (&mut content).take(FIXED).read_to_end(&mut head)?;
        let mut fields = Bytes::new(&head);
        let fields = (|| {
            let (_start, _end) = (fields.u64()?, fields.u64()?);
            Some((fields.u64()?, fields.u32()?, u64::from(fields.u32()?)))
        })();
        let Some((size, crc, name)) = fields else {
            return Err(if is_cut {
                cut()
            } else {
                damaged("a chunk is too short")
            });
        };
        if name > MOST_NAME {
            return Err(damaged("the compression of a chunk is no name"));
        }
        let mut compression = Vec::new();
        (&mut content)
            .take(name.saturating_add(8))
            .read_to_end(&mut compression)?;
        let packed = (compression.len() as u64 == name.saturating_add(8))
            .then(|| compression.split_last_chunk::<8>())
            .flatten();
        let Some((compression, packed)) = packed else {
            return Err(if is_cut {
                cut()
            } else {
                damaged("a chunk is too short")
            });
        };
        if size > MOST_BYTES {
            return Err(too_large("a chunk"));
        }
        let mut records = Vec::new();
        let packed = content.take(u64::from_le_bytes(*packed));
        let read = unpacked(compression, packed)?
            .take(size)
            .read_to_end(&mut records);
        let is_whole = read.is_ok() && records.len() as u64 == size;
        let fault = if is_cut && !is_whole {
            Some(cut())
        } else if let Err(error) = read {
            records.clear();
            Some(damaged(format!("a chunk cannot be decompressed: {error}")))
        } else if !is_whole {
            records.clear();
            Some(damaged("a chunk holds less than it says"))
        } else if crc != 0 && crc32fast::hash(&records) != crc {
            records.clear();
            Some(damaged("the checksum of a chunk does not match"))
        } else {
            None
        };
        Ok(Chunk { records, fault })
    }
}

/// What a chunk's compression makes of its bytes.
fn unpacked<'r>(
    compression: &[u8],
    packed: impl BufRead + 'r,
) -> Result<Box<dyn Read + 'r>, FormatFault> {
    match compression {
        b"" => Ok(Box::new(packed)),
        b"zstd" => Ok(Box::new(zstd::stream::read::Decoder::with_buffer(packed)?)),
        b"lz4" => Ok(Box::new(FrameDecoder::new(packed))),
        other => Err(FormatFault::Unsupported {
            what: format!("the compression {:.20}", String::from_utf8_lossy(other)),
            remedy: "record it with zstd or lz4".to_owned(),
        }),
    }
}
