//! Samples of a log into recordings: within the span that is wanted, and cut where the clock begins anew.

use super::motor_file::MotorFile;
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::sample::{Sample, increasing};
use super::samples::{Further, Samples};
use super::scale::Scale;
use crate::recording::Recording;

/// Part of a recording's length, from its beginning, within which a time that goes back begins a new recording.
const RESTART: f64 = 0.1;

/// Recordings as their samples come.
pub(super) struct Collector<'m> {
    motor: &'m MotorFile,
    scale: &'m Scale<'m>,
    /// Whether the log may hold several recordings, one after the other.
    several: bool,
    further: Further,
    samples: Samples,
    /// First and last time of the recording at hand, within the wanted span or not, s.
    span: Option<(f64, f64)>,
    done: Vec<Samples>,
}

impl<'m> Collector<'m> {
    pub(super) fn new(
        motor: &'m MotorFile,
        scale: &'m Scale<'m>,
        several: bool,
        further: Further,
    ) -> Self {
        Collector {
            motor,
            scale,
            several,
            further,
            samples: Samples::new(further),
            span: None,
            done: Vec::new(),
        }
    }

    /// Takes the time of the next sample, s; a recording ends where the clock begins anew.
    ///
    /// # Errors
    /// Time goes back elsewhere, or stands still.
    pub(super) fn time(&mut self, now: f64) -> Result<(), ReadFault> {
        match self.span {
            Some((first, last)) if self.several && now < last && restarts(first, last, now) => {
                self.close();
                self.span = Some((now, now));
            }
            Some((first, last)) => {
                increasing(Some(last), now)?;
                self.span = Some((first, now));
            }
            None => self.span = Some((now, now)),
        }
        Ok(())
    }

    /// Whether the time that was taken last lies in the wanted span. Beyond it nothing but times is read: another recording may begin.
    pub(super) fn wants(&self, time_s: f64) -> bool {
        let since = self.span.map_or(0.0, |(first, _)| time_s - first);
        let part = &self.motor.log;
        part.from_s.is_none_or(|from| since >= from) && part.to_s.is_none_or(|to| since <= to)
    }

    /// Takes a sample that is wanted.
    ///
    /// # Errors
    /// There are too many, or no memory for more.
    pub(super) fn take(&mut self, sample: &Sample) -> Result<(), ReadFault> {
        self.samples.push(sample)
    }

    /// Whether no later sample is wanted: the span has ended in the only recording.
    pub(super) fn has_all(&self) -> bool {
        let (Some(to), Some((first, last))) = (self.motor.log.to_s, self.span) else {
            return false;
        };
        !self.several && last - first > to
    }

    fn close(&mut self) {
        let next = Samples::new(self.further);
        self.done.push(std::mem::replace(&mut self.samples, next));
    }

    /// The recordings of `source`; of several each has its number behind it.
    ///
    /// # Errors
    /// Too few samples, or a position loop of unknown gain.
    pub(super) fn finish(mut self, source: &str) -> Result<Vec<Recording>, ReadError> {
        self.close();
        let count = self.done.len();
        // The beginning of one more, cut off, is none.
        let enough = |samples: &Samples| samples.len() >= 2;
        if count > 1 && self.done.iter().any(enough) {
            self.done.retain(enough);
        }
        let count = self.done.len();
        let (motor, scale) = (self.motor, self.scale);
        let finished = |(k, samples): (usize, Samples)| {
            let source = match count {
                1 => source.to_owned(),
                _ => format!("{source}#{}", k + 1),
            };
            let recording = samples.finish(&source, motor, scale);
            recording.map_err(|fault| ReadError::new(Place::file(&source), fault))
        };
        self.done.into_iter().enumerate().map(finished).collect()
    }
}

/// Whether a clock that goes back begins anew, as it does for every episode of a log; a row out of order does not.
fn restarts(first: f64, last: f64, now: f64) -> bool {
    now - first <= RESTART * (last - first)
}
