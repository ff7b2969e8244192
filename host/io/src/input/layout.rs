//! Which column of the file is what: the contract's names, or those of `[columns]`.

use super::finder::{Finder, Wanted};
use super::log_part::Selection;
use super::missing::MissingColumn;
use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
use super::place::{Cell, Place};
use super::quantity::most_like;
use super::read_error::{ReadError, ReadFault};
use super::row::Row;
use super::samples::Further;
use super::shown::shown;
use super::suggest::nearest;
use crate::channel::{Channel, Measured};

/// The columns of one file.
pub(super) struct Layout {
    /// None where the rate of the samples is told in place of their times.
    pub(super) time: Option<Column>,
    pub(super) command: Column,
    pub(super) angle: Column,
    pub(super) measured: Vec<(Measured, Column)>,
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
        let needed = |wanted: &Wanted<'_>| match wanted.channel {
            Channel::Time => motor.log.rate_hz.is_none(),
            Channel::Command | Channel::Angle => true,
            _ => wanted.mapped.is_some(),
        };
        let is_missing = |k: usize| {
            let is_named = wanted[k].mapped.is_some();
            found[k].is_none() && (needed(&wanted[k]) || is_named)
        };
        let absent: Vec<usize> = (0..wanted.len()).filter(|k| is_missing(*k)).collect();
        let taken: Vec<&str> = (found.iter().flatten())
            .map(|column| column.cell.name.as_str())
            .collect();
        let mut free: Vec<&str> = header.iter().map(String::as_str).collect();
        free.retain(|name| !name.is_empty() && !taken.contains(name));
        let kind = motor.drive_kind();
        let mut missing = Vec::with_capacity(absent.len());
        for k in absent {
            let Wanted {
                channel, mapped, ..
            } = wanted[k];
            let sought = mapped.unwrap_or(wanted[k].names[0]);
            let spelt = nearest(sought, free.iter().copied());
            let near = spelt.or_else(|| most_like(&free, channel, kind));
            free.retain(|name| Some(*name) != near);
            missing.push(MissingColumn {
                key: kind.key(channel),
                wanted: sought.into(),
                mapped: mapped.is_some(),
                near: near.map(str::to_owned),
            });
        }
        let mut select = Vec::new();
        for selection in &motor.log.select {
            let column = finder.named(&selection.column)?;
            select.push((column, selection.clone()));
        }
        if !missing.is_empty() {
            let motor = motor.called().into();
            return Err(at(ReadFault::MissingColumns {
                missing,
                header,
                motor,
                advice: None,
            }));
        }
        let mut take = |channel: Channel| {
            let place = wanted.iter().position(|wanted| wanted.channel == channel)?;
            found[place].take()
        };
        let (time, enabled) = (take(Channel::Time), take(Channel::Enabled));
        let (Some(command), Some(angle)) = (take(Channel::Command), take(Channel::Angle)) else {
            return Err(at(ReadFault::Empty));
        };
        let direction = take(Channel::Direction);
        let measured = Measured::ALL.into_iter();
        let measured = measured.filter_map(|own| Some((own, take(Channel::Measured(own))?)));
        Ok(Layout {
            time,
            command,
            angle,
            measured: measured.collect(),
            enabled,
            direction,
            select,
        })
    }
}

impl Layout {
    /// Which columns there are beside those that every recording has.
    pub(super) fn further(&self) -> Further {
        let measured = self.measured.iter().map(|(channel, _)| *channel).collect();
        Further {
            measured,
            enabled: self.enabled.is_some(),
        }
    }

    /// Every column that is read, one that is asked for twice as often.
    #[cfg(feature = "formats")]
    pub(super) fn columns(&self) -> impl Iterator<Item = &Column> {
        let one = [Some(&self.command), Some(&self.angle)];
        let others = [
            self.time.as_ref(),
            self.enabled.as_ref(),
            self.direction.as_ref(),
        ];
        let measured = self.measured.iter().map(|(_, column)| column);
        let select = self.select.iter().map(|(column, _)| column);
        let named = one.into_iter().chain(others).flatten();
        named.chain(measured).chain(select)
    }
}

/// Every channel, under the user's names, the preset's, or the contract's.
fn wanted(motor: &MotorFile) -> [Wanted<'_>; Channel::ALL.len()] {
    let (units, preset) = (&motor.units, motor.log.preset);
    let usual = |channel: Channel| match channel {
        Channel::Time => units.time.default_names(),
        Channel::Command if motor.drive_kind() == DriveKind::Position => {
            units.of_target().target_names()
        }
        Channel::Command => units.voltage.default_names(),
        Channel::Angle => units.angle.default_names(),
        // A supply that makes no volts of anything is not needed.
        Channel::Measured(Measured::Supply) if units.voltage.full_scale().is_none() => &[],
        Channel::Measured(channel) => units.of(channel).columns,
        Channel::Enabled => &["enabled"],
        Channel::Direction => &[],
    };
    Channel::ALL.map(|channel| Wanted {
        channel,
        mapped: motor.columns.get(channel),
        names: preset
            .map(|preset| preset.names_of(channel))
            .filter(|names| !names.is_empty())
            .unwrap_or(usual(channel)),
    })
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
