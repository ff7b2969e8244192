//! Rows on disk. A row is appended to a journal when its work ends, so that a killed run loses only what was under way; a full
//! journal becomes a part, a Parquet file that is written whole. A row that stands in both, or was made twice, counts once.

use crate::error::{Error, content, io};
use crate::input::{Input, fields};
use crate::key::hex;
use crate::manifest::{Manifest, Part};
use crate::row::Row;
use crate::run::Done;
use crate::shard::Shard;
use crate::task::Task;
use arrow_schema::{FieldRef, Schema};
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::arrow::{ArrowWriter, ProjectionMask};
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use servoid_io::output::write_whole;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rows after which a journal becomes a part.
const PART: usize = 1000;
/// Rows of a part that are in memory at a time.
const AT_A_TIME: usize = 64;
/// Folders and endings within the folder of results.
pub(crate) const PARTS: &str = "parts";
const ENDING: &str = "parquet";
const DAMAGED: &str = "damaged";

/// The results of one shard, to which rows are added.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    journal: File,
    journal_path: PathBuf,
    /// Held as long as the store is.
    _lock: File,
    waiting: Vec<Row>,
    /// The names that are there, and whether each is a result or an error.
    done: HashMap<String, bool>,
    /// The record of this run, once it has begun.
    manifest: Option<Manifest>,
    /// What was found wrong in the folder and put aside.
    pub remarks: Vec<String>,
}

impl Store {
    /// Opens the folder, made if need be, for the work of one shard.
    ///
    /// # Errors
    /// Another run at the same shard; what the system refuses.
    pub fn open(folder: &Path, shard: Shard) -> Result<Self, Error> {
        let parts = folder.join(PARTS);
        fs::create_dir_all(&parts).map_err(io(&parts))?;
        let named = shard.to_string().replace('/', "-of-");
        let lock_path = folder.join(format!("lock-{named}"));
        let lock = File::create(&lock_path).map_err(io(&lock_path))?;
        // Where the system knows no locks, two runs at one folder are the user's care.
        if let Err(TryLockError::WouldBlock) = lock.try_lock() {
            return Err(Error::Busy { path: lock_path });
        }
        let mut remarks = Vec::new();
        let mut done = HashMap::new();
        let journal_path = folder.join(format!("journal-{named}.jsonl"));
        // What waits in the journals of other shards is there, too. These come first: a row may become one of a part meanwhile.
        for path in journals(folder)? {
            if path != journal_path {
                let (rows, _) = read_journal(&path)?;
                done.extend(rows.into_iter().map(|row| (row.key.clone(), row.is_ok())));
            }
        }
        for path in files(&parts)? {
            match statuses(&path) {
                Ok(own) => done.extend(own),
                Err(why) => {
                    let aside = path.with_extension(DAMAGED);
                    match fs::rename(&path, &aside) {
                        // Another run has put it aside meanwhile.
                        Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
                        moved => moved.map_err(io(&path))?,
                    }
                    remarks.push(format!(
                        "{why}; it is put aside as {}, and its recordings are done again",
                        aside.display()
                    ));
                }
            }
        }
        let (waiting, whole) = read_journal(&journal_path)?;
        done.extend(waiting.iter().map(|row| (row.key.clone(), row.is_ok())));
        let journal = OpenOptions::new()
            .append(true)
            .create(true)
            .open(&journal_path);
        let journal = journal.map_err(io(&journal_path))?;
        // A line without its end is a row that was under way.
        journal.set_len(whole).map_err(io(&journal_path))?;
        Ok(Store {
            folder: folder.to_owned(),
            journal,
            journal_path,
            _lock: lock,
            waiting,
            done,
            manifest: None,
            remarks,
        })
    }

    /// Begins the record of a run that adds to this store.
    ///
    /// # Errors
    /// What the system refuses.
    pub(crate) fn begin(&mut self, input: &Input, task: &Task, shard: Shard) -> Result<(), Error> {
        let (path, recordings) = (input.path(), input.count(shard));
        let manifest = Manifest::begin(&self.folder, path, recordings, task, shard)?;
        self.manifest = Some(manifest);
        Ok(())
    }

    /// Ends a run: what waits becomes a part, and the record says what was done.
    ///
    /// # Errors
    /// What the system refuses; the rows are in a part or in the journal.
    pub(crate) fn end(&mut self, done: Done) -> Result<(), Error> {
        self.close_part()?;
        self.manifest
            .take()
            .map_or(Ok(()), |mut manifest| manifest.end(done))
    }

    /// Whether a result of this name is there; one that is an error counts unless errors are done again.
    pub fn has(&self, key: &str, again: bool) -> bool {
        self.done.get(key).is_some_and(|ok| *ok || !again)
    }

    /// Adds a row. When this returns, no kill can lose it.
    ///
    /// # Errors
    /// What the system refuses; then the row is not there.
    pub fn add(&mut self, row: Row) -> Result<(), Error> {
        let line = serde_json::to_string(&row).map_err(content(&self.journal_path))?;
        self.journal
            .write_all(format!("{line}\n").as_bytes())
            .map_err(io(&self.journal_path))?;
        self.done.insert(row.key.clone(), row.is_ok());
        self.waiting.push(row);
        if self.waiting.len() >= PART {
            self.close_part()?;
        }
        Ok(())
    }

