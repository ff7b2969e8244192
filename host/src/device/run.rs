//! One run: assembles the device's messages.

use super::expected::Expected;
use super::{Conversation, DeviceError};
use servoid_results::device_run::Recorded;
use shared::wire::{About, Failure, Report, Rows, SetPoint, Stage, ToDevice, ToHost};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Interval of the host's keep-alive.
const ALIVE: Duration = Duration::from_millis(20);
/// Time-out of the device.
const GONE: Duration = Duration::from_secs(5);
/// The same while it writes its flash, which may stop its core for seconds.
const GONE_WHILE_KEEPING: Duration = Duration::from_secs(20);
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

/// Follows a run from its start to its report, asking again for rows of the recording that were lost.
///
/// # Errors
/// A link that breaks, a device that falls silent, restarts, goes on for longer than what is expected of it, or says what makes no
/// sense. What arrived is in `recorded` then.
pub fn follow(
    conversation: &mut Conversation,
    about: &About,
    expected: &Expected,
    course: &[(u32, SetPoint)],
    stop: &AtomicBool,
    recorded: &mut Vec<Recorded>,
    progress: impl FnMut(Progress<'_>) -> Result<(), DeviceError>,
) -> Result<Run, DeviceError> {
    let outcome = until_the_end(
        conversation,
        about,
        expected,
        course,
        stop,
        recorded,
        progress,
    );
    let outcome = outcome.inspect_err(|_| {
        // Whatever it still does, it does for nobody.
        let _ = conversation.say(&ToDevice::Stop);
    })?;
    let report = match &outcome {
        Ok(report) => Some(report),
        Err(failure) => failure.report.as_ref(),
    };
    if let Some(report) = report {
        expected.complete(recorded, report, outcome.is_ok());
    }
    // The outcome is there: a link that is lost now costs no more than the rows that were lost before.
    let _ = resend(conversation, recorded);
    Ok(Run {
        about: about.clone(),
        recorded: recorded.clone(),
        outcome,
        damaged: conversation.damaged(),
    })
}

fn until_the_end(
    conversation: &mut Conversation,
    about: &About,
    expected: &Expected,
    course: &[(u32, SetPoint)],
    stop: &AtomicBool,
    recorded: &mut Vec<Recorded>,
    mut progress: impl FnMut(Progress<'_>) -> Result<(), DeviceError>,
) -> Result<Result<Report, Failure>, DeviceError> {
    let begun = conversation.now();
    let (mut said, mut heard, mut advanced) = (begun, begun, begun);
    let (mut models, mut stages) = (0, Vec::new());
    // Periods of the course that are over, and how many of its set-points hold or held.
    let (mut along, mut held) = (None, 0);
    let mut stopped: Option<Instant> = None;
    loop {
        let now = conversation.now();
        if stop.load(Ordering::Relaxed)
            && stopped.is_none_or(|at| now.duration_since(at) > FAREWELL / 4)
        {
            if stopped.is_some_and(|at| now.duration_since(at) > FAREWELL) {
                return Err(DeviceError::Link(std::io::ErrorKind::TimedOut.into()));
            }
            conversation.say(&ToDevice::Stop)?;
            stopped.get_or_insert(now);
        }
        // In the device's time, which an emulated one's is slower than ours. Said again as often as that the host is there: it may be lost.
        let due = course.partition_point(|(from, _)| Some(*from) <= along);
        if now.duration_since(said) >= ALIVE || due > held {
            conversation.say(&match course[..due].last() {
                Some((_, set_point)) => ToDevice::SetPoint(*set_point),
                None => ToDevice::Alive,
            })?;
            (said, held) = (now, due);
        }
        expected.check_time(now.duration_since(begun), now.duration_since(advanced))?;
        let Some(message) = conversation.hear()? else {
            let gone = match stages.last() {
                Some(Stage::Keep) => GONE_WHILE_KEEPING,
                _ => GONE,
            };
            if now.duration_since(heard) > gone {
                return Err(DeviceError::Silent {
                    port: "the device".to_owned(),
                    seconds: gone.as_secs_f64(),
                    noise: String::new(),
                });
            }
            continue;
        };
        heard = now;
        match message {
            ToHost::About(now) if now.boot != about.boot => return Err(DeviceError::Restarted),
            ToHost::Stage { stage, length, .. } => {
                if stage == Stage::Follow {
                    along = along.or(Some(0));
                }
                let known = length > 0 && length < u32::MAX && stage != Stage::Probe;
                // Each once: a device that goes round and round brings nothing new.
                if !stages.contains(&stage) {
                    stages.push(stage);
                    advanced = now;
                }
                progress(Progress::Stage(stage, known.then_some(length)))?;
            }
            ToHost::Rows(rows) => {
                expected.check_rows(&rows)?;
                if enter(recorded, &rows) {
                    advanced = now;
                }
                if rows.stage == Stage::Follow {
                    along = along.max(Some(rows.first + rows.rows.len() as u32));
                }
                progress(Progress::Rows(&rows))?;
            }
            ToHost::Fitting { done, of, .. } => {
                expected.check_models(done)?;
                if done > models {
                    (models, advanced) = (done, now);
                }
                progress(Progress::Models(done, of))?;
            }
            ToHost::Report(report) => {
                expected.check_report(&report)?;
                return Ok(Ok(report));
            }
            ToHost::Failed(failure) => {
                if let Some(report) = &failure.report {
                    expected.check_report(report)?;
                }
                return Ok(Err(failure));
            }
            // A refusal is of an earlier question: the run has begun.
            ToHost::Refused(_)
            | ToHost::About(_)
            | ToHost::Armed { .. }
            | ToHost::Planned { .. }
            | ToHost::Started { .. }
            | ToHost::NotStarted { .. }
            | ToHost::Details(_) => {}
        }
    }
}

/// Puts rows into their stage; true if they bring it on.
fn enter(recorded: &mut Vec<Recorded>, rows: &Rows) -> bool {
    let known = recorded.iter().position(|part| part.stage == rows.stage);
    let index = known.unwrap_or_else(|| {
        recorded.push(Recorded::new(rows.stage, rows.count));
        recorded.len() - 1
    });
    let before = recorded[index].rows.len();
    recorded[index].take(rows);
    recorded[index].rows.len() > before
}

/// Requests the lost rows again: the device still holds those that it fitted.
fn resend(conversation: &mut Conversation, recorded: &mut [Recorded]) -> Result<(), DeviceError> {
    let Some(part) = recorded.iter_mut().find(|part| part.stage == Stage::Record) else {
        return Ok(());
    };
    let begun = conversation.now();
    while let Some(first) = part.rows.iter().position(Option::is_none) {
        conversation.say(&ToDevice::Resend {
            first: first as u32,
        })?;
        let asked = conversation.now();
        while part.rows[first].is_none() && conversation.since(asked) < ALIVE * 10 {
            if let Some(ToHost::Rows(rows)) = conversation.hear()?
                && rows.stage == Stage::Record
                && rows.first as usize + rows.rows.len() <= part.rows.len()
            {
                part.take_again(&rows);
            }
        }
        if conversation.since(begun) > GONE {
            break;
        }
    }
    Ok(())
}
