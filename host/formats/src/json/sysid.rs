//! Files of WPILib's SysId up to 2023, and of its predecessor frc-characterization.
//!
//! A test is a list of rows. SysId writes rows of 4 values for a mechanism with one motor and of
//! 9 for a drivetrain; frc-characterization wrote 10 for all. Positions are in rotations:
//! `unitsPerRotation` turns them into the unit that the file names. (SysId of 2024 and later reads
//! WPILOG.)

use super::frame::Frame;
use super::node::Node;
use crate::log::{Column, Kind};

/// Names of tests, older and newer.
const TESTS: [&str; 10] = [
    "slow-forward",
    "slow-backward",
    "fast-forward",
    "fast-backward",
    "quasistatic-forward",
    "quasistatic-reverse",
    "quasistatic-backward",
    "dynamic-forward",
    "dynamic-reverse",
    "dynamic-backward",
];
const MECHANISM: [&str; 4] = ["time", "voltage", "position", "velocity"];
const DRIVETRAIN: [&str; 9] = [
    "time",
    "left_voltage",
    "right_voltage",
    "left_position",
    "right_position",
    "left_velocity",
    "right_velocity",
    "angle",
    "angular_rate",
];
const CHARACTERIZATION: [&str; 10] = [
    "time",
    "battery_voltage",
    "autospeed",
    "left_voltage",
    "right_voltage",
    "left_position",
    "right_position",
    "left_velocity",
    "right_velocity",
    "gyro",
];

/// The units of a file of SysId.
#[derive(Clone, Debug)]
pub(crate) struct SysId {
    /// What a rotation is, for people.
    rotation: String,
    is_drivetrain: bool,
}

impl SysId {
    /// Whether a document is one of SysId.
    pub(crate) fn of(document: &Node) -> Option<Self> {
        let per_rotation = document.get("unitsPerRotation");
        let is_marked = document.get("sysid").is_some() || per_rotation.is_some();
        let has_tests = TESTS.iter().any(|test| document.get(test).is_some());
        if !is_marked || !has_tests {
            return None;
        }
        let text = |key| document.get(key).and_then(Node::text);
        let rotation = match (per_rotation.and_then(Node::text), text("units")) {
            (Some(count), Some(unit)) => format!(" (1 rotation = {count} {unit})"),
            _ => String::new(),
        };
        let is_drivetrain = text("test").is_some_and(|test| test.starts_with("Drive"));
        Some(SysId {
            rotation,
            is_drivetrain,
        })
    }

    /// The columns of the member `name`, if that is a test.
    pub(crate) fn columns(&self, name: &str, frame: &Frame) -> Option<Vec<Column>> {
        let names: &[&'static str] = match frame.schema.len() {
            4 => &MECHANISM,
            9 => &DRIVETRAIN,
            10 => &CHARACTERIZATION,
            _ => return None,
        };
        if !TESTS.contains(&name) || frame.width().is_none() {
            return None;
        }
        // A mechanism with one motor is on the left.
        let label = |name: &'static str| match name.strip_prefix("left_") {
            Some(name) if !self.is_drivetrain => name,
            _ => name,
        };
        let columns = names.iter().map(|name| self.column(label(name)));
        Some(columns.collect())
    }

    fn column(&self, name: &str) -> Column {
        let unit = match name.rsplit('_').next() {
            Some("time") => Some("s".to_owned()),
            Some("voltage") => Some("V".to_owned()),
            Some("position") => Some(format!("rotations{}", self.rotation)),
            Some("velocity") => Some(format!("rotations/s{}", self.rotation)),
            _ => None,
        };
        let kind = match name {
            "time" => Kind::Time,
            _ => Kind::Number,
        };
        Column {
            name: name.to_owned(),
            kind,
            unit,
        }
    }
}
