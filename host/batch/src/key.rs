//! The name of a result: whoever asks for the same thing gets the same name, on every machine.

use crate::input::{Content, Unit};
use sha2::{Digest, Sha256};
use std::path::Path;

/// Changes when the same task would give other results though the version is the same.
const EDITION: &str = "servoid.batch/1";

/// Digest of name, content, task (with its seed) and version. What is said of a file's motor is part of the content; a result
/// holds the recording's name. None where the content cannot be read.
pub(crate) fn key(unit: &Unit, task: &str, version: &str) -> Option<String> {
    let mut digest = Sha256::new();
    let mut add = |bytes: &[u8]| {
        digest.update((bytes.len() as u64).to_le_bytes());
        digest.update(bytes);
    };
    for text in [EDITION, version, task, &unit.name] {
        add(text.as_bytes());
    }
    match &unit.content {
        Content::File(log) => {
            add(log.bytes().ok()?);
            add(&beside(&log.path).ok()?);
        }
        Content::Columns(columns) => {
            for column in columns.numbers() {
                let bytes: Vec<u8> = column.iter().flat_map(|x| x.to_le_bytes()).collect();
                add(&bytes);
            }
            add(columns.motor_text().as_bytes());
            // A label that was put right makes a row of its own; a file without labels keeps its names.
            if let Some(labels) = columns.labels() {
                for (name, said) in labels.named() {
                    add(name.as_bytes());
                    add(said.unwrap_or_default().as_bytes());
                }
            }
        }
    }
    Some(hex(&digest.finalize()[..16]))
}

/// Bytes as text.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn beside(path: &Path) -> std::io::Result<Vec<u8>> {
    match std::fs::read(path.with_file_name("motor.toml")) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
        found => found,
    }
}
