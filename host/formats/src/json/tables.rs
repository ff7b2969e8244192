//! The tables of a document.

use super::frame::Frame;
use super::node::Node;
use super::sysid::SysId;
use crate::error::FormatFault;
use crate::log::Column;
use crate::plan::{Along, MOST_COLUMNS, Plan, Source, join};
use crate::together::{self, Array};

/// The tables of a document, with what they hold.
#[derive(Debug, Default)]
pub(crate) struct Tables {
    /// The tables.
    pub(crate) plan: Plan,
    /// Their lists.
    pub(crate) frames: Vec<Frame>,
}

impl Tables {
    /// The tables of `document`, which may be one of SysId.
    pub(crate) fn of(document: Node, sysid: Option<&SysId>) -> Result<Self, FormatFault> {
        let mut tables = Tables::default();
        match document {
            Node::Object(members) => tables.object("", members, sysid)?,
            list => tables.object("", vec![(String::new(), list)], None)?,
        }
        Ok(tables)
    }

    fn object(
        &mut self,
        path: &str,
        members: Vec<(String, Node)>,
        sysid: Option<&SysId>,
    ) -> Result<(), FormatFault> {
        let mut arrays = Vec::new();
        let mut others = Vec::new();
        for (name, node) in members {
            match node {
                Node::List(frame) => {
                    let columns = sysid.and_then(|sysid| sysid.columns(&name, &frame));
                    match (columns, frame.width()) {
                        (None, Some(width)) => arrays.push(self.array(name, frame, width)),
                        (columns, _) => self.rows(&join(path, ".", &name), frame, columns)?,
                    }
                }
                node => others.push((name, node)),
            }
        }
        together::add(&mut self.plan, path, ".", arrays)?;
        for (name, node) in others {
            let path = join(path, ".", &name);
            match node {
                Node::Object(members) => self.object(&path, members, None)?,
                single => {
                    if let Some(text) = single.text() {
                        self.plan.fact(path, text);
                    }
                }
            }
        }
        Ok(())
    }

    fn array(&mut self, name: String, frame: Frame, width: usize) -> Array {
        let kind = frame.schema.kind(0);
        let shape = [frame.rows as u64, width as u64];
        self.frames.push(frame);
        Array {
            name,
            shape,
            kind,
            unit: None,
            id: self.frames.len() - 1,
        }
    }

    /// Adds a list of objects as a table of its own; of too many columns the first.
    fn rows(
        &mut self,
        path: &str,
        frame: Frame,
        columns: Option<Vec<Column>>,
    ) -> Result<(), FormatFault> {
        if columns.is_none()
            && let Some(rollouts) = frame.rollouts()
        {
            for (at, rollout) in rollouts.into_iter().enumerate() {
                self.rows(&format!("{path}[{at}]"), rollout, Some(Vec::new()))?;
            }
            return Ok(());
        }
        let columns = columns.filter(|columns| !columns.is_empty());
        let mut columns = columns.unwrap_or_else(|| frame.schema.columns());
        columns.truncate(MOST_COLUMNS as usize);
        if frame.rows == 0 || columns.is_empty() {
            return Ok(());
        }
        let array = self.frames.len();
        let sources = columns.into_iter().zip(0..).map(|(shown, column)| {
            let source = Source {
                array,
                column,
                along: Along::First,
                kind: shown.kind,
            };
            (shown, source)
        });
        self.plan
            .table(path, frame.rows as u64, sources.collect())?;
        self.frames.push(frame);
        Ok(())
    }

    /// The value of a column in a row.
    pub(crate) fn value(&self, source: &Source, row: u64) -> f64 {
        let (column, row) = match source.along {
            Along::First => (source.column, row),
            Along::Second => (row, source.column),
        };
        let frame = self.frames.get(source.array);
        let value = frame.and_then(|frame| {
            Some(frame.value(usize::try_from(column).ok()?, usize::try_from(row).ok()?))
        });
        value.unwrap_or(f64::NAN)
    }
}
