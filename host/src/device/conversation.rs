//! Request and response with a device.

use super::expected::check_about;
use super::{DeviceError, Link, Port};
use shared::wire::{
    About, Deframer, Details, Job, LONGEST_FRAME, MOST_SEGMENTS, PlanDigest, PlanPart, Refusal,
    Segment, ToDevice, ToHost, VERSION, encode,
};
use std::collections::VecDeque;
use std::io::{ErrorKind, Write};
use std::time::{Duration, Instant};

/// Time that an answer may take.
const PATIENCE: Duration = Duration::from_secs(3);
/// A question is asked again after this long: the first may have been lost to noise. Well within the silence that a device that has
/// started bears.
const AGAIN: Duration = Duration::from_millis(100);

/// What time it is.
pub type Clock = Box<dyn Fn() -> Instant + Send>;

/// An open link to a device.
pub struct Conversation {
    port: String,
    clock: Clock,
    link: Box<dyn Link>,
    inbox: Deframer,
    waiting: VecDeque<ToHost>,
    bytes: u64,
    /// The run that was started last: what belongs to an earlier one is late and is not heard.
    run: Option<u32>,
}

impl Conversation {
    /// Opens the port.
    ///
    /// # Errors
    /// As [`Port::open`].
    pub fn open(port: &Port) -> Result<Self, DeviceError> {
        Ok(Self::over(port.open()?, port.to_string()))
    }

    /// Over a link that is open already.
    pub fn over(link: Box<dyn Link>, port: String) -> Self {
        Conversation {
            port,
            clock: Box::new(Instant::now),
            link,
            inbox: Deframer::default(),
            waiting: VecDeque::new(),
            bytes: 0,
            run: None,
        }
    }

    /// By another clock, such as a simulation's.
    #[must_use]
    pub fn with_clock(self, clock: Clock) -> Self {
        Conversation { clock, ..self }
    }

    /// The present instant of its clock.
    pub(super) fn now(&self) -> Instant {
        (self.clock)()
    }

    /// Time since an instant of its clock.
    pub(super) fn since(&self, then: Instant) -> Duration {
        self.now().saturating_duration_since(then)
    }

    /// Sends a message.
    ///
    /// # Errors
    /// A broken link.
    pub fn say(&mut self, message: &ToDevice) -> Result<(), DeviceError> {
        let mut buffer = [0; LONGEST_FRAME];
        let frame = encode(message, &mut buffer).unwrap_or_default();
        self.link.write_all(frame)?;
        self.link.flush()?;
        Ok(())
    }

    /// The next message, if one has come or comes within a few milliseconds.
    ///
    /// # Errors
    /// A broken link.
    pub fn hear(&mut self) -> Result<Option<ToHost>, DeviceError> {
        if !self.waiting.is_empty() {
            return Ok(self.next());
        }
        let mut buffer = [0; 1024];
        match self.link.read(&mut buffer) {
            Ok(0) => return Err(DeviceError::Link(ErrorKind::UnexpectedEof.into())),
            Ok(read) => {
                self.bytes += read as u64;
                for &byte in &buffer[..read] {
                    self.waiting.extend(self.inbox.push::<ToHost>(byte));
                }
            }
            Err(error)
                if matches!(
                    error.kind(),
                    ErrorKind::WouldBlock | ErrorKind::TimedOut | ErrorKind::Interrupted
                ) => {}
            Err(error) => return Err(error.into()),
        }
        Ok(self.next())
    }

    /// The next message that waits.
    fn next(&mut self) -> Option<ToHost> {
        while let Some(message) = self.waiting.pop_front() {
            if message.run().is_none_or(|run| Some(run) == self.run) {
                return Some(message);
            }
        }
        None
    }

    /// Number of damaged frames.
    pub fn damaged(&self) -> u32 {
        self.inbox.dropped()
    }

