//! Samples of one run to recordings: gaps closed, angles unwrapped, speeds integrated, and parted where a counter was set anew.

use super::bridge_off::driven;
use super::counts::snap_to_whole;
use super::filtered::{Filter, Way, unfiltered};
use super::gaps::{closed, pauses};
use super::jumps::{DECIDEGREES, Wrapped, set_anew, unwrapped};
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, SpeedUnit};
use super::read_error::ReadFault;
use super::samples::Samples;
use super::scale::{Scale, positive};
use super::speed::{integrated, without_overflow};
use crate::channel::{Measured, Series};
use crate::position_loop::{Follower, LoopSettings};
use crate::recording::{PositionDrive, Recording};

/// What a reader has to say of a file, a sentence each.
pub(super) struct Notes<'s> {
    source: &'s str,
    pub(super) texts: Vec<String>,
}

impl<'s> Notes<'s> {
    pub(super) fn new(source: &'s str) -> Self {
        Notes {
            source,
            texts: Vec::new(),
        }
    }

    /// Adds a sentence behind the file's name.
    pub(super) fn add(&mut self, text: String) {
        self.texts.push(format!("{}: {text}", self.source));
    }
}

/// The recordings that samples of one run become, without names; only one unless `parted`.
///
/// # Errors
/// Too few samples, an angle beyond any counter, or a position loop of unknown gain.
pub(super) fn finished(
    samples: Samples,
    motor: &MotorFile,
    scale: &Scale<'_>,
    parted: bool,
    notes: &mut Notes<'_>,
) -> Result<Vec<Recording>, ReadFault> {
    if samples.len() < 2 {
        return Err(ReadFault::TooFewSamples(samples.len()));
    }
    if samples.held_commands > 0 {
        let (rows, have) = rows(samples.held_commands as usize);
        notes.add(format!("{rows} {have} no command: the last one holds"));
    }
    let count = samples.len();
    let (parts, done) = closed(samples);
    let left = parts.iter().map(Samples::len).max().unwrap_or(0);
    if left < 2 && done.rows < count {
        return Err(ReadFault::TooFewSamples(left.max(1)));
    }
    if done.rows > 0 {
        let parted = match done.parted {
            0 => String::new(),
            1 => "; a longer gap parts the recording".to_owned(),
            count => format!("; {count} longer gaps part the recording"),
        };
        let (rows, have) = rows(done.rows);
        notes.add(format!(
            "{rows} {have} no angle: what is commanded there acts all the same{parted}"
        ));
    }
    let spanned = motor.log.from_s.is_some() || motor.log.to_s.is_some();
    let mut recordings = Vec::new();
    for samples in parts {
        let mut run = Run {
            samples,
            motor,
            scale,
            parted,
        };
        run.volts_of_shares();
        recordings.extend(run.recordings(notes)?);
    }
    if !spanned {
        for recording in &mut recordings {
            leave_out_standing(recording, notes);
        }
    }
    Ok(recordings)
}

/// Leaves out parts without a command beside others that have one: a counter is often set to zero before a run, or after it.
fn leave_out_resting(parts: &mut Vec<Recording>, notes: &mut Notes<'_>) {
    let rests = |part: &Recording| part.command.iter().all(|command| *command == 0.0);
    let resting = parts.iter().filter(|part| rests(part)).count();
    if resting == 0 || resting == parts.len() {
        return;
    }
    parts.retain(|part| !rests(part));
    notes.add(match resting {
        1 => "one of these parts has no command but zero, and is left out".to_owned(),
        count => format!("{count} of these parts have no command but zero, and are left out"),
    });
}

/// Leaves out the beginning or the end of a recording in which the bridge was off.
fn leave_out_standing(recording: &mut Recording, notes: &mut Notes<'_>) {
    let Some(driven) = driven(recording) else {
        return;
    };
    let at = |k: usize| recording.time_s[k.min(recording.len() - 1)] - recording.time_s[0];
    let (from, to) = (at(driven.start), at(driven.end));
    let (what, option) = match (driven.start, driven.end < recording.len()) {
        (0, _) => (format!("from {to:.3} s on,"), format!("--to {to:.3}")),
        (_, false) => (format!("up to {from:.3} s,"), format!("--from {from:.3}")),
        _ => (
            format!("up to {from:.3} s and from {to:.3} s on,"),
            format!("--from {from:.3} --to {to:.3}"),
        ),
    };
    notes.add(format!(
        "{what} the motor stands, or coasts to rest, under commands that move it elsewhere, as with its bridge off: that part is left out, as by \
         {option} (--from 0 keeps all)"
    ));
    *recording = recording.samples(driven);
}

