//! Files that were dropped on the page, or named on the command line and not understood: they wait here, as they came, until it is said what
//! their columns are.

use super::answer::{Answer, aside};
use super::intake::{Asked, looked_at};
use super::opened::{Role, free, meaning, placed};
use super::routes::Shared;
use super::session_file::{FAMILY, SessionFile};
use super::state::Bench;
use crate::error::Error;
use axum::Json;
use axum::body::{Body, BodyDataStream};
use axum::extract::{Query, State};
use futures_util::StreamExt;
use serde::Deserialize;
use serde_json::{Value, json};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use tempfile::TempDir;

/// A file that waits.
#[derive(Clone, Debug)]
pub(super) struct Waiting {
    /// By which the page asks for it.
    pub(super) id: usize,
    /// As its owner calls it.
    pub(super) name: String,
    /// Where it lies.
    pub(super) path: PathBuf,
    /// What it would be taken as.
    pub(super) role: Role,
}

/// The files that wait.
#[derive(Default)]
pub(super) struct Dropped(Mutex<Kept>);

#[derive(Default)]
struct Kept {
    files: Vec<Waiting>,
    next: usize,
    /// Where what was sent is kept; gone with the bench.
    folder: Option<TempDir>,
}

impl Dropped {
    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts a file that lies somewhere among those that wait.
    pub(super) fn name(&self, path: &Path, role: Role) {
        let mut kept = self.kept();
        kept.next += 1;
        let name = path.file_name().unwrap_or(path.as_os_str());
        let waiting = Waiting {
            id: kept.next,
            name: name.to_string_lossy().into_owned(),
            path: path.to_owned(),
            role,
        };
        kept.files.push(waiting);
    }

    /// A place for a file that is sent. Its own name ends the path, since readers speak of it.
    fn place(&self, name: &str) -> Result<(usize, PathBuf), Error> {
        let failed =
            |error: std::io::Error| Error::Failed(format!("{name}: cannot be kept: {error}"));
        let mut kept = self.kept();
        kept.next += 1;
        let id = kept.next;
        let folder = match &kept.folder {
            Some(folder) => folder.path().to_owned(),
            None => {
                let made = tempfile::Builder::new().prefix("servoid-").tempdir();
                let made = made.map_err(failed)?;
                kept.folder.insert(made).path().to_owned()
            }
        };
        let own = folder.join(id.to_string());
        fs::create_dir(&own).map_err(failed)?;
        let last = Path::new(name).file_name().unwrap_or("log".as_ref());
        Ok((id, own.join(last)))
    }

    fn add(&self, waiting: Waiting) {
        self.kept().files.push(waiting);
    }

    fn file(&self, id: usize) -> Result<Waiting, Error> {
        let kept = self.kept();
        let found = kept.files.iter().find(|file| file.id == id).cloned();
        found.ok_or_else(|| Error::Usage("this file waits no longer: drop it again".to_owned()))
    }

    /// Those that were named on the command line.
    pub(super) fn named(&self) -> Vec<Waiting> {
        self.kept().files.clone()
    }

    /// Lets files go, with what was sent of them.
    fn forget(&self, ids: &[usize]) {
        let mut kept = self.kept();
        kept.files.retain(|file| !ids.contains(&file.id));
        if let Some(folder) = &kept.folder {
            for id in ids {
                // Of a file that was named there is nothing here.
                let _ = fs::remove_dir_all(folder.path().join(id.to_string()));
            }
        }
    }
}

#[derive(Deserialize)]
pub(super) struct Named {
    name: String,
}

/// Takes a file as it is, and says what it holds.
pub(super) async fn sent(
    State(bench): Shared,
    Query(Named { name }): Query<Named>,
    body: Body,
) -> Answer {
    free(&bench)?;
    let (id, path) = bench.dropped.place(&name)?;
    let length = kept(&path, body.into_data_stream()).await?;
    if length == 0 {
        return Err(Error::Failed(format!("{name}: this file is empty")).into());
    }
    let waiting = Waiting {
        id,
        name,
        path,
        role: Role::Fitted,
    };
    bench.dropped.add(waiting.clone());
    let told = aside(move || described(&waiting)).await;
    if told.is_err() {
        bench.dropped.forget(&[id]);
    }
    Ok(Json(told?))
}

async fn kept(path: &Path, mut body: BodyDataStream) -> Result<u64, Error> {
    let failed = |error: &dyn std::fmt::Display| {
        Error::Failed(format!("the file was not received: {error}"))
    };
    let mut file = fs::File::create(path).map_err(|error| failed(&error))?;
    let mut length = 0;
    while let Some(part) = body.next().await {
        let part = part.map_err(|error| failed(&error))?;
        length += part.len() as u64;
        file.write_all(&part).map_err(|error| failed(&error))?;
    }
    Ok(length)
}