    /// Repeats a request until an answer arrives that `wanted` accepts.
    fn ask<T>(
        &mut self,
        question: &ToDevice,
        mut wanted: impl FnMut(ToHost) -> Option<T>,
    ) -> Result<T, DeviceError> {
        let begun = self.now();
        let mut asked: Option<Instant> = None;
        while self.since(begun) < PATIENCE {
            if asked.is_none_or(|at| self.since(at) > AGAIN) {
                // A zero first ends whatever the line picked up before.
                self.link.write_all(&[0])?;
                self.say(question)?;
                asked = Some(self.now());
            }
            match self.hear()? {
                // A start has refusals of its own: this one is of an earlier question.
                Some(ToHost::Refused(_)) if matches!(question, ToDevice::Start { .. }) => {}
                Some(ToHost::Refused(refusal) | ToHost::NotStarted { why: refusal, .. }) => {
                    return Err(DeviceError::Refused(refusal));
                }
                Some(message) => {
                    if let Some(answer) = wanted(message) {
                        return Ok(answer);
                    }
                }
                None => {}
            }
        }
        Err(self.silent())
    }

    fn silent(&self) -> DeviceError {
        DeviceError::Silent {
            port: self.port.clone(),
            seconds: PATIENCE.as_secs_f64(),
            noise: match self.bytes {
                0 => String::new(),
                bytes => format!(" ({bytes} bytes came that make no sense)"),
            },
        }
    }

    /// Identification of the device.
    ///
    /// # Errors
    /// Time-out; another version of the link.
    pub fn about(&mut self) -> Result<About, DeviceError> {
        let about = self.ask(&ToDevice::Hello, |message| match message {
            ToHost::About(about) => Some(about),
            _ => None,
        })?;
        if about.version != VERSION {
            return Err(DeviceError::Version {
                theirs: about.version,
                ours: VERSION,
            });
        }
        check_about(&about)?;
        Ok(about)
    }

    /// What more the device says of itself.
    ///
    /// # Errors
    /// Time-out.
    pub fn details(&mut self) -> Result<Details, DeviceError> {
        self.ask(&ToDevice::Describe, |message| match message {
            ToHost::Details(details) => Some(details),
            _ => None,
        })
    }

    /// Starts a run: sends the plan of one that plays it, arms the device, and starts until the device says that it has.
    ///
    /// Over a link that loses, doubles or reorders frames the device runs this job with this plan, or nothing.
    ///
    /// # Errors
    /// Time-out; a refusal.
    pub fn start(&mut self, job: Job, plan: &[Segment]) -> Result<(), DeviceError> {
        let of = self.send_plan(plan)?;
        let begun = self.now();
        loop {
            let nonce = self.ask(&ToDevice::Arm, |message| match message {
                ToHost::Armed { nonce, .. } => Some(nonce),
                _ => None,
            })?;
            self.run = Some(nonce);
            let start = ToDevice::Start {
                nonce,
                job,
                plan: of,
            };
            let mut early = VecDeque::new();
            let started = self.ask(&start, |message| match message {
                ToHost::Started { .. } => Some(()),
                // What the run brings while its first answer is lost.
                other => {
                    early.extend(other.run().is_some().then_some(other));
                    None
                }
            });
            match started {
                // Another arming, of a frame that came twice or late, has replaced this one.
                Err(DeviceError::Refused(Refusal::NotArmed)) if self.since(begun) < PATIENCE => {}
                Err(error) => return Err(error),
                Ok(()) => {
                    early.append(&mut self.waiting);
                    self.waiting = early;
                    return Ok(());
                }
            }
        }
    }

    /// Sends a plan in parts, each until the device holds it.
    fn send_plan(&mut self, plan: &[Segment]) -> Result<PlanDigest, DeviceError> {
        let of = PlanDigest::of(plan);
        let mut held = 0;
        let mut progress = self.now();
        while let Some(rest) = plan.get(held..)
            && !rest.is_empty()
        {
            let segments = rest.iter().copied().take(MOST_SEGMENTS).collect();
            let part = PlanPart {
                of,
                first: u16::try_from(held).unwrap_or(u16::MAX),
                segments,
            };
            let holds = self.ask(&ToDevice::Plan(part), |message| match message {
                ToHost::Planned { of: theirs, held } if theirs == of => Some(usize::from(held)),
                _ => None,
            })?;
            if holds > held {
                progress = self.now();
            } else if self.since(progress) > PATIENCE {
                return Err(self.silent());
            }
            held = holds;
        }
        Ok(of)
    }
}
