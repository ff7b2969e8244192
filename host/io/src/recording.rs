//! A recording in memory: what was commanded, what the encoder read, and when.

use crate::channel::Series;
use crate::position_loop::PositionLoop;

/// What the command column drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drive {
    /// A voltage on the armature.
    Voltage,
    /// A current: the amplifier closes a current loop, so that no back-EMF is seen.
    Current,
    /// A torque, which such an amplifier makes of a current.
    Torque,
}

/// Units of a model in terms of its command: of a voltage, of a current, of a torque.
const UNITS: &[[&str; 3]] = &[
    ["V", "A", "N*m"],
    ["V*s/rad", "A*s/rad", "N*m*s/rad"],
    ["V*s^2/rad", "A*s^2/rad", "kg*m^2"],
    ["V*s^2/rad^2", "A*s^2/rad^2", "N*m*s^2/rad^2"],
    ["V/rad", "A/rad", "N*m/rad"],
    ["V*s", "A*s", "N*m*s"],
    ["V*sqrt(s)", "A*sqrt(s)", "N*m*sqrt(s)"],
    ["1/V", "1/A", "1/(N*m)"],
    ["1/V^2", "1/A^2", "1/(N*m)^2"],
    ["1/(V^2*s)", "1/(A^2*s)", "1/(N^2*m^2*s)"],
    ["rad/(s*V)", "rad/(s*A)", "rad/(s*N*m)"],
    ["rad/s/V", "rad/s/A", "rad/s/(N*m)"],
];

impl Drive {
    /// Its name in files.
    pub fn name(self) -> &'static str {
        match self {
            Drive::Voltage => "voltage",
            Drive::Current => "current",
            Drive::Torque => "torque",
        }
    }

    /// All of them.
    pub const ALL: [Drive; 3] = [Drive::Voltage, Drive::Current, Drive::Torque];

    /// The one of a name in files.
    pub fn by_name(name: &str) -> Option<Self> {
        Drive::ALL.into_iter().find(|drive| drive.name() == name)
    }

    /// Whether the command is a voltage on the winding, so that back-EMF is seen.
    pub fn is_voltage(self) -> bool {
        self == Drive::Voltage
    }

    /// The unit of the command.
    pub fn symbol(self) -> &'static str {
        self.unit("V")
    }

    /// A unit of the model, which counts in volts whatever the command is, in terms of the command.
    pub fn unit(self, volts: &'static str) -> &'static str {
        let named = UNITS.iter().find(|units| units[0] == volts);
        named.map_or(volts, |units| units[self as usize])
    }

    /// The same the other way about. A unit that holds nothing of the command stays as it is.
    pub fn volts_unit(self, unit: &str) -> &str {
        let own = UNITS.iter().find(|units| units[self as usize] == unit);
        own.map_or(unit, |units| units[0])
    }
}

/// Where the command is from, if a drive made it of target angles.
#[derive(Clone, Debug, PartialEq)]
pub struct PositionDrive {
    /// The loop that made volts of them.
    pub control: PositionLoop,
    /// Target from its own row until the next, counts, from the same zero as the angle in the file.
    pub target_counts: Vec<f64>,
}

/// One recording, in SI units and encoder counts, checked on entry: all columns have equal length,
/// every number is finite and time increases.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Where it came from, for messages.
    pub source: String,
    /// Time of each sample, s; strictly increasing.
    pub time_s: Vec<f64>,
    /// Command in V (A or N·m, see [`Drive`]), held from its own row until the next.
    pub command: Vec<f64>,
    /// Encoder reading in counts, cumulative. Whole numbers if [`quantised`](Self::quantised).
    pub counts: Vec<f64>,
    /// What was measured beside the angle.
    pub measured: Series,
    /// False while the bridge is open: no current flows and the motor coasts.
    pub enabled: Option<Vec<bool>>,
    /// Encoder counts per revolution.
    pub counts_per_rev: f64,
    /// Whether `counts` are whole encoder counts (floored), rather than an angle from elsewhere.
    pub quantised: bool,
    /// Supply voltage, V, when the user stated it.
    pub supply_v: Option<f64>,
    /// What the command drives.
    pub drive: Drive,
    /// The position loop that made the command, where the log holds targets.
    pub position: Option<PositionDrive>,
}

impl Recording {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there is no sample at all.
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Time from the first sample to the last, s.
    pub fn duration_s(&self) -> f64 {
        match (self.time_s.first(), self.time_s.last()) {
            (Some(first), Some(last)) => last - first,
            _ => 0.0,
        }
    }

    /// Median time between samples, s; zero for fewer than two. Of an even number the upper of the middle two.
    pub fn median_interval_s(&self) -> f64 {
        crate::median::median_interval(&self.time_s)
    }

    /// The samples before `seconds` after the first, and the rest; `None` where either would have fewer than
    /// two. To fit one part and hold out the other.
    pub fn split_at(&self, seconds: f64) -> Option<(Recording, Recording)> {
        let start = *self.time_s.first()?;
        let cut = self.time_s.partition_point(|time| time - start < seconds);
        if cut < 2 || self.len() - cut < 2 {
            return None;
        }
        let before = self.rows(0..cut, format!("{} (first {seconds} s)", self.source));
        let after = self.rows(
            cut..self.len(),
            format!("{} (after {seconds} s)", self.source),
        );
        Some((before, after))
    }

    /// The samples from `from` to `to`, s after the first one; `None` where there are fewer than two.
    pub fn between(&self, from: f64, to: f64) -> Option<Recording> {
        let start = *self.time_s.first()?;
        let at = |seconds: f64| self.time_s.partition_point(|time| time - start < seconds);
        let (from, to) = (at(from), at(to));
        (to >= from + 2).then(|| self.rows(from..to, self.source.clone()))
    }

    /// Whether it holds the same samples as `other`: then it tells nothing that the other does not.
    pub fn is_copy_of(&self, other: &Recording) -> bool {
        self.counts == other.counts && self.command == other.command
    }

    /// Adds so many counts to each reading, which need not be whole: then angles are counted from elsewhere.
    pub fn turn(&mut self, counts: f64) {
        for count in &mut self.counts {
            *count += counts;
        }
    }

    /// Some of the samples.
    pub fn samples(&self, samples: std::ops::Range<usize>) -> Recording {
        self.rows(samples, self.source.clone())
    }

    fn rows(&self, rows: std::ops::Range<usize>, source: String) -> Recording {
        Recording {
            source,
            time_s: self.time_s[rows.clone()].to_vec(),
            command: self.command[rows.clone()].to_vec(),
            counts: self.counts[rows.clone()].to_vec(),
            measured: self.measured.rows(rows.clone()),
            enabled: self
                .enabled
                .as_ref()
                .map(|enabled| enabled[rows.clone()].to_vec()),
            position: self.position.as_ref().map(|position| PositionDrive {
                control: position.control,
                target_counts: position.target_counts[rows].to_vec(),
            }),
            ..*self
        }
    }
}
