//! Samples of a log into recordings: within the span that is wanted, and cut where the clock begins anew.

use super::cells::Sample;
use super::finished::{Notes, finished};
use super::motor_file::MotorFile;
use super::order::{Next, Span};
use super::place::Place;
use super::read_error::{ReadError, ReadFault};
use super::reading::Reading;
use super::samples::{Further, Samples};
use super::scale::Scale;
use super::stamps::{Spread, spread};

/// Absurd times may stand in so small a part of the rows.
const ABSURD_PART: u64 = 100;

/// Recordings as their samples come.
pub(super) struct Collector<'m> {
    motor: &'m MotorFile,
    scale: &'m Scale<'m>,
    /// Whether the log may hold several recordings, one after the other.
    several: bool,
    further: Further,
    samples: Samples,
    /// Times of the recording at hand, within the wanted span or not.
    span: Option<Span>,
    /// What the clock has lost by running over, s.
    lost_s: f64,
    /// The line of the first time that repeats, and that time.
    repeats: Option<(u64, f64)>,
    /// Whether the last sample was taken, not passed over.
    took_last: bool,
    done: Vec<Done>,
    /// Lines whose time is absurd.
    absurd: Vec<u64>,
    ran_over: u64,
    line_before: u64,
}

/// A recording that has ended.
struct Done {
    samples: Samples,
    span: Option<Span>,
    repeats: Option<(u64, f64)>,
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
            samples: Samples::new(&further),
            further,
            span: None,
            lost_s: 0.0,
            repeats: None,
            took_last: false,
            done: Vec::new(),
            absurd: Vec::new(),
            ran_over: 0,
            line_before: 0,
        }
    }

    /// Takes the time of the next sample, s, which stands on `line`; a recording ends where the clock begins anew. Gives the time with what
    /// the clock has lost by running over.
    ///
    /// # Errors
    /// Time goes back elsewhere.
    pub(super) fn time(&mut self, stamp: f64, line: u64) -> Result<f64, ReadFault> {
        let mut now = stamp + self.lost_s;
        let line_before = std::mem::replace(&mut self.line_before, line);
        let Some(mut span) = self.span else {
            self.span = Some(Span::new(now));
            return Ok(now);
        };
        if let Some(lost) = span.ran_over(now, self.motor.units.time) {
            self.lost_s += lost;
            self.ran_over += 1;
            now += lost;
        }
        let earlier = self.done.last().and_then(|done| done.span.as_ref());
        match span.next(now, self.several, earlier)? {
            Next::On => span.take(now),
            Next::Repeats => {
                self.repeats.get_or_insert((line, now));
                span.count += 1;
            }
            Next::Anew => {
                self.close();
                self.lost_s = 0.0;
                span = Span::new(stamp);
                now = stamp;
            }
            Next::WithoutLast => {
                self.absurd.push(line_before);
                if self.took_last {
                    self.samples.move_last_before(now);
                }
                span.drop_last();
                span.take(now);
            }
            Next::Resumes => {
                self.absurd.push(line_before);
                if let Some(done) = self.done.pop() {
                    let absurd = std::mem::replace(&mut self.samples, done.samples);
                    self.samples.extend(absurd);
                    self.samples.move_last_before(now);
                    self.repeats = done.repeats;
                    span = done.span.unwrap_or(span);
                }
                span.take(now);
            }
        }
        self.span = Some(span);
        Ok(now)
    }

    /// Whether the time that was taken last lies in the wanted span. Beyond it nothing but times is read: another recording may begin.
    pub(super) fn wants(&mut self, time_s: f64) -> bool {
        let since = self.span.map_or(0.0, |span| time_s - span.first);
        let part = &self.motor.log;
        let wanted =
            part.from_s.is_none_or(|from| since >= from) && part.to_s.is_none_or(|to| since <= to);
        self.took_last = wanted;
        wanted
    }

    /// Takes a sample that is wanted.
    ///
    /// # Errors
    /// There are too many, or no memory for more.
    pub(super) fn take(&mut self, sample: &Sample) -> Result<(), ReadFault> {
        let before = self.samples.len();
        self.samples.push(sample)?;
        self.took_last = self.samples.len() > before;
        Ok(())
    }

    /// Whether no later sample is wanted: the span has ended in the only recording.
    pub(super) fn has_all(&self) -> bool {
        let (Some(to), Some(span)) = (self.motor.log.to_s, self.span) else {
            return false;
        };
        !self.several && span.last - span.first > to
    }

    fn close(&mut self) {
        let next = Samples::new(&self.further);
        self.done.push(Done {
            samples: std::mem::replace(&mut self.samples, next),
            span: self.span.take(),
            repeats: self.repeats.take(),
        });
    }

    /// The recordings of `source`; of several each has its number behind it.
    ///
    /// # Errors
    /// Too few samples, times that repeat, or a position loop of unknown gain.
    pub(super) fn finish(mut self, source: &str) -> Result<Reading, ReadError> {
        self.close();
        let mut notes = Notes::new(source);
        self.say_absurd(&mut notes, source)?;
        // The beginning of one more, cut off, is none.
        let enough = |done: &Done| done.samples.len() >= 2;
        if self.done.len() > 1 && self.done.iter().any(enough) {
            let rows = (self.done.iter())
                .filter(|done| !enough(done))
                .map(|done| done.samples.len());
            let alone: usize = rows.sum();
            if alone > 0 {
                notes.add(format!(
                    "{alone} row{} alone before or after a time that goes back, and left out",
                    if alone == 1 { " stands" } else { "s stand" }
                ));
            }
            self.done.retain(enough);
        }
        let (motor, scale, several) = (self.motor, self.scale, self.several);
        let mut parts = Vec::new();
        for mut done in self.done {
            if let Some((line, now)) = done.repeats {
                let found = spread(&mut done.samples).ok_or_else(|| {
                    ReadError::new(Place::line(source, line), ReadFault::TimeRepeats { now })
                })?;
                notes.add(match found {
                    Spread::Even {
                        repeated,
                        tick_s,
                        interval_s,
                    } => format!(
                        "{repeated} time stamps repeat the one before, since the clock counts whole {} ms: the rows are spread evenly, \
                         {} ms apart (--rate states another rate)",
                        milliseconds(tick_s),
                        milliseconds(interval_s)
                    ),
                    Spread::Merged(rows) => format!(
                        "{rows} rows have the stamp of the row before and what that lacks, angle or command: each pair is taken as one row"
                    ),
                    Spread::Copies(rows) => {
                        format!("{rows} rows are copies of the row before, and are left out")
                    }
                });
            }
            parts.push(done.samples);
        }
        let fail = |fault| ReadError::new(Place::file(source), fault);
        let mut recordings = Vec::new();
        for samples in parts {
            recordings.extend(finished(samples, motor, scale, several, &mut notes).map_err(fail)?);
        }
        if recordings.is_empty() {
            return Err(fail(ReadFault::NoAngle));
        }
        let count = recordings.len();
        for (k, recording) in recordings.iter_mut().enumerate() {
            recording.source = match count {
                1 => source.to_owned(),
                _ => format!("{source}#{}", k + 1),
            };
        }
        Ok(Reading::of(recordings, notes.texts))
    }

    fn say_absurd(&self, notes: &mut Notes, source: &str) -> Result<(), ReadError> {
        if self.ran_over > 0 {
            notes.add(format!(
                "the clock runs over {} times, as a counter does: the time goes on",
                self.ran_over
            ));
        }
        let Some(first) = self.absurd.first() else {
            return Ok(());
        };
        let rows: u64 = self.done.iter().map(|done| done.samples.len() as u64).sum();
        let count = self.absurd.len() as u64;
        if count > 1 + rows / ABSURD_PART {
            let fault = ReadFault::AbsurdTimes { count };
            return Err(ReadError::new(Place::line(source, *first), fault));
        }
        notes.add(format!(
            "the time of line {first}{} lies far outside the recording: the row is taken half-way between its neighbours",
            match count {
                1 => String::new(),
                _ => format!(" (and of {} more)", count - 1),
            }
        ));
        Ok(())
    }
}

/// A time in ms to the nanosecond, without the zeros behind it.
fn milliseconds(seconds: f64) -> f64 {
    (seconds * 1e9).round() / 1e6
}
