//! A recording from columns of numbers in memory, by the same conversions and with the same refusals as one from a file.

use super::cell::converted;
use super::cells::Sample;
use super::collector::Collector;
use super::motor_file::MotorFile;
use super::place::{Cell, Place};
use super::read_error::{ReadError, ReadFault};
use super::samples::Further;
use super::scale::Scale;
use crate::channel::{Measured, PerMeasured};
use crate::recording::Recording;

/// Columns of equal length, in the units of the motor file.
#[derive(Clone, Copy, Debug)]
pub struct Arrays<'a> {
    /// Time.
    pub time: &'a [f64],
    /// Command.
    pub command: &'a [f64],
    /// Angle, or counts.
    pub angle: &'a [f64],
    /// Measured columns; NaN where one is not told.
    pub measured: &'a [(Measured, &'a [f64])],
    /// False while the bridge is open.
    pub enabled: Option<&'a [bool]>,
}

/// Reads a recording from arrays; `source` names it in errors, where sample 0 is the first line of its own.
///
/// # Errors
/// As [`read_recording_from`](super::read_recording_from); columns of different lengths.
pub fn recording_of(
    arrays: &Arrays<'_>,
    source: &str,
    motor: &MotorFile,
) -> Result<Recording, ReadError> {
    let whole = |fault| ReadError::new(Place::file(source), fault);
    let samples = arrays.time.len();
    let measured = arrays.measured.iter();
    let measured = measured.map(|(channel, values)| (channel.facts().key, values.len()));
    let enabled = arrays.enabled.map(|enabled| ("enabled", enabled.len()));
    let others = [
        ("command", arrays.command.len()),
        ("angle", arrays.angle.len()),
    ];
    for (column, length) in others.into_iter().chain(measured).chain(enabled) {
        if length != samples {
            return Err(whole(ReadFault::Uneven {
                column,
                length,
                samples,
            }));
        }
    }
    let further = Further {
        measured: arrays
            .measured
            .iter()
            .map(|(channel, _)| *channel)
            .collect(),
        enabled: arrays.enabled.is_some(),
    };
    let scale = Scale::new(motor, &further).map_err(whole)?;
    let mut collector = Collector::new(motor, &scale, false, further);
    for k in 0..samples {
        let convert =
            |number, name: &str, value: f64, to: &dyn Fn(f64) -> Result<f64, ReadFault>| {
                converted(value, to).map_err(|fault| {
                    let name = name.to_owned();
                    let cell = Cell { number, name };
                    ReadError::new(Place::cell(source, k as u64, &cell), fault)
                })
            };
        let stamp = convert(1, "time", arrays.time[k], &|x| {
            let stamp = scale.time(x);
            increasing(
                k.checked_sub(1)
                    .map(|before| scale.time(arrays.time[before])),
                stamp,
            )
        })?;
        let mut sample = Sample {
            time_s: collector.time(stamp, k as u64).map_err(whole)?,
            command: Some(convert(2, "command", arrays.command[k], &|x| {
                scale.command(x)
            })?),
            counts: Some(convert(3, "angle", arrays.angle[k], &|x| scale.counts(x))?),
            measured: PerMeasured::default(),
            enabled: arrays.enabled.map(|enabled| enabled[k]),
        };
        for (place, (channel, values)) in arrays.measured.iter().enumerate() {
            let told = Some(values[k]).filter(|value| !value.is_nan());
            let own = told.map(|value| {
                let to = |x: f64| Ok(scale.measured(*channel, x));
                convert(4 + place, channel.facts().key, value, &to)
            });
            sample.measured[*channel] = own.transpose()?;
        }
        if collector.wants(sample.time_s) {
            collector.take(&sample).map_err(whole)?;
        }
    }
    collector
        .finish(source)?
        .only(source)
        .map_err(whole)?
        .recordings
        .pop()
        .ok_or_else(|| whole(ReadFault::NoAngle))
}

/// Times in memory are those of one recording, row by row.
fn increasing(before: Option<f64>, now: f64) -> Result<f64, ReadFault> {
    match before {
        Some(before) if now < before => Err(ReadFault::TimeBack { before, now }),
        Some(before) if now == before => Err(ReadFault::TimeRepeats { now }),
        _ => Ok(now),
    }
}

#[cfg(test)]
mod tests {
    use super::super::motor_units::{AngleUnit, Units};
    use super::super::read_recording_from;
    use super::*;

    fn motor() -> MotorFile {
        MotorFile {
            counts_per_rev: Some(2048.0),
            ..MotorFile::default()
        }
    }

    const TIME: [f64; 4] = [0.0, 0.001, 0.002, 0.0031];
    const VOLTS: [f64; 4] = [1.0, 2.0, -1.5, 0.25];
    const COUNTS: [f64; 4] = [0.0, 3.0, 7.0, 5.0];

    fn arrays<'a>(angle: &'a [f64]) -> Arrays<'a> {
        Arrays {
            time: &TIME,
            command: &VOLTS,
            angle,
            measured: &[],
            enabled: None,
        }
    }

    #[test]
    fn arrays_are_read_as_the_file_with_the_same_numbers() {
        for (unit, name) in [
            (AngleUnit::Counts, "angle_counts"),
            (AngleUnit::Radians, "angle_rad"),
        ] {
            let motor = MotorFile {
                units: Units {
                    angle: unit,
                    ..Units::default()
                },
                ..motor()
            };
            let mut text = format!("t_s,voltage_v,{name}\n");
            for k in 0..TIME.len() {
                text += &format!("{},{},{}\n", TIME[k], VOLTS[k], COUNTS[k]);
            }
            let file = read_recording_from(text.as_bytes(), "one", &motor).expect("a file");
            let own = recording_of(&arrays(&COUNTS), "one", &motor).expect("arrays");
            assert_eq!(own, file);
        }
    }

    #[test]
    fn what_is_wrong_is_named_with_its_sample() {
        for (angle, wanted) in [
            (&[0.0, 3.0, f64::NAN, 5.0][..], "log:2:3: column `angle`"),
            (&[0.0, 3.0, f64::INFINITY, 5.0], "log:2:3: column `angle`"),
            (&[0.0, 3.5, 7.0, 5.0], "log:1:3: column `angle`"),
            (&[0.0, 3.0], "angle has 2 samples, time has 4"),
        ] {
            let error = recording_of(&arrays(angle), "log", &motor()).expect_err("refused");
            assert!(error.to_string().contains(wanted), "{error}");
        }
        let back = Arrays {
            time: &[0.0, 0.002, 0.001, 0.003],
            ..arrays(&COUNTS)
        };
        let error = recording_of(&back, "log", &motor()).expect_err("refused");
        assert!(
            error.to_string().starts_with("log:2:1: column `time`"),
            "{error}"
        );
    }
}
