//! Rows of a device as lines of a CSV that every verb reads.

use super::DutyScale;
use shared::trace::OPEN;
use shared::wire::Rows;
use std::fmt::Write;

/// Names of the columns.
pub const COLUMNS: &str = "t_s,voltage_v,angle_counts,current_a,enabled\n";

/// The lines of one stage, in the order in which its rows arrive.
#[derive(Clone, Debug)]
pub struct Lines {
    /// Index of the next row.
    next: u32,
    period_s: f64,
    scale: DutyScale,
}

impl Lines {
    /// At the start of a stage.
    pub fn new(period_us: u32, scale: DutyScale) -> Self {
        Lines {
            next: 0,
            period_s: f64::from(period_us) * 1e-6,
            scale,
        }
    }

    /// The lines of rows; a comment tells of periods that are missing before them. Rows that came before give none.
    pub fn of(&mut self, rows: &Rows) -> String {
        let mut text = String::new();
        if rows.first < self.next {
            return text;
        }
        // Writing to a string cannot fail.
        if rows.first > self.next {
            let _ = writeln!(text, "# {} periods were lost", rows.first - self.next);
        }
        let mut count = rows.count;
        for (k, row) in (rows.first..).zip(&rows.rows) {
            let volts = self.scale.recorded(row.duty);
            let _ = writeln!(
                text,
                "{:?},{volts:?},{count},{:?},{}",
                f64::from(k) * self.period_s,
                f64::from(row.current_ma) * 1e-3,
                u8::from(row.duty != OPEN)
            );
            count = count.wrapping_add(row.step.into());
        }
        self.next = rows.first.saturating_add(rows.rows.len() as u32);
        text
    }
}
