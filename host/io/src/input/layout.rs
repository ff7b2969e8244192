//! Which column of the file is what: the contract's names, or those of `[columns]`.

use super::finder::{Finder, Wanted};
use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
use super::place::{Cell, Place};
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::shown::shown;

/// The columns of one file.
pub(super) struct Layout {
    /// Cells in every row.
    pub(super) width: usize,
    pub(super) time: Column,
    pub(super) command: Column,
    pub(super) angle: Column,
    pub(super) current: Option<Column>,
    pub(super) enabled: Option<Column>,
}

/// One column: its index from zero and its cell for messages.
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) cell: Cell,
}

impl Layout {
    /// Finds every column in the header, which is the row just split.
    ///
    /// # Errors
    /// A header of numbers, columns that are missing (all in one message), or a name that stands twice.
    pub(super) fn find(
        row: &Row,
        source: &str,
        line: u64,
        motor: &MotorFile,
    ) -> Result<Self, ReadError> {
        let at = |fault| ReadError::new(Place::line(source, line), fault);
        let header = header_names(row).map_err(at)?;
        let finder = Finder {
            header: &header,
            source,
            line,
        };
        let wanted = wanted(motor);
        let mut found = Vec::with_capacity(wanted.len());
        for column in &wanted {
            found.push(finder.find(column)?);
        }
        let mut taken: Vec<String> = found
            .iter()
            .flatten()
            .map(|column| column.cell.name.clone())
            .collect();
        let mut missing = Vec::new();
        for (k, column) in wanted.iter().enumerate() {
            if found[k].is_none() && (k < REQUIRED || column.mapped.is_some()) {
                missing.push(finder.miss(column, &mut taken));
            }
        }
        let found: Result<[Option<Column>; 5], _> = found.try_into();
        match found {
            Ok([Some(time), Some(command), Some(angle), current, enabled])
                if missing.is_empty() =>
            {
                Ok(Layout {
                    width: row.len(),
                    time,
                    command,
                    angle,
                    current,
                    enabled,
                })
            }
            _ => {
                let motor = motor.called().into();
                Err(at(ReadFault::MissingColumns {
                    missing,
                    header,
                    motor,
                }))
            }
        }
    }
}

/// How many of the columns wanted, the first ones, must be there.
const REQUIRED: usize = 3;

/// Time, command, angle, current, enabled.
fn wanted(motor: &MotorFile) -> [Wanted<'_>; 5] {
    let (columns, units) = (&motor.columns, &motor.units);
    [
        Wanted {
            key: "time",
            mapped: columns.time.as_deref(),
            names: units.time.default_names(),
            aliases: &["t", "time", "timestamp", "seconds"],
        },
        Wanted {
            key: motor.drive_kind().command_key(),
            mapped: columns.voltage.as_deref(),
            names: match motor.drive_kind() {
                DriveKind::Position => units.of_target().target_names(),
                _ => units.voltage.default_names(),
            },
            aliases: command_aliases(motor.drive_kind()),
        },
        Wanted {
            key: "angle",
            mapped: columns.angle.as_deref(),
            names: units.angle.default_names(),
            aliases: &[
                "angle", "position", "counts", "encoder", "ticks", "theta", "q",
            ],
        },
        Wanted {
            key: "current",
            mapped: columns.current.as_deref(),
            names: units.current.default_names(),
            aliases: &["current", "i"],
        },
        Wanted {
            key: "enabled",
            mapped: columns.enabled.as_deref(),
            names: &["enabled"],
            aliases: &["enable", "torque_enabled"],
        },
    ]
}

fn command_aliases(kind: DriveKind) -> &'static [&'static str] {
    match kind {
        DriveKind::Voltage => &["voltage", "u", "v", "volts", "command", "pwm"],
        DriveKind::Current => &[
            "current",
            "current_a",
            "torque",
            "command",
            "i",
            "voltage",
            "u",
        ],
        DriveKind::Position => &[
            "target",
            "goal",
            "target_position",
            "goal_position",
            "setpoint",
            "reference",
            "command",
            "goal_rad",
            "goal_deg",
            "action",
        ],
    }
}

/// The names of the header, refused where they are numbers or no text.
fn header_names(row: &Row) -> Result<Vec<String>, ReadFault> {
    let mut names = Vec::with_capacity(row.len());
    for index in 0..row.len() {
        names.push(row.cell(index)?.to_string());
    }
    if names.iter().any(|name| name.contains('\0')) {
        return Err(ReadFault::NotText);
    }
    if names.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(ReadFault::NoHeader {
            first: shown(&names.join(", ")),
        });
    }
    Ok(names)
}