/// Samples that each have an angle.
struct Run<'m> {
    samples: Samples,
    motor: &'m MotorFile,
    scale: &'m Scale<'m>,
    /// Whether it may become several recordings.
    parted: bool,
}

impl Run<'_> {
    /// Makes volts of a share of the measured supply.
    fn volts_of_shares(&mut self) {
        for column in self.samples.measured.0.iter_mut() {
            *column = column.take().and_then(from_the_first);
        }
        let supply = &self.samples.measured[Measured::Supply];
        if let (true, Some(supply)) = (self.scale.of_measured_supply, supply) {
            let commands = self.samples.command.iter_mut().zip(supply);
            commands.for_each(|(command, supply)| *command *= supply);
        }
    }

    fn recordings(mut self, notes: &mut Notes<'_>) -> Result<Vec<Recording>, ReadFault> {
        let (motor, scale) = (self.motor, self.scale);
        if let AngleUnit::Speed(unit) = motor.units.angle {
            return self.of_speeds(unit, notes);
        }
        if let Some(settings) = motor.position {
            return Ok(vec![self.behind_loop(settings)?]);
        }
        if let Some(wrapped) = unwrapped(&mut self.samples.counts, scale.counts_per_rev) {
            let Wrapped { turn, times } = wrapped;
            let tenths = if turn == DECIDEGREES && turn != scale.counts_per_rev {
                "; where these are tenths of a degree, --counts-per-rev is 3600"
            } else {
                ""
            };
            notes.add(format!(
                "the angle wraps every {turn} counts: it is unwrapped ({times} times){tenths}"
            ));
        }
        let anew = set_anew(&self.samples.time_s, &self.samples.counts);
        let at_s = |k: usize| self.samples.time_s[k] - self.samples.time_s[0];
        if let [first, ..] = anew[..] {
            if !self.parted {
                return Err(ReadFault::SetAnew {
                    sample: first.at + 1,
                    time_s: self.samples.time_s[first.at],
                    from: self.samples.counts[first.at - 1],
                    to: self.samples.counts[first.at],
                });
            }
            let jumps = anew
                .iter()
                .map(|set| format!("{:+.0} counts at {:.3} s", set.by, at_s(set.at)));
            notes.add(format!(
                "the angle jumps by {}, as a counter that is set to another value (re-zeroed, or its index found): what is before and \
                 behind is taken as parts of one recording",
                jumps.collect::<Vec<_>>().join(" and ")
            ));
        }
        let mut begins: Vec<usize> = anew.iter().map(|set| set.at).collect();
        if self.parted {
            let pauses = pauses(&self.samples.time_s);
            if let [first, ..] = pauses[..] {
                notes.add(format!(
                    "no rows were logged from {:.3} to {:.3} s{}, and what was commanded there is not known: what is before and behind is \
                     taken as parts of one recording",
                    at_s(first - 1),
                    at_s(first),
                    match pauses.len() {
                        1 => String::new(),
                        count => format!(" and in {} more pauses", count - 1),
                    }
                ));
            }
            begins.extend(pauses);
            begins.sort_unstable();
            begins.dedup();
        }
        let ends: Vec<usize> = [&[0][..], &begins, &[self.samples.len()]].concat();
        let parts = ends.windows(2).filter(|pair| pair[1] - pair[0] >= 2);
        let parts = parts.map(|pair| {
            let mut samples = self.samples.rows(pair[0]..pair[1]);
            let whole = motor.units.angle == AngleUnit::Counts
                || snap_to_whole(&mut samples.counts).is_some();
            recording(samples, motor, scale, whole, None)
        });
        let mut parts: Vec<Recording> = parts.collect();
        leave_out_resting(&mut parts, notes);
        Ok(parts)
    }

    fn of_speeds(
        mut self,
        unit: SpeedUnit,
        notes: &mut Notes<'_>,
    ) -> Result<Vec<Recording>, ReadFault> {
        let per_sample = unit == SpeedUnit::CountsPerSample;
        let word = self.scale.word(16);
        if !per_sample && let Some(times) = without_overflow(&mut self.samples.counts, word) {
            notes.add(format!(
                "the speed overflows its 16 bits and wraps at 65536 ({times} times): it is unwrapped"
            ));
        }
        if !per_sample && self.is_even() && !is_whole(&self.samples) {
            self.undo_filter(notes);
        }
        let samples = &mut self.samples;
        let (counts, whole) = integrated(&samples.time_s, &samples.counts, per_sample)?;
        samples.counts = counts;
        Ok(vec![recording(
            self.samples,
            self.motor,
            self.scale,
            whole,
            None,
        )])
    }

    fn is_even(&self) -> bool {
        let time = &self.samples.time_s;
        let mean = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
        time.windows(2)
            .all(|pair| (pair[1] - pair[0] - mean).abs() < EVEN * mean)
    }

    /// Undoes a filter that the speed went through.
    fn undo_filter(&mut self, notes: &mut Notes<'_>) {
        let Samples {
            time_s,
            command,
            counts,
            ..
        } = &mut self.samples;
        let Some((filter, way)) = unfiltered(counts, command) else {
            return;
        };
        let interval = (time_s[time_s.len() - 1] - time_s[0]) / (time_s.len() - 1) as f64;
        let what = match filter {
            Filter::Average(samples) => format!("is averaged over {samples} samples"),
            Filter::Lag(share) => {
                format!("is filtered by a lag that takes {share:.4} of each new value")
            }
        };
        let done = match way {
            Way::Undone => "that is undone before it is integrated",
            Way::CommandToo => "the command is averaged likewise",
        };
        notes.add(format!(
            "the speed {what}, which delays it by {:.1} ms: {done}, so that inertia and delay do not contain it",
            1e3 * interval * filter.delay_samples()
        ));
    }

    fn behind_loop(mut self, settings: LoopSettings) -> Result<Recording, ReadFault> {
        let (motor, scale) = (self.motor, self.scale);
        let mut position = self.followed(settings)?;
        let dropped = match motor.units.angle {
            AngleUnit::Counts => Some(0.0),
            _ => snap_to_whole(&mut self.samples.counts),
        };
        let targets = &mut position.target_counts;
        targets
            .iter_mut()
            .for_each(|target| *target -= dropped.unwrap_or(0.0));
        Ok(recording(
            self.samples,
            motor,
            scale,
            dropped.is_some(),
            Some(position),
        ))
    }

    /// Targets become the volts that the loop makes of them. The readings are as they came: the loop knows no other zero.
    fn followed(&mut self, settings: LoopSettings) -> Result<PositionDrive, ReadFault> {
        let (motor, samples) = (self.motor, &mut self.samples);
        let called = || motor.called().to_owned();
        let limit = positive("limit_v", settings.limit_v.or(motor.supply_v))?;
        let limit = limit.ok_or_else(|| ReadFault::NoLimit { motor: called() })?;
        let target_counts = std::mem::take(&mut samples.command);
        let follower = Follower {
            time_s: &samples.time_s,
            target_counts: &target_counts,
            counts: &samples.counts,
            enabled: samples.enabled.as_deref(),
            counts_per_rev: self.scale.counts_per_rev,
        };
        let control = follower.control(&settings, limit);
        let control = control.map_err(|why| ReadFault::LoopGain {
            why,
            motor: called(),
        })?;
        samples.command = follower.volts(&control);
        Ok(PositionDrive {
            control,
            target_counts,
        })
    }
}