    /// Makes a part of what waits in the journal.
    ///
    /// # Errors
    /// What the system refuses; then the rows are still in the journal.
    fn close_part(&mut self) -> Result<(), Error> {
        if self.waiting.is_empty() {
            return Ok(());
        }
        self.waiting.sort_by_key(Row::place);
        let mut digest = Sha256::new();
        for row in &self.waiting {
            digest.update(row.key.as_bytes());
            digest.update(row.status.as_bytes());
        }
        let name = hex(&digest.finalize()[..8]);
        let path = self.folder.join(PARTS).join(format!("{name}.{ENDING}"));
        write_rows(&path, self.waiting.iter().cloned().map(Ok))?;
        if let Some(manifest) = &mut self.manifest {
            manifest
                .run
                .parts
                .push(Part::of(&path, self.waiting.len())?);
            manifest.write()?;
        }
        self.journal.set_len(0).map_err(io(&self.journal_path))?;
        self.waiting.clear();
        Ok(())
    }
}

/// The parts of a folder, in the order of their names.
pub(crate) fn files(parts: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for entry in fs::read_dir(parts).map_err(io(parts))? {
        let path = entry.map_err(io(parts))?.path();
        if path.extension().is_some_and(|end| end == ENDING) {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// The journals of a folder, one a shard.
pub(crate) fn journals(folder: &Path) -> Result<Vec<PathBuf>, Error> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(io(folder))? {
        let path = entry.map_err(io(folder))?.path();
        if path.extension().is_some_and(|end| end == "jsonl") {
            found.push(path);
        }
    }
    found.sort();
    Ok(found)
}

/// Keys of a part, and whether they are results.
fn statuses(path: &Path) -> Result<Vec<(String, bool)>, Error> {
    let rows = read_part(path, false)?;
    let status = |row: Row| {
        let ok = row.is_ok();
        (row.key, ok)
    };
    rows.map(|row| row.map(status)).collect()
}

/// The rows of a part, a few at a time; without the results' JSON, which is most of it, where that is not `whole`.
pub(crate) fn read_part(
    path: &Path,
    whole: bool,
) -> Result<impl Iterator<Item = Result<Row, Error>> + use<>, Error> {
    let file = File::open(path).map_err(io(path))?;
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(content(path))?;
    let wanted = ProjectionMask::columns(
        builder.parquet_schema(),
        builder
            .schema()
            .fields()
            .iter()
            .map(|field| field.name().as_str())
            .filter(|name| whole || *name != "result"),
    );
    let builder = builder.with_projection(wanted).with_batch_size(AT_A_TIME);
    let reader = builder.build().map_err(content(path))?;
    let path = path.to_owned();
    Ok(reader.flat_map(move |batch| {
        let rows = batch.map_err(content(&path)).and_then(|batch| {
            serde_arrow::from_record_batch::<Vec<Row>>(&batch).map_err(content(&path))
        });
        let (rows, error) = match rows {
            Ok(rows) => (rows, None),
            Err(error) => (Vec::new(), Some(Err(error))),
        };
        rows.into_iter().map(Ok).chain(error)
    }))
}

/// Writes rows as one Parquet file, whole or not at all.
pub(crate) fn write_rows(
    path: &Path,
    rows: impl Iterator<Item = Result<Row, Error>>,
) -> Result<(), Error> {
    let fields: Vec<FieldRef> = fields::<Row>().map_err(content(path))?;
    let schema = Arc::new(Schema::new(fields.clone()));
    let small = WriterProperties::builder()
        .set_compression(Compression::ZSTD(ZstdLevel::default()))
        .build();
    let mut bytes = Vec::new();
    let mut writer =
        ArrowWriter::try_new(&mut bytes, schema, Some(small)).map_err(content(path))?;
    let mut some = Vec::new();
    let mut rows = rows.peekable();
    while let Some(row) = rows.next() {
        some.push(row?);
        if some.len() == PART || rows.peek().is_none() {
            let batch = serde_arrow::to_record_batch(&fields, &some).map_err(content(path))?;
            writer.write(&batch).map_err(content(path))?;
            writer.flush().map_err(content(path))?;
            some.clear();
        }
    }
    writer.close().map_err(content(path))?;
    write_whole(path, |out| out.write_all(&bytes))?;
    Ok(())
}

/// The rows of a journal, and how many bytes of it are whole lines.
pub(crate) fn read_journal(path: &Path) -> Result<(Vec<Row>, u64), Error> {
    let file = match File::open(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok((Vec::new(), 0)),
        opened => opened.map_err(io(path))?,
    };
    let mut reader = BufReader::new(file);
    let (mut rows, mut whole) = (Vec::new(), 0);
    let mut line = Vec::new();
    loop {
        line.clear();
        let read = reader.read_until(b'\n', &mut line).map_err(io(path))?;
        if read == 0 || line.last() != Some(&b'\n') {
            return Ok((rows, whole));
        }
        rows.push(serde_json::from_slice(&line).map_err(content(path))?);
        whole += read as u64;
    }
}
