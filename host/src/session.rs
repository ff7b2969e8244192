//! What every verb shares: where results go, whether to show progress, and the user's wish to stop.

use crate::cli::Common;
use crate::error::Error;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;
use servoid_io::output::{WriteError, WriteFault, check_writable, is_same_file, write_whole};
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// How often a spinner turns.
const TICK: Duration = Duration::from_millis(100);

/// One run of the program.
pub struct Session {
    json: Option<PathBuf>,
    /// Seed of everything random.
    pub seed: u64,
    quiet: bool,
    stop: Arc<AtomicBool>,
}

impl Session {
    /// Reads the common options and takes over the signals that ask the program to stop.
    pub fn new(common: &Common) -> Result<Self, Error> {
        let stop = Arc::new(AtomicBool::new(false));
        crate::interrupt::sets(&stop);
        Ok(Session {
            json: common.json.clone(),
            seed: common.seed,
            quiet: common.quiet,
            stop,
        })
    }

    /// Seeds of `count` runs, from this session's on; after the largest comes zero.
    pub fn seeds(&self, count: u64) -> Vec<u64> {
        (0..count).map(|k| self.seed.wrapping_add(k)).collect()
    }

    /// Where the JSON goes, if it goes to a file.
    pub fn json_file(&self) -> Option<&Path> {
        self.json.as_deref().filter(|path| path.as_os_str() != "-")
    }

    /// The flag that Ctrl-C sets.
    pub fn stop(&self) -> &AtomicBool {
        &self.stop
    }

    /// Checks before the work that its results can go where they are asked to go: the `outputs`, each with
    /// its flag, and the JSON. None may be one of the `inputs`, each with what it is, nor another output.
    ///
    /// # Errors
    /// Wrong use, with the flag, the path and the reason.
    pub fn check_outputs(
        &self,
        outputs: &[(&'static str, &Path)],
        inputs: &[(&'static str, &Path)],
    ) -> Result<(), Error> {
        let json = self.json_file();
        let outputs: Vec<_> = outputs
            .iter()
            .copied()
            .chain(json.map(|path| ("--json", path)))
            .collect();
        for (index, (flag, path)) in outputs.iter().enumerate() {
            let wrong = |error: WriteError| Error::Usage(format!("{flag} {error}"));
            check_writable(path).map_err(wrong)?;
            let mut others = inputs.iter().chain(&outputs[..index]);
            if let Some((what, _)) = others.find(|(_, other)| is_same_file(path, other)) {
                return Err(wrong(WriteError {
                    path: path.to_path_buf(),
                    fault: WriteFault::Also(what),
                }));
            }
        }
        Ok(())
    }

    /// A progress bar over `length` steps of `what`; invisible unless stderr is a terminal.
    pub fn progress(&self, length: u64, what: &'static str) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::with_draw_target(Some(length), ProgressDrawTarget::hidden());
        }
        let style =
            ProgressStyle::with_template("{prefix} {bar:30} {pos}/{len}  {msg}  {eta} left")
                .unwrap_or_else(|_| ProgressStyle::default_bar());
        ProgressBar::new(length).with_style(style).with_prefix(what)
    }

    /// A count of `things` while `what` is done, where nobody knows how many there will be; invisible unless stderr is a
    /// terminal.
    pub fn count(&self, what: &'static str, things: &str) -> ProgressBar {
        if self.quiet || !std::io::stderr().is_terminal() {
            return ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        }
        let template = format!("{{prefix}} {{spinner}} {{pos}} {things}, {{elapsed}}");
        let style = ProgressStyle::with_template(&template)
            .unwrap_or_else(|_| ProgressStyle::default_spinner());
        let bar = ProgressBar::no_length().with_style(style).with_prefix(what);
        bar.enable_steady_tick(TICK);
        bar
    }

    /// A remark on stderr, unless quiet.
    pub fn remark(&self, text: &str) {
        if !self.quiet {
            eprintln!("{text}");
        }
    }

    /// Writes a drawing, and remarks where it is.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_plot(&self, path: &Path, drawing: &str) -> Result<(), Error> {
        write_whole(path, |out| out.write_all(drawing.as_bytes()))?;
        self.remark(&format!("plot: {}", path.display()));
        Ok(())
    }

    /// Delivers a result: the text to stdout and the JSON to its file, or with `--json -` the JSON
    /// alone to stdout. Fails after delivery if the user stopped the work.
    pub fn deliver(&self, text: &str, json: &impl Serialize) -> Result<(), Error> {
        let to_stdout = self
            .json
            .as_ref()
            .is_some_and(|path| path.as_os_str() == "-");
        if !to_stdout {
            show(text)?;
        }
        if let Some(path) = &self.json {
            let mut rendered = serde_json::to_string_pretty(json).map_err(|error| {
                Error::Failed(format!("the result cannot be written as JSON: {error}"))
            })?;
            rendered.push('\n');
            if to_stdout {
                print(rendered.as_bytes())?;
            } else {
                write_whole(path, |out| out.write_all(rendered.as_bytes()))?;
            }
        }
        if self.stop.load(Ordering::Relaxed) {
            return Err(Error::Failed(
                "stopped by the user: the result is the best so far".to_owned(),
            ));
        }
        Ok(())
    }
}

/// A text to stdout, with its colours only where a terminal shows them.
fn show(text: &str) -> Result<(), Error> {
    written(anstream::stdout().lock().write_all(text.as_bytes()))
}

/// To stdout; a closed pipe (`| head`) is the reader's choice, not an error.
pub(crate) fn print(text: &[u8]) -> Result<(), Error> {
    written(std::io::stdout().lock().write_all(text))
}

fn written(result: std::io::Result<()>) -> Result<(), Error> {
    match result {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::Failed(format!("stdout: {error}")))
        }
        _ => Ok(()),
    }
}