/// Steps between samples differ by no more than this part where they are even.
const EVEN: f64 = 0.2;

/// Whether speeds are whole counts a sample, as a controller that differentiates its own counter has them: these went through no filter.
fn is_whole(samples: &Samples) -> bool {
    let pairs = samples.time_s.windows(2).zip(&samples.counts[1..]);
    let mut steps: Vec<f64> = pairs
        .map(|(time, speed)| speed * (time[1] - time[0]))
        .collect();
    super::counts::whole_steps(&mut steps)
}

fn recording(
    samples: Samples,
    motor: &MotorFile,
    scale: &Scale<'_>,
    quantised: bool,
    position: Option<PositionDrive>,
) -> Recording {
    let measured = Series::from(samples.measured);
    let most = measured.get(Measured::Supply).map(|supply| {
        let most = supply.iter().copied();
        most.fold(0.0, f64::max)
    });
    Recording {
        source: String::new(),
        time_s: samples.time_s,
        command: samples.command,
        counts: samples.counts,
        measured,
        enabled: samples.enabled,
        counts_per_rev: scale.counts_per_rev,
        quantised,
        supply_v: most.or(motor.supply_v),
        drive: motor.recorded_drive(),
        position,
    }
}

/// A column with its first value in the place of those before it; none where there is no value at all.
fn from_the_first(mut values: Vec<f64>) -> Option<Vec<f64>> {
    let first = values.iter().copied().find(|x| !x.is_nan())?;
    let unknown = values.iter_mut().take_while(|x| x.is_nan());
    unknown.for_each(|x| *x = first);
    Some(values)
}

/// So many rows, with their verb.
fn rows(count: usize) -> (String, &'static str) {
    match count {
        1 => ("1 row".to_owned(), "has"),
        count => (format!("{count} rows"), "have"),
    }
}
