//! A recording from columns of numbers in memory, by the same conversions and with the same refusals as one from a file.

use super::cell::checked;
use super::motor_file::MotorFile;
use super::place::{Cell, Place};
use super::read_error::{ReadError, ReadFault};
use super::sample::{Sample, increasing};
use super::samples::{Further, Samples};
use super::scale::Scale;
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
    /// Armature current.
    pub current: Option<&'a [f64]>,
    /// Temperature of the motor; NaN where it is not told.
    pub temperature: Option<&'a [f64]>,
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
    let others = [
        ("command", Some(arrays.command.len())),
        ("angle", Some(arrays.angle.len())),
        ("current", arrays.current.map(<[f64]>::len)),
        ("temperature", arrays.temperature.map(<[f64]>::len)),
        ("enabled", arrays.enabled.map(<[bool]>::len)),
    ];
    for (column, length) in others {
        if let Some(length) = length.filter(|length| *length != samples) {
            return Err(whole(ReadFault::Uneven {
                column,
                length,
                samples,
            }));
        }
    }
    let scale = Scale::new(motor).map_err(whole)?;
    let mut kept = Samples::new(Further {
        current: arrays.current.is_some(),
        temperature: arrays.temperature.is_some(),
        enabled: arrays.enabled.is_some(),
    });
    for k in 0..samples {
        let at = |number, name: &str, fault| {
            let cell = Cell {
                number,
                name: name.to_owned(),
            };
            ReadError::new(Place::cell(source, k as u64, &cell), fault)
        };
        let convert =
            |column, name: &str, value: f64, to: &dyn Fn(f64) -> Result<f64, ReadFault>| {
                checked(value)
                    .and_then(to)
                    .and_then(checked)
                    .map_err(|fault| at(column, name, fault))
            };
        let before = kept.last_time();
        let sample = Sample {
            time_s: convert(1, "time", arrays.time[k], &|x| {
                increasing(before, scale.time(x)?)
            })?,
            command: convert(2, "command", arrays.command[k], &|x| scale.command(x))?,
            counts: convert(3, "angle", arrays.angle[k], &|x| scale.counts(x))?,
            current_a: (arrays.current)
                .map(|current| convert(4, "current", current[k], &|x| scale.current(x)))
                .transpose()?,
            temperature_c: (arrays.temperature)
                .map(|temperature| temperature[k])
                .filter(|x| !x.is_nan())
                .map(|x| convert(5, "temperature", x, &|x| scale.temperature(x)))
                .transpose()?,
            enabled: arrays.enabled.map(|enabled| enabled[k]),
        };
        kept.push(&sample).map_err(whole)?;
    }
    kept.finish(source, motor, &scale).map_err(whole)
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
            current: None,
            temperature: None,
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
