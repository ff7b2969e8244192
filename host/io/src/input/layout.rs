//! Which column of the file is what: the contract's names, or those of `[columns]`.

use super::finder::{Finder, Wanted};
use super::guess::{Sought, guess};
use super::missing::MissingColumn;
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
        let is_missing =
            |k: usize| found[k].is_none() && (k < REQUIRED || wanted[k].mapped.is_some());
        let absent: Vec<usize> = (0..wanted.len()).filter(|k| is_missing(*k)).collect();
        let taken: Vec<String> = found
            .iter()
            .flatten()
            .map(|column| column.cell.name.clone())
            .collect();
        let sought = absent.iter().map(|k| Sought {
            key: wanted[*k].key,
            called: wanted[*k].mapped,
        });
        let sought: Vec<Sought<'_>> = sought.collect();
        let near = guess(&header, &sought, motor.drive_kind(), &taken);
        let missing: Vec<MissingColumn> = absent
            .iter()
            .zip(near)
            .map(|(k, near)| MissingColumn {
                key: wanted[*k].key,
                wanted: wanted[*k].mapped.unwrap_or(wanted[*k].names[0]).into(),
                mapped: wanted[*k].mapped.is_some(),
                near,
            })
            .collect();
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
        },
        Wanted {
            key: motor.drive_kind().command_key(),
            mapped: columns.voltage.as_deref(),
            names: match motor.drive_kind() {
                DriveKind::Position => units.of_target().target_names(),
                _ => units.voltage.default_names(),
            },
        },
        Wanted {
            key: "angle",
            mapped: columns.angle.as_deref(),
            names: units.angle.default_names(),
        },
        Wanted {
            key: "current",
            mapped: columns.current.as_deref(),
            names: units.current.default_names(),
        },
        Wanted {
            key: "enabled",
            mapped: columns.enabled.as_deref(),
            names: &["enabled"],
        },
    ]
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