/// What a file holds: a motor file, a session, or tables with what their columns may be.
fn described(waiting: &Waiting) -> Result<Value, Error> {
    let Waiting { id, name, path, .. } = waiting;
    if name.to_lowercase().ends_with(".toml") {
        let text = fs::read_to_string(path);
        let text = text.map_err(|error| Error::Failed(format!("{name}: {error}")))?;
        return Ok(json!({ "id": id, "name": name, "kind": "motor", "text": text }));
    }
    let begin = beginning(path);
    let first = begin.trim_start_matches(['\u{feff}', ' ', '\n', '\r']);
    if begin.contains(FAMILY) && first.starts_with('{') {
        return Ok(json!({ "id": id, "name": name, "kind": "session" }));
    }
    let looked = looked_at(path, name, &Asked::default());
    if first.starts_with(['{', '[']) && !matches!(&looked, Ok(found) if found.has_columns()) {
        // It may be meant for a session.
        let text = fs::read_to_string(path).unwrap_or_default();
        SessionFile::parse(text.trim_start_matches('\u{feff}'), name)?;
    }
    let mut told = looked?.told;
    told["id"] = json!(id);
    told["name"] = json!(name);
    told["kind"] = json!("log");
    told["role"] = json!(waiting.role);
    Ok(told)
}

fn beginning(path: &Path) -> String {
    use std::io::Read;
    let mut start = [0; 4096];
    let read = fs::File::open(path).and_then(|mut file| file.read(&mut start));
    String::from_utf8_lossy(&start[..read.unwrap_or(0)]).into_owned()
}

/// What was named on the command line and waits to be described.
pub(super) async fn waiting(State(bench): Shared) -> Answer {
    let files = bench.dropped.named();
    let all = aside(move || files.iter().map(described).collect::<Result<Vec<_>, _>>()).await?;
    Ok(Json(json!(all)))
}

#[derive(Deserialize)]
pub(super) struct Proposed {
    id: usize,
    #[serde(flatten)]
    asked: Asked,
}

/// What would be proposed for a file if something else were known.
pub(super) async fn proposed(State(bench): Shared, Json(sent): Json<Proposed>) -> Answer {
    let file = bench.dropped.file(sent.id)?;
    let found = aside(move || looked_at(&file.path, &file.name, &sent.asked)).await?;
    Ok(Json(found.told))
}

#[derive(Deserialize)]
struct OneFile {
    id: usize,
    #[serde(default)]
    role: Role,
}

#[derive(Deserialize)]
pub(super) struct Read {
    files: Vec<OneFile>,
    #[serde(flatten)]
    asked: Asked,
    /// Whether it is only tried.
    #[serde(default)]
    check: bool,
}

/// Reads files as they are said to be, and lays them on the bench.
pub(super) async fn read(State(bench): Shared, Json(sent): Json<Read>) -> Answer {
    let answer = aside(move || read_now(&bench, sent)).await?;
    Ok(Json(answer))
}

fn read_now(bench: &Bench, sent: Read) -> Result<Value, Error> {
    let motor = sent.asked.motor()?;
    let mut loaded = Vec::new();
    let mut notes = Vec::new();
    // Of several of one shape one tells.
    let tried = if sent.check { 1 } else { sent.files.len() };
    for one in sent.files.iter().take(tried) {
        let file = bench.dropped.file(one.id)?;
        let (found, own) = super::intake::read(&file.path, &file.name, &motor, false)?;
        notes.extend(own);
        loaded.push((one.role, found));
    }
    if sent.check {
        let (_, first) = loaded.swap_remove(0);
        let mut told = meaning(&first.data);
        told["notes"] = json!(notes);
        return Ok(told);
    }
    let mut recordings = bench.state().recordings.clone();
    let mut begun = false;
    for (role, found) in loaded {
        // The first fitted file begins a new bench; those that came with it are fitted together with it.
        let role = match (role, begun) {
            (Role::Fitted, true) => Role::Beside,
            (role, _) => role,
        };
        recordings = Some(placed(found, role, recordings)?);
        begun = true;
    }
    if let Some(recordings) = recordings.filter(|_| begun) {
        free(bench)?;
        bench.change(|state| state.begin(recordings));
    }
    let ids: Vec<usize> = sent.files.iter().map(|one| one.id).collect();
    bench.dropped.forget(&ids);
    Ok(json!({ "notes": notes }))
}

/// Opens a session that was dropped, or only tries it.
#[derive(Deserialize)]
pub(super) struct OneSession {
    id: usize,
    #[serde(default)]
    check: bool,
}

pub(super) async fn session(State(bench): Shared, Json(sent): Json<OneSession>) -> Answer {
    let answer = aside(move || {
        let file = bench.dropped.file(sent.id)?;
        let text = fs::read_to_string(&file.path);
        let text = text.map_err(|error| Error::Failed(format!("{}: {error}", file.name)))?;
        let session = SessionFile::parse(text.trim_start_matches('\u{feff}'), &file.name)?;
        if !sent.check {
            free(&bench)?;
            bench.change(|state| session.lay(state))?;
            bench.dropped.forget(&[sent.id]);
        }
        Ok(json!({}))
    })
    .await?;
    Ok(Json(answer))
}
