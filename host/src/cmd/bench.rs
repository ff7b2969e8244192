//! `servoid bench`: the workbench, a page on this machine.

use super::motor;
use crate::cli::BenchArgs;
use crate::error::Error;
use crate::session::Session;
use crate::workbench::{FAMILY, Loaded, Opening, Server, SessionFile, read};
use serde::Serialize;
use servoid_io::output::is_same_file;
use std::fs;
use std::io::{Read as _, Write};
use std::path::{Path, PathBuf};

#[derive(Serialize)]
struct BenchJson {
    schema: &'static str,
    url: String,
}

pub(super) fn run(session: &Session, args: &BenchArgs) -> Result<(), Error> {
    check_files(session, args)?;
    let opening = opening(session, args)?;
    serve(
        session,
        Server::open(opening, args.port, args.session.clone(), None)?,
        args.no_open,
    )
}

/// Says where the page is, opens it, and serves it until the user has enough.
pub(super) fn serve(session: &Session, server: Server, no_open: bool) -> Result<(), Error> {
    let url = server.url();
    let text = format!("workbench: {url}\nCtrl-C ends it\n");
    let json = BenchJson {
        schema: "servoid.bench/1",
        url: url.clone(),
    };
    session.deliver(&text, &json)?;
    let opened = (!no_open).then(|| browser(&url)).transpose();
    if let Err(error) = &opened {
        session.remark(&format!(
            "no browser could be opened ({error}): open the address above yourself"
        ));
    }
    server.serve(session.stop())
}

/// Opens a page in the user's browser, by a file that only the user can read and that lasts as long as what is returned: every user
/// of the machine sees the words of a command, and whoever has the address may use the bench.
fn browser(url: &str) -> std::io::Result<tempfile::NamedTempFile> {
    let mut file = tempfile::Builder::new()
        .prefix("servoid-")
        .suffix(".html")
        .tempfile()?;
    write!(
        file,
        "<!doctype html><title>servoid workbench</title><meta http-equiv=\"refresh\" content=\"0; url={url}\">\
         <a href=\"{url}\">servoid workbench</a>"
    )?;
    open::that_detached(file.path())?;
    Ok(file)
}

/// Checks before anything is read that the bench replaces no file but the session that it goes on with.
fn check_files(session: &Session, args: &BenchArgs) -> Result<(), Error> {
    if let ([], [other, ..]) = (args.fitted(), args.held_out()) {
        return Err(Error::Usage(format!(
            "--validate {}: there is no recording beside it that could be fitted; name that one first: servoid bench REC \
             --validate {0}",
            other.display()
        )));
    }
    let outputs: Vec<_> = (args.session.as_deref().into_iter())
        .map(|path| ("--session", path))
        .collect();
    let fitted = args.fitted().iter().map(|path| ("the recording", &**path));
    let held_out = args.held_out().iter();
    let held_out = held_out.map(|path| ("the --validate recording", &**path));
    let inputs: Vec<_> = fitted
        .chain(held_out)
        .filter(|(_, path)| !is_session(path))
        .collect();
    session.check_outputs(&outputs, &inputs)?;
    let ([recording, ..], Some(session_file)) = (args.fitted(), &args.session) else {
        return Ok(());
    };
    // What is opened may be kept where it lies; anything else that is there already is somebody's work.
    if session_file.is_file() && !is_same_file(session_file, recording) {
        return Err(Error::Usage(format!(
            "--session {}: is there already, and would be replaced by a bench with {} on it; to go on with it leave the \
             recording away, or name another file",
            session_file.display(),
            recording.display()
        )));
    }
    Ok(())
}

fn opening(session: &Session, args: &BenchArgs) -> Result<Opening, Error> {
    let all = || args.fitted().iter().chain(args.held_out());
    let Some(first) = args.fitted().first() else {
        // A session that is kept goes on where it was.
        return resumed(args.session.as_deref());
    };
    if let Some(file) = all().find(|path| is_session(path)) {
        if all().count() > 1 {
            return Err(Error::Usage(format!(
                "{}: is a session, which has its recordings; leave --validate away, and name it alone",
                file.display()
            )));
        }
        return saved(first);
    }
    let unknown = || Opening::Unknown(args.fitted().to_vec(), args.held_out().to_vec());
    let Some(fitted) = loaded(session, args, args.fitted())? else {
        return Ok(unknown());
    };
    let mut held_out: Option<Loaded> = None;
    for path in args.held_out() {
        let Some(other) = loaded(session, args, std::slice::from_ref(path))? else {
            return Ok(unknown());
        };
        if other.has_copy_of(&fitted) {
            session.remark(&format!(
                "--validate {}: is fitted, too, which is no test: it is not held out",
                path.display()
            ));
            continue;
        }
        held_out = Some(match held_out {
            Some(others) => others.with(&other)?,
            None => other,
        });
    }
    Ok(Opening::Recording(Box::new(fitted), held_out.map(Box::new)))
}

/// What was kept in a session, if there is any.
pub(super) fn resumed(session: Option<&Path>) -> Result<Opening, Error> {
    match session {
        Some(path) if path.exists() => saved(path),
        _ => Ok(Opening::Empty),
    }
}

fn saved(path: &Path) -> Result<Opening, Error> {
    let text = text(path)?;
    let file = SessionFile::parse(&text, &path.display().to_string())?;
    Ok(Opening::Session(Box::new(file)))
}

/// A file whose first words are a session's, of whatever version.
fn is_session(path: &Path) -> bool {
    let mut start = [0; 4096];
    let read = fs::File::open(path).and_then(|mut file| file.read(&mut start));
    read.is_ok_and(|count| String::from_utf8_lossy(&start[..count]).contains(FAMILY))
}

fn text(path: &Path) -> Result<String, Error> {
    fs::read_to_string(path)
        .map_err(|error| Error::Failed(format!("{}: cannot be read: {error}", path.display())))
}

/// Reads what is named; none where it must be said first what the columns of one of them are, which the page asks.
fn loaded(session: &Session, args: &BenchArgs, paths: &[PathBuf]) -> Result<Option<Loaded>, Error> {
    let mut all: Option<Loaded> = None;
    for path in paths {
        let motor = motor::motor_file(&args.motor, path)?;
        let name = path.display().to_string();
        let (loaded, notes) = match read(path, &name, &motor, true) {
            Ok(found) => found,
            Err(error) if error.asks_what_a_log_is() => {
                session.remark(&format!("{error}\nThe page asks for it."));
                return Ok(None);
            }
            Err(error) => return Err(error),
        };
        for note in &notes {
            session.remark(note);
        }
        all = Some(match all {
            Some(others) => others.with(&loaded)?,
            None => loaded,
        });
    }
    Ok(all)
}
