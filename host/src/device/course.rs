//! Where a servo is to go, and when.

use super::DeviceError;
use servoid_io::columns::{Columns, ColumnsError, columns};
use shared::wire::{About, SetPoint};
use std::f64::consts::TAU;
use std::path::Path;

/// Set-points in SI over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Course {
    /// Each with the time at which it begins to hold, s; times rise.
    points: Vec<(f64, Aim)>,
    /// When the last one ceases to hold, s.
    ends_s: f64,
}

/// A set-point in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aim {
    /// rad from where the run begins.
    Angle(f64),
    /// rad/s.
    Speed(f64),
}

const USUAL: &str = "a course has t_s and either angle_rad or speed_rad_s";

impl Course {
    /// One set-point, for so many seconds.
    pub fn of(aim: Aim, seconds: f64) -> Self {
        Course {
            points: vec![(0.0, aim)],
            ends_s: seconds,
        }
    }

    /// Reads a table of set-points, of which each holds until the next and the last one for so many seconds.
    ///
    /// # Errors
    /// A file that cannot be read or is no such table, with file and line.
    pub fn read(path: &Path, last_s: f64) -> Result<Self, ColumnsError> {
        let wrong = |why: &str| ColumnsError::of(path, why.to_owned());
        let Columns {
            time_s: times,
            named: [angle, speed],
        } = columns(path, ["angle_rad", "speed_rad_s"], USUAL)?;
        let aims: Vec<Aim> = match (angle, speed) {
            (Some(angles), None) => angles.into_iter().map(Aim::Angle).collect(),
            (None, Some(speeds)) => speeds.into_iter().map(Aim::Speed).collect(),
            _ => return Err(wrong(USUAL)),
        };
        let Some((first, last)) = times.first().copied().zip(times.last().copied()) else {
            return Err(wrong("has no rows"));
        };
        let from_start = times.iter().map(|time| time - first);
        Ok(Course {
            points: from_start.zip(aims).collect(),
            ends_s: last - first + last_s,
        })
    }

    /// How long it takes, s.
    pub fn seconds(&self) -> f64 {
        self.ends_s
    }

    /// The last set-point, and when it begins to hold, s.
    pub fn last(&self) -> Option<(f64, Aim)> {
        self.points.last().copied()
    }

    /// The set-points for a device, each with the period from which it holds; at the end it is to rest.
    ///
    /// # Errors
    /// A set-point beyond the device's numbers.
    pub fn set_points(
        &self,
        about: &About,
        counts_per_rev: f64,
    ) -> Result<Vec<(u32, SetPoint)>, DeviceError> {
        let period_s = f64::from(about.period_us) * 1e-6;
        let per_rad = counts_per_rev / TAU;
        let number = |what: String, number: f64| {
            let number = number.round();
            if number.abs() < f64::from(i32::MAX) {
                Ok(number as i32)
            } else {
                Err(DeviceError::Order(format!("{what}: beyond the device")))
            }
        };
        let mut all = Vec::new();
        for (time, aim) in &self.points {
            let set_point = match *aim {
                Aim::Angle(rad) => SetPoint::Position(number(format!("{rad} rad"), rad * per_rad)?),
                Aim::Speed(speed) => SetPoint::Speed(number(
                    format!("{speed} rad/s"),
                    speed * per_rad * period_s * 65_536.0,
                )?),
            };
            all.push(((time / period_s).round() as u32, set_point));
        }
        all.push(((self.ends_s / period_s).round() as u32, SetPoint::End));
        Ok(all)
    }
}
