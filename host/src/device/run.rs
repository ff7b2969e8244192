//! One run: assembles the device's messages.

use super::{Conversation, DeviceError};
use servoid_results::device_run::Recorded;
use shared::wire::{About, Failure, Report, Rows, Stage, ToDevice, ToHost};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Interval of the host's keep-alive.
const ALIVE: Duration = Duration::from_millis(20);
/// Time-out of the device.
const GONE: Duration = Duration::from_secs(5);
/// Time-out of the report after a stop.
const FAREWELL: Duration = Duration::from_secs(2);

/// Result of a run.
#[derive(Clone, Debug)]
pub struct Run {
    /// Identification of the device.
    pub about: About,
    /// The recordings, one per stage.
    pub recorded: Vec<Recorded>,
    /// Its outcome.
    pub outcome: Result<Report, Failure>,
    /// Number of damaged frames.
    pub damaged: u32,
}

/// Progress of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress<'a> {
    /// A stage began, of so many periods if that is known.
    Stage(Stage, Option<u32>),
    /// Periods that arrived.
    Rows(&'a Rows),
    /// Models run, of about so many.
    Models(u32, u32),
}

/// Longest stage that can be real, rows: a damaged number must not ask for all memory.
const MOST_ROWS: usize = 50_000_000;

/// Follows a run from its start to its report, asking again for rows of the recording that were lost.
///
/// # Errors
/// A link that breaks, a device that falls silent or restarts. What arrived is in `recorded` then.
pub fn follow(
    conversation: &mut Conversation,
    about: &About,
    stop: &AtomicBool,
    recorded: &mut Vec<Recorded>,
    mut progress: impl FnMut(Progress<'_>),
) -> Result<Run, DeviceError> {
    let mut said = Instant::now();
    let mut heard = Instant::now();
    let mut stopped: Option<Instant> = None;
    let outcome = loop {
        if stop.load(Ordering::Relaxed) && stopped.is_none_or(|at| at.elapsed() > FAREWELL / 4) {
            if stopped.is_some_and(|at| at.elapsed() > FAREWELL) {
                return Err(DeviceError::Link(std::io::ErrorKind::TimedOut.into()));
            }
            conversation.say(&ToDevice::Stop)?;
            stopped.get_or_insert_with(Instant::now);
        }
        if said.elapsed() >= ALIVE {
            conversation.say(&ToDevice::Alive)?;
            said = Instant::now();
        }
        let Some(message) = conversation.hear()? else {
            if heard.elapsed() > GONE {
                return Err(DeviceError::Silent {
                    port: "the device".to_owned(),
                    seconds: GONE.as_secs_f64(),
                    noise: String::new(),
                });
            }
            continue;
        };
        heard = Instant::now();
        match message {
            ToHost::About(now) if now.boot != about.boot => return Err(DeviceError::Restarted),
            ToHost::Refused(refusal) => return Err(DeviceError::Refused(refusal)),
            ToHost::Stage { stage, length, .. } => {
                let known = length > 0 && length < u32::MAX && stage != Stage::Probe;
                progress(Progress::Stage(stage, known.then_some(length)));
            }
            ToHost::Rows(rows) => {
                enter(recorded, &rows);
                progress(Progress::Rows(&rows));
            }
            ToHost::Fitting { done, of, .. } => progress(Progress::Models(done, of)),
            ToHost::Report(report) => break Ok(report),
            ToHost::Failed(failure) => break Err(failure),
            ToHost::About(_)
            | ToHost::Armed { .. }
            | ToHost::Planned { .. }
            | ToHost::Started { .. }
            | ToHost::NotStarted { .. } => {}
        }
    };
    resend(conversation, recorded)?;
    Ok(Run {
        about: about.clone(),
        recorded: recorded.clone(),
        outcome,
        damaged: conversation.damaged(),
    })
}

fn enter(recorded: &mut Vec<Recorded>, rows: &Rows) {
    if rows.first as usize > MOST_ROWS {
        return;
    }
    let known = recorded.iter().position(|part| part.stage == rows.stage);
    let index = known.unwrap_or_else(|| {
        recorded.push(Recorded {
            stage: rows.stage,
            count: rows.count,
            rows: Vec::new(),
        });
        recorded.len() - 1
    });
    recorded[index].take(rows);
}

/// Requests the lost rows again: the device still holds those that it fitted.
fn resend(conversation: &mut Conversation, recorded: &mut [Recorded]) -> Result<(), DeviceError> {
    let Some(part) = recorded.iter_mut().find(|part| part.stage == Stage::Record) else {
        return Ok(());
    };
    let begun = Instant::now();
    while let Some(first) = part.rows.iter().position(Option::is_none) {
        conversation.say(&ToDevice::Resend {
            first: first as u32,
        })?;
        let asked = Instant::now();
        while part.rows[first].is_none() && asked.elapsed() < ALIVE * 10 {
            if let Some(ToHost::Rows(rows)) = conversation.hear()?
                && rows.stage == Stage::Record
            {
                let count = part.count;
                part.take(&rows);
                part.count = count;
            }
        }
        if begun.elapsed() > GONE {
            break;
        }
    }
    Ok(())
}
