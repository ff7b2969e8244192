//! Which column of the file is what: the contract's names, or those of `[columns]`.

use super::finder::{Finder, Wanted};
use super::guess::{Sought, guess};
use super::log_part::Selection;
use super::missing::MissingColumn;
use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
use super::place::{Cell, Place};
use super::preset::Preset;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::samples::Further;
use super::shown::shown;

/// The columns of one file.
pub(super) struct Layout {
    /// Cells in every row.
    pub(super) width: usize,
    /// None where the rate of the samples is told in place of their times.
    pub(super) time: Option<Column>,
    pub(super) command: Column,
    pub(super) angle: Column,
    pub(super) current: Option<Column>,
    pub(super) temperature: Option<Column>,
    pub(super) enabled: Option<Column>,
    pub(super) direction: Option<Column>,
    /// The columns by which rows are selected, each with the value.
    pub(super) select: Vec<(Column, Selection)>,
}

/// One column: its index from zero and its cell for messages.
pub(super) struct Column {
    pub(super) index: usize,
    pub(super) cell: Cell,
}

impl Layout {
    /// Finds every column among the names of the table at `line`.
    ///
    /// # Errors
    /// A header of numbers, columns that are missing (all in one message), or a name that stands twice.
    pub(super) fn find(
        header: Vec<String>,
        source: &str,
        line: Option<u64>,
        motor: &MotorFile,
    ) -> Result<Self, ReadError> {
        let place = Place {
            line,
            ..Place::file(source)
        };
        let at = |fault| ReadError::new(place.clone(), fault);
        let width = header.len();
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
        let needed = |k: usize| k < REQUIRED && !(k == 0 && motor.log.rate_hz.is_some());
        let is_missing = |k: usize| found[k].is_none() && (needed(k) || wanted[k].mapped.is_some());
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
        let mut select = Vec::new();
        for selection in &motor.log.select {
            let column = finder.named(&selection.column)?;
            select.push((column, selection.clone()));
        }
        let found: Result<[Option<Column>; 7], _> = found.try_into();
        match found {
            Ok(
                [
                    time,
                    Some(command),
                    Some(angle),
                    current,
                    temperature,
                    enabled,
                    direction,
                ],
            ) if missing.is_empty() => Ok(Layout {
                width,
                time,
                command,
                angle,
                current,
                temperature,
                enabled,
                direction,
                select,
            }),
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

impl Layout {
    /// Which columns there are beside those that every recording has.
    pub(super) fn further(&self) -> Further {
        Further {
            current: self.current.is_some(),
            temperature: self.temperature.is_some(),
            enabled: self.enabled.is_some(),
        }
    }
}

/// How many of the columns wanted, the first ones, must be there.
const REQUIRED: usize = 3;

/// Time, command, angle, current, temperature, enabled, direction: under the user's names, the preset's, or the contract's.
fn wanted(motor: &MotorFile) -> [Wanted<'_>; 7] {
    let (columns, units, preset) = (&motor.columns, &motor.units, motor.log.preset);
    let names = |of: fn(&'static Preset) -> &'static [&'static str], usual| {
        preset
            .map(of)
            .filter(|names| !names.is_empty())
            .unwrap_or(usual)
    };
    let command = match motor.drive_kind() {
        DriveKind::Position => units.of_target().target_names(),
        _ => units.voltage.default_names(),
    };
    [
        Wanted {
            key: "time",
            mapped: columns.time.as_deref(),
            names: names(|preset| preset.time.names, units.time.default_names()),
        },
        Wanted {
            key: motor.drive_kind().command_key(),
            mapped: columns.voltage.as_deref(),
            names: names(|preset| preset.command.names, command),
        },
        Wanted {
            key: "angle",
            mapped: columns.angle.as_deref(),
            names: names(|preset| preset.angle.names, units.angle.default_names()),
        },
        Wanted {
            key: "current",
            mapped: columns.current.as_deref(),
            names: names(|preset| preset.current.names, units.current.default_names()),
        },
        Wanted {
            key: "temperature",
            mapped: columns.temperature.as_deref(),
            names: names(
                |preset| preset.temperature,
                units.temperature.default_names(),
            ),
        },
        Wanted {
            key: "enabled",
            mapped: columns.enabled.as_deref(),
            names: names(|preset| preset.enabled, &["enabled"]),
        },
        Wanted {
            key: "direction",
            mapped: columns.direction.as_deref(),
            names: &[],
        },
    ]
}

/// The names in a row, refused where they are numbers or no text.
pub(super) fn header_names(row: &Row) -> Result<Vec<String>, ReadFault> {
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
