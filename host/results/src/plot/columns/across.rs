//! What the columns of a table are drawn against: its time, or the number of the row.

use crate::number_text::short;
use servoid_io::input::{Envelope, SurveyColumn, SurveyTable};
use std::ops::Range;

/// Numbers below an axis, at most.
const LABELS: usize = 8;

/// The horizontal axis of a table.
pub(super) struct Across {
    /// The column of times.
    time: Option<String>,
    /// What stands below the axis.
    pub(super) title: String,
    /// A place for each bin of the table's columns; none where the time of a bin is not known.
    pub(super) places: Vec<Option<f64>>,
    /// From the first to the last.
    pub(super) span: Range<f64>,
    /// Numbers below it, at most.
    pub(super) labels: usize,
}

impl Across {
    /// Against the time where it goes on, else against rows.
    pub(super) fn of(table: &SurveyTable) -> Self {
        let is_time = |column: &&SurveyColumn| column.is_time || column.guess == Some("time");
        let time = table.columns.iter().find(is_time);
        time.and_then(Across::of_time)
            .unwrap_or_else(|| Across::of_rows(table))
    }

    /// Whether it is this column.
    pub(super) fn is(&self, column: &SurveyColumn) -> bool {
        self.time.as_ref() == Some(&column.name)
    }

    fn of_time(column: &SurveyColumn) -> Option<Self> {
        let [first, last] = column.profile.range()?;
        let length = last - first;
        // Also false where it is not finite.
        if !(length > 1e-200 && length < 1e200) {
            return None;
        }
        // A time since 1970 leaves no room for its own digits.
        let zero = if first.abs() > length { first } else { 0.0 };
        let mut places = Vec::new();
        let mut before = f64::NEG_INFINITY;
        for bin in column.envelope.as_ref()?.bins() {
            let ends = bin.ends();
            places.push(ends.map(|[from, to]| 0.5 * (from - zero) + 0.5 * (to - zero)));
            if let Some([from, to]) = ends {
                if from < before {
                    return None;
                }
                before = to;
            }
        }
        let since = if zero == 0.0 {
            String::new()
        } else {
            format!(" since {}", short(zero))
        };
        let unit = column.any_unit();
        let unit = unit.map_or(String::new(), |unit| format!(", {unit}"));
        Some(Across {
            time: Some(column.name.clone()),
            title: format!("{}{since}{unit}", column.name),
            places,
            span: first - zero..last - zero,
            labels: LABELS,
        })
    }

    fn of_rows(table: &SurveyTable) -> Self {
        let envelopes = table.columns.iter().filter_map(|c| c.envelope.as_ref());
        let longest = envelopes.max_by_key(|envelope| envelope.bins().len());
        let bins = longest.map_or(0, |envelope| envelope.bins().len());
        let every = longest.map_or(1, Envelope::every) as f64;
        let middle = |k: usize| Some(1.0 + k as f64 * every + 0.5 * (every - 1.0));
        Across {
            time: None,
            title: "row".to_owned(),
            places: (0..bins).map(middle).collect(),
            span: 1.0..(table.rows as f64).max(2.0),
            // There is no half a row.
            labels: (table.rows as usize).clamp(2, LABELS),
        }
    }
}
