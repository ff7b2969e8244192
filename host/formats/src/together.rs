//! Which arrays were sampled together: those of one place with as many rows as each other.

use crate::error::FormatFault;
use crate::log::{Column, Kind};
use crate::plan::{Along, MOST_COLUMNS, Plan, Source, join};
use std::collections::{HashMap, HashSet};

/// An array with up to two axes.
#[derive(Clone, Debug)]
pub(crate) struct Array {
    /// Its name within its place.
    pub(crate) name: String,
    /// Its length along both axes; a vector has 1 along one of them.
    pub(crate) shape: [u64; 2],
    /// What its values are.
    pub(crate) kind: Kind,
    /// Their unit.
    pub(crate) unit: Option<String>,
    /// The reader's own number of it.
    pub(crate) id: usize,
}

/// The lengths of an array without the axes that have one element; `None` where more than two
/// are left.
pub(crate) fn shape(axes: &[u64]) -> Option<[u64; 2]> {
    let mut long = axes.iter().copied().filter(|&length| length != 1);
    match (long.next(), long.next(), long.next()) {
        (first, second, None) => Some([first.unwrap_or(1), second.unwrap_or(1)]),
        _ => None,
    }
}

/// Adds the arrays of the place called `path` as tables.
///
/// Arrays of equal length are one table. The largest such group has the name of the place; an
/// array on its own, and any further group, has that of its first array.
pub(crate) fn add(
    plan: &mut Plan,
    path: &str,
    separator: &str,
    arrays: Vec<Array>,
) -> Result<(), FormatFault> {
    let lengths: HashSet<u64> = arrays
        .iter()
        .filter(|array| array.shape.contains(&1))
        .map(|array| array.shape[0].max(array.shape[1]))
        .collect();
    let mut order = Vec::new();
    let mut groups: HashMap<u64, Vec<(Array, Along)>> = HashMap::new();
    for array in arrays {
        if array.shape.contains(&0) {
            continue;
        }
        let Some(along) = along(array.shape, &lengths) else {
            let [rows, columns] = array.shape;
            plan.unread(
                join(path, separator, &array.name),
                format!("an array of {rows} x {columns}"),
                format!("cut it to at most {MOST_COLUMNS} signals"),
            );
            continue;
        };
        let rows = match along {
            Along::First => array.shape[0],
            Along::Second => array.shape[1],
        };
        let group = groups.entry(rows).or_default();
        if group.is_empty() {
            order.push(rows);
        }
        group.push((array, along));
    }
    let main = order
        .iter()
        .copied()
        .filter(|rows| groups.get(rows).is_some_and(|group| group.len() > 1))
        .max_by_key(|rows| (groups.get(rows).map_or(0, Vec::len), *rows));
    for rows in order {
        let group = groups.remove(&rows).unwrap_or_default();
        let name = match group.first() {
            Some((array, _)) if main != Some(rows) => join(path, separator, &array.name),
            _ => path.to_owned(),
        };
        plan.table(name, rows, group.into_iter().flat_map(columns).collect())?;
    }
    Ok(())
}

/// Which axis is time: the one that is as long as a vector beside it, else the longer one.
/// `None` where either choice would give too many columns.
fn along(shape: [u64; 2], lengths: &HashSet<u64>) -> Option<Along> {
    let [rows, columns] = shape;
    let longer = if rows >= columns {
        Along::First
    } else {
        Along::Second
    };
    let is_vector = rows == 1 || columns == 1;
    let chosen = match (lengths.contains(&rows), lengths.contains(&columns)) {
        (true, false) if !is_vector => Along::First,
        (false, true) if !is_vector => Along::Second,
        _ => longer,
    };
    let fits = |along| match along {
        Along::First => columns <= MOST_COLUMNS,
        Along::Second => rows <= MOST_COLUMNS,
    };
    [chosen, longer].into_iter().find(|along| fits(*along))
}

/// The columns of an array: one with its name, or `name[0]`, `name[1]` and so on.
fn columns((array, along): (Array, Along)) -> impl Iterator<Item = (Column, Source)> {
    let width = match along {
        Along::First => array.shape[1],
        Along::Second => array.shape[0],
    };
    (0..width).map(move |at| {
        let name = if width == 1 && !array.name.is_empty() {
            array.name.clone()
        } else {
            format!("{}[{at}]", array.name)
        };
        let column = Column {
            name,
            kind: array.kind,
            unit: array.unit.clone(),
        };
        let source = Source {
            array: array.id,
            column: at,
            along,
            kind: array.kind,
        };
        (column, source)
    })
}
