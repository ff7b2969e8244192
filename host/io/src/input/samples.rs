//! The samples of a recording as they are read, and the recording that they become.

use std::collections::TryReserveError;

use super::counts::snap_to_whole;
use super::csv_file::MAX_ROWS;
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, SpeedUnit};
use super::read_error::ReadFault;
use super::sample::Sample;
use super::scale::{Scale, positive};
use super::speed::integrated;
use crate::position_loop::{Follower, LoopSettings};
use crate::recording::{PositionDrive, Recording};

/// Columns beside those that every recording has.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Further {
    pub(super) current: bool,
    pub(super) temperature: bool,
    pub(super) enabled: bool,
}

/// The columns as they grow.
pub(super) struct Samples {
    time_s: Vec<f64>,
    command: Vec<f64>,
    counts: Vec<f64>,
    current_a: Option<Vec<f64>>,
    /// NaN before the first row that tells it.
    temperature_c: Option<Vec<f64>>,
    enabled: Option<Vec<bool>>,
}

impl Samples {
    pub(super) fn new(further: Further) -> Self {
        Samples {
            time_s: Vec::new(),
            command: Vec::new(),
            counts: Vec::new(),
            current_a: further.current.then(Vec::new),
            temperature_c: further.temperature.then(Vec::new),
            enabled: further.enabled.then(Vec::new),
        }
    }

    /// Number of samples.
    pub(super) fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Time of the sample before the next, s.
    pub(super) fn last_time(&self) -> Option<f64> {
        self.time_s.last().copied()
    }

    pub(super) fn push(&mut self, sample: &Sample) -> Result<(), ReadFault> {
        if self.time_s.len() == MAX_ROWS {
            return Err(ReadFault::TooManyRows { limit: MAX_ROWS });
        }
        self.try_push(sample).map_err(|_| ReadFault::OutOfMemory)
    }

    fn try_push(&mut self, sample: &Sample) -> Result<(), TryReserveError> {
        append(&mut self.time_s, sample.time_s)?;
        append(&mut self.command, sample.command)?;
        append(&mut self.counts, sample.counts)?;
        if let (Some(values), Some(value)) = (&mut self.current_a, sample.current_a) {
            append(values, value)?;
        }
        if let Some(values) = &mut self.temperature_c {
            // It changes slowly, and is logged seldom: the last one holds.
            let last = values.last().copied().unwrap_or(f64::NAN);
            append(values, sample.temperature_c.unwrap_or(last))?;
        }
        if let (Some(values), Some(value)) = (&mut self.enabled, sample.enabled) {
            append(values, value)?;
        }
        Ok(())
    }

    pub(super) fn finish(
        mut self,
        source: &str,
        motor: &MotorFile,
        scale: &Scale,
    ) -> Result<Recording, ReadFault> {
        if self.time_s.len() < 2 {
            return Err(ReadFault::TooFewSamples(self.time_s.len()));
        }
        if let AngleUnit::Speed(unit) = motor.units.angle {
            let per_sample = unit == SpeedUnit::CountsPerSample;
            let (counts, whole) = integrated(&self.time_s, &self.counts, per_sample)?;
            self.counts = counts;
            return Ok(self.recording(source, motor, scale, whole, None));
        }
        let mut position = (motor.position)
            .map(|settings| self.followed(settings, motor, scale))
            .transpose()?;
        let dropped = match motor.units.angle {
            AngleUnit::Counts => Some(0.0),
            _ => snap_to_whole(&mut self.counts),
        };
        let targets = position.iter_mut().flat_map(|p| &mut p.target_counts);
        targets.for_each(|target| *target -= dropped.unwrap_or(0.0));
        Ok(self.recording(source, motor, scale, dropped.is_some(), position))
    }

    fn recording(
        self,
        source: &str,
        motor: &MotorFile,
        scale: &Scale,
        quantised: bool,
        position: Option<PositionDrive>,
    ) -> Recording {
        Recording {
            source: source.into(),
            time_s: self.time_s,
            command: self.command,
            counts: self.counts,
            current_a: self.current_a,
            temperature_c: self.temperature_c.and_then(from_the_first),
            enabled: self.enabled,
            counts_per_rev: scale.counts_per_rev,
            quantised,
            supply_v: motor.supply_v,
            drive: motor.drive,
            position,
        }
    }

    /// Targets become the volts that the loop makes of them. The readings are as they came: the loop knows no other zero.
    fn followed(
        &mut self,
        settings: LoopSettings,
        motor: &MotorFile,
        scale: &Scale,
    ) -> Result<PositionDrive, ReadFault> {
        let called = || motor.called().to_owned();
        let limit = positive("limit_v", settings.limit_v.or(motor.supply_v))?;
        let limit = limit.ok_or_else(|| ReadFault::NoLimit { motor: called() })?;
        let target_counts = std::mem::take(&mut self.command);
        let follower = Follower {
            time_s: &self.time_s,
            target_counts: &target_counts,
            counts: &self.counts,
            enabled: self.enabled.as_deref(),
            counts_per_rev: scale.counts_per_rev,
        };
        let control = follower.control(&settings, limit);
        let control = control.map_err(|why| ReadFault::LoopGain {
            why,
            motor: called(),
        })?;
        self.command = follower.volts(&control);
        Ok(PositionDrive {
            control,
            target_counts,
        })
    }
}

/// A temperature with its first value in the place of those before it; none where there is no value at all.
fn from_the_first(mut temperature: Vec<f64>) -> Option<Vec<f64>> {
    let first = temperature.iter().copied().find(|x| !x.is_nan())?;
    let unknown = temperature.iter_mut().take_while(|x| x.is_nan());
    unknown.for_each(|x| *x = first);
    Some(temperature)
}

/// Pushes where memory allows it; a plain push would abort the program.
fn append<T>(values: &mut Vec<T>, value: T) -> Result<(), TryReserveError> {
    values.try_reserve(1)?;
    values.push(value);
    Ok(())
}
