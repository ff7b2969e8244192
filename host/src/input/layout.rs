//! Which column of the file is what: the contract's names, or those of `[columns]`.

use super::motor_file::MotorFile;
use super::place::{Cell, Place};
use super::read_error::{MissingColumn, ReadError, ReadFault};
use super::row::Row;
use super::suggest::{nearest, shown};

/// The columns of one file.
pub(super) struct Layout {
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

/// What to look for.
struct Wanted<'m> {
    key: &'static str,
    mapped: Option<&'m str>,
    names: &'static [&'static str],
    /// What other people call it, for suggestions only.
    aliases: &'static [&'static str],
}

/// Endings of a name that tell its unit.
const ANGLE_ENDINGS: &[(&str, &str)] = &[
    ("_rad", "rad"),
    ("_deg", "deg"),
    ("_degrees", "deg"),
    ("_rev", "rev"),
    ("_turns", "rev"),
    ("_m", "m"),
];
const TIME_ENDINGS: &[(&str, &str)] = &[("_ms", "ms"), ("_us", "us")];

impl Layout {
    /// Finds every column in the header, which is the row just split.
    pub(super) fn find(
        row: &Row,
        source: &str,
        line: u64,
        motor: &MotorFile,
    ) -> Result<Self, ReadError> {
        let at = |fault| ReadError::new(Place::line(source, line), fault);
        let header = header_names(row).map_err(at)?;
        let columns = &motor.columns;
        let mut finder = Finder {
            header: &header,
            missing: Vec::new(),
            source,
            line,
        };
        let time = finder.required(&Wanted {
            key: "time",
            mapped: columns.time.as_deref(),
            names: motor.units.time.default_names(),
            aliases: &["t", "time", "time_s", "timestamp", "seconds"],
        })?;
        let command = finder.required(&Wanted {
            key: "voltage",
            mapped: columns.voltage.as_deref(),
            names: motor.units.voltage.default_names(),
            aliases: command_aliases(motor),
        })?;
        let angle = finder.required(&Wanted {
            key: "angle",
            mapped: columns.angle.as_deref(),
            names: motor.units.angle.default_names(),
            aliases: &[
                "angle", "position", "counts", "encoder", "ticks", "theta", "q",
            ],
        })?;
        let current = finder.optional(&Wanted {
            key: "current",
            mapped: columns.current.as_deref(),
            names: motor.units.current.default_names(),
            aliases: &["current", "i"],
        })?;
        let enabled = finder.optional(&Wanted {
            key: "enabled",
            mapped: columns.enabled.as_deref(),
            names: &["enabled"],
            aliases: &["enable", "torque_enabled"],
        })?;
        let missing = finder.missing;
        match (time, command, angle) {
            (Some(time), Some(command), Some(angle)) if missing.is_empty() => Ok(Layout {
                width: row.len(),
                time,
                command,
                angle,
                current,
                enabled,
            }),
            _ => Err(at(ReadFault::MissingColumns {
                missing,
                header,
                motor: motor.called().into(),
            })),
        }
    }
}

fn command_aliases(motor: &MotorFile) -> &'static [&'static str] {
    match motor.drive {
        crate::recording::Drive::Voltage => &["voltage", "u", "v", "volts", "command", "pwm"],
        crate::recording::Drive::Current => &[
            "current",
            "current_a",
            "torque",
            "command",
            "voltage",
            "i",
            "u",
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

/// Looks names up in the header and keeps what is missing, so that one message can name it all.
struct Finder<'h> {
    header: &'h [String],
    missing: Vec<MissingColumn>,
    source: &'h str,
    line: u64,
}

impl Finder<'_> {
    fn required(&mut self, wanted: &Wanted<'_>) -> Result<Option<Column>, ReadError> {
        let found = self.look_up(wanted)?;
        if found.is_none() {
            self.miss(wanted);
        }
        Ok(found)
    }

    /// Missed only if the user named it.
    fn optional(&mut self, wanted: &Wanted<'_>) -> Result<Option<Column>, ReadError> {
        if wanted.mapped.is_some() {
            self.required(wanted)
        } else {
            self.look_up(wanted)
        }
    }

    fn look_up(&self, wanted: &Wanted<'_>) -> Result<Option<Column>, ReadError> {
        let mapped = wanted.mapped.as_slice();
        let names = if mapped.is_empty() {
            wanted.names
        } else {
            mapped
        };
        for name in names {
            // `voltage_V` is `voltage_v` unless the file has both.
            let exact = self.matches(|header| header == *name);
            let found = if exact.is_empty() {
                self.matches(|header| header.eq_ignore_ascii_case(name))
            } else {
                exact
            };
            if let [first, rest @ ..] = found.as_slice() {
                let column = self.column(*first);
                if !rest.is_empty() {
                    let place = Place::cell(self.source, self.line, &column.cell);
                    let fault = ReadFault::RepeatedColumn { times: found.len() };
                    return Err(ReadError::new(place, fault));
                }
                return Ok(Some(column));
            }
        }
        Ok(None)
    }

    fn matches(&self, test: impl Fn(&str) -> bool) -> Vec<usize> {
        (0..self.header.len())
            .filter(|index| test(&self.header[*index]))
            .collect()
    }

    fn column(&self, index: usize) -> Column {
        Column {
            index,
            cell: Cell {
                number: index + 1,
                name: self.header[index].clone(),
            },
        }
    }

    fn miss(&mut self, wanted: &Wanted<'_>) {
        let name = wanted.mapped.unwrap_or(wanted.names[0]);
        let header = || {
            self.header
                .iter()
                .map(String::as_str)
                .filter(|name| !name.is_empty())
        };
        let near = nearest(name, header()).or_else(|| {
            let alias = |name: &&str| {
                wanted
                    .aliases
                    .iter()
                    .any(|alias| alias.eq_ignore_ascii_case(name))
            };
            header().find(alias).or_else(|| {
                wanted
                    .aliases
                    .iter()
                    .find_map(|alias| nearest(alias, header()))
            })
        });
        let near = near.map(|near| (near.to_string(), unit_told_by(near, wanted.key)));
        self.missing.push(MissingColumn {
            key: wanted.key,
            wanted: name.into(),
            mapped: wanted.mapped.is_some(),
            near,
        });
    }
}

fn unit_told_by(name: &str, key: &str) -> Option<&'static str> {
    let endings = match key {
        "angle" => ANGLE_ENDINGS,
        "time" => TIME_ENDINGS,
        _ => &[],
    };
    let name = name.to_ascii_lowercase();
    endings
        .iter()
        .find(|(ending, _)| name.ends_with(ending))
        .map(|(_, unit)| *unit)
}
