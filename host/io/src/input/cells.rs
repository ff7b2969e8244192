//! One row of a file of any format to one sample.

use super::cell::converted;
use super::layout::{Column, Layout};
use super::read_error::{ReadError, ReadFault};
use super::scale::Scale;
use crate::channel::PerMeasured;

/// A row, cell by cell. A cell that says nothing, since it is empty or `nan`, gives none.
pub(super) trait Cells {
    /// The number in a column.
    fn number(&self, column: &Column) -> Result<Option<f64>, ReadFault>;

    /// 0 or 1 in a column.
    fn switch(&self, column: &Column) -> Result<Option<bool>, ReadFault>;

    /// The direction in a column: negative or zero for backwards.
    fn direction(&self, column: &Column) -> Result<Option<f64>, ReadFault>;

    /// An error of this row.
    fn error(&self, column: Option<&Column>, fault: ReadFault) -> ReadError;
}

/// What a row says, in our units.
pub(super) struct Sample {
    pub(super) time_s: f64,
    pub(super) command: Option<f64>,
    pub(super) counts: Option<f64>,
    pub(super) measured: PerMeasured<Option<f64>>,
    pub(super) enabled: Option<bool>,
}

impl Sample {
    /// The sample of a row whose time was read.
    pub(super) fn of(
        cells: &impl Cells,
        layout: &Layout,
        scale: &Scale<'_>,
        time_s: f64,
    ) -> Result<Self, ReadError> {
        let number = |column: &Column, convert: &dyn Fn(f64) -> Result<f64, ReadFault>| {
            let told = cells.number(column);
            let own = told.and_then(|told| told.map(|value| converted(value, convert)).transpose());
            own.map_err(|fault| cells.error(Some(column), fault))
        };
        let direction = layout.direction.as_ref().map(|column| {
            let read = cells.direction(column);
            read.map_err(|fault| cells.error(Some(column), fault))
        });
        let direction = direction.transpose()?.flatten();
        let command = number(&layout.command, &|command| {
            scale.command(directed(command, direction))
        })?;
        let counts = number(&layout.angle, &|angle| scale.counts(angle))?;
        let mut measured = PerMeasured::default();
        for (channel, column) in &layout.measured {
            measured[*channel] = number(column, &|value| Ok(scale.measured(*channel, value)))?;
        }
        let enabled = layout.enabled.as_ref().map(|column| {
            let read = cells.switch(column);
            read.map_err(|fault| cells.error(Some(column), fault))
        });
        Ok(Sample {
            time_s,
            command,
            counts,
            measured,
            enabled: enabled.transpose()?.flatten(),
        })
    }
}

/// A command with its direction, where that has a column of its own: backwards is zero, as on the direction pin of a bridge, or
/// negative.
pub(super) fn directed(command: f64, direction: Option<f64>) -> f64 {
    match direction {
        Some(direction) if direction <= 0.0 => 0.0 - command,
        _ => command,
    }
}
