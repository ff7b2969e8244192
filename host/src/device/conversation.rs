//! Request and response with a device.

use super::{DeviceError, Link, Port};
use shared::wire::{
    About, Deframer, Job, LONGEST_FRAME, MOST_SEGMENTS, Segment, ToDevice, ToHost, VERSION, encode,
};
use std::collections::VecDeque;
use std::io::{ErrorKind, Write};
use std::time::{Duration, Instant};

/// Time that an answer may take.
const PATIENCE: Duration = Duration::from_secs(3);
/// A question is asked again after this long: the first may have been lost to noise.
const AGAIN: Duration = Duration::from_millis(400);

/// An open link to a device.
pub struct Conversation {
    port: String,
    link: Box<dyn Link>,
    inbox: Deframer,
    waiting: VecDeque<ToHost>,
    bytes: u64,
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
            link,
            inbox: Deframer::default(),
            waiting: VecDeque::new(),
            bytes: 0,
        }
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
        if let Some(message) = self.waiting.pop_front() {
            return Ok(Some(message));
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
        Ok(self.waiting.pop_front())
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
        let begun = Instant::now();
        let mut asked: Option<Instant> = None;
        while begun.elapsed() < PATIENCE {
            if asked.is_none_or(|at| at.elapsed() > AGAIN) {
                // A zero first ends whatever the line picked up before.
                self.link.write_all(&[0])?;
                self.say(question)?;
                asked = Some(Instant::now());
            }
            match self.hear()? {
                Some(ToHost::Refused(refusal)) => return Err(DeviceError::Refused(refusal)),
                Some(message) => {
                    if let Some(answer) = wanted(message) {
                        return Ok(answer);
                    }
                }
                None => {}
            }
        }
        Err(DeviceError::Silent {
            port: self.port.clone(),
            seconds: PATIENCE.as_secs_f64(),
            noise: match self.bytes {
                0 => String::new(),
                bytes => format!(" ({bytes} bytes came that make no sense)"),
            },
        })
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
        Ok(about)
    }

    /// Arms the device and starts a run, after a plan has been sent for one that plays it.
    ///
    /// # Errors
    /// Time-out; a refusal.
    pub fn start(&mut self, job: Job, plan: &[Segment]) -> Result<(), DeviceError> {
        for (k, part) in plan.chunks(MOST_SEGMENTS).enumerate() {
            let segments = part.iter().copied().collect();
            let first = (k * MOST_SEGMENTS) as u16;
            self.say(&ToDevice::Plan { first, segments })?;
        }
        let nonce = self.ask(&ToDevice::Arm, |message| match message {
            ToHost::Armed { nonce, .. } => Some(nonce),
            _ => None,
        })?;
        // Only once: a second start would find the arming used up and be refused. Its stage message is the answer.
        self.say(&ToDevice::Start { nonce, job })
    }
}
