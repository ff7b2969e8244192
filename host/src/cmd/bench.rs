//! `servoid bench`: the workbench, a page on this machine.

use super::motor;
use crate::cli::BenchArgs;
use crate::error::Error;
use crate::session::Session;
use crate::workbench::{Loaded, Opening, SCHEMA, Server, SessionFile, Source};
use serde::Serialize;
use std::fs;
use std::path::Path;

#[derive(Serialize)]
struct BenchJson {
    schema: &'static str,
    url: String,
}

pub(super) fn run(session: &Session, args: &BenchArgs) -> Result<(), Error> {
    let outputs: Vec<_> = (args.session.as_deref().into_iter())
        .map(|path| ("--session", path))
        .collect();
    let inputs: Vec<_> = (args.recording.as_deref().into_iter())
        .map(|path| ("the recording", path))
        .chain(
            args.validate
                .as_deref()
                .map(|path| ("the --validate recording", path)),
        )
        .filter(|(_, path)| !is_session(path))
        .collect();
    session.check_outputs(&outputs, &inputs)?;
    let opening = opening(args)?;
    let server = Server::open(opening, args.port, args.session.clone())?;
    let url = server.url();
    let text = format!("workbench: {url}\nCtrl-C ends it\n");
    let json = BenchJson {
        schema: "servoid.bench/1",
        url: url.clone(),
    };
    session.deliver(&text, &json)?;
    if !args.no_open
        && let Err(error) = open::that_detached(&url)
    {
        session.remark(&format!(
            "no browser could be opened ({error}): open the address above yourself"
        ));
    }
    server.serve(session.stop())
}

fn opening(args: &BenchArgs) -> Result<Opening, Error> {
    let Some(path) = &args.recording else {
        // A session that is kept goes on where it was.
        return match &args.session {
            Some(path) if path.exists() => saved(path),
            _ => Ok(Opening::Empty),
        };
    };
    if is_session(path) {
        if args.validate.is_some() {
            return Err(Error::Usage(format!(
                "--validate: {} is a session, which has its recordings; leave --validate away",
                path.display()
            )));
        }
        return saved(path);
    }
    let held_out = args.validate.as_ref().map(|path| loaded(args, path));
    Ok(Opening::Recording(
        Box::new(loaded(args, path)?),
        held_out.transpose()?.map(Box::new),
    ))
}

fn saved(path: &Path) -> Result<Opening, Error> {
    let text = text(path)?;
    let file = SessionFile::parse(&text, &path.display().to_string())?;
    Ok(Opening::Session(Box::new(file)))
}

/// A file whose first words are a session's.
fn is_session(path: &Path) -> bool {
    use std::io::Read;
    let mut start = [0; 4096];
    let read = fs::File::open(path).and_then(|mut file| file.read(&mut start));
    read.is_ok_and(|count| String::from_utf8_lossy(&start[..count]).contains(SCHEMA))
}

fn text(path: &Path) -> Result<String, Error> {
    fs::read_to_string(path)
        .map_err(|error| Error::Failed(format!("{}: cannot be read: {error}", path.display())))
}

fn loaded(args: &BenchArgs, path: &Path) -> Result<Loaded, Error> {
    // Read once as every verb does, for its messages.
    let (_, motor) = motor::recording(&args.motor, path)?;
    Loaded::read(Source {
        name: path.display().to_string(),
        csv: text(path)?,
        motor: motor.to_toml(),
    })
}
