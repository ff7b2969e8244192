//! One table: its head, and its columns in one or two rows of panels beside each other.

use super::across::Across;
use super::panel::{self, Panel};
use super::{Area, EDGE, PANELS, WIDTH, cut, text};
use crate::error::Error;
use crate::palette::QUIET;
use crate::plot::rgb;
use plotters::style::BLACK;
use plotters::style::text_anchor::HPos;
use servoid_io::input::{Survey, SurveyColumn, SurveyTable};

const HEAD: u32 = 30;
/// A line below the head.
const LINE: u32 = 20;
/// Room below the panels.
const GAP: u32 = 10;
/// Panels that stand one below the other; more stand in two columns.
const ALONE: usize = 6;
/// Characters of a line over the whole width.
const CHARACTERS: usize = 120;

/// One table as it is drawn.
pub(super) struct Section<'s> {
    table: &'s SurveyTable,
    across: Across,
    panels: Vec<Panel<'s>>,
    /// What is said below the head.
    said: Option<String>,
}

impl<'s> Section<'s> {
    /// The tables in the order in which they are drawn, and what is to be said of what is left out.
    pub(super) fn of(survey: &'s Survey) -> (Vec<Self>, String) {
        let mut tables: Vec<&SurveyTable> = survey.tables.iter().collect();
        tables.sort_by_key(|table| std::cmp::Reverse(table.guessed()));
        let mut sections = Vec::new();
        let (mut room, mut columns, mut left_out) = (PANELS, 0, 0);
        for table in tables {
            if room == 0 {
                left_out += 1;
                continue;
            }
            let (section, more) = Section::new(table, room);
            room -= section.panels.len();
            columns += more;
            sections.push(section);
        }
        let counted = |count: usize, what: &str| match count {
            0 => None,
            1 => Some(format!("1 {what}")),
            count => Some(format!("{count} {what}s")),
        };
        let not_drawn: Vec<String> = [
            counted(columns, "more column"),
            counted(left_out, "more table"),
        ]
        .into_iter()
        .flatten()
        .collect();
        let said = match not_drawn.as_slice() {
            [] => String::new(),
            several => format!("not drawn: {}", several.join(" and ")),
        };
        (sections, said)
    }

    /// A table in at most so many panels, and how many more columns it has.
    fn new(table: &'s SurveyTable, room: usize) -> (Self, usize) {
        let across = Across::of(table);
        let is_across = |column: &SurveyColumn| across.is(column);
        let others = table.columns.iter().filter(|column| !is_across(column));
        let (drawn, blank): (Vec<&SurveyColumn>, Vec<&SurveyColumn>) =
            others.partition(|column| column.is_number && column.envelope.is_some());
        let (mut drawn, empty): (Vec<&SurveyColumn>, Vec<&SurveyColumn>) = drawn
            .into_iter()
            .partition(|column| column.profile.range().is_some());
        // What is the motor's comes first.
        let order = ["voltage", "target", "angle", "current", "enabled"];
        let place = |column: &&SurveyColumn| {
            let guess = column.guess;
            let place = order.iter().position(|key| guess == Some(key));
            place.unwrap_or(order.len())
        };
        drawn.sort_by_key(place);
        let more = drawn.len().saturating_sub(room);
        drawn.truncate(room);
        let names: Vec<&str> = blank
            .iter()
            .chain(&empty)
            .map(|c| c.name.as_str())
            .collect();
        let said = (!names.is_empty()).then(|| {
            let mut said = format!("no numbers: {}", names.join(", "));
            if said.chars().count() > CHARACTERS {
                said = said.chars().take(CHARACTERS - 1).collect::<String>() + "…";
            }
            said
        });
        let panels = drawn.into_iter().filter_map(Panel::of).collect();
        let section = Section {
            table,
            across,
            panels,
            said,
        };
        (section, more)
    }

    /// Panels beside each other.
    fn abreast(&self) -> usize {
        if self.panels.len() > ALONE { 2 } else { 1 }
    }

    pub(super) fn height(&self) -> u32 {
        let rows = self.panels.len().div_ceil(self.abreast()) as u32;
        let axis = if rows > 0 { panel::AXIS } else { 0 };
        self.top() + rows * panel::HEIGHT + axis + GAP
    }

    /// What stands above the panels.
    fn top(&self) -> u32 {
        HEAD + if self.said.is_some() { LINE } else { 0 }
    }

    pub(super) fn draw(&self, area: &Area<'_>) -> Result<(), Error> {
        let table = self.table;
        let rows = match table.rows {
            1 => "1 row".to_owned(),
            rows => format!("{rows} rows"),
        };
        let name = match table.name.as_str() {
            "" => rows,
            name => format!("{}, {rows}", cut(name, CHARACTERS - 30)),
        };
        text(area, &name, (EDGE, 8), 17, BLACK, HPos::Left)?;
        if let Some(said) = &self.said {
            let at = (EDGE, HEAD as i32);
            text(area, said, at, 15, rgb(QUIET), HPos::Left)?;
        }
        let abreast = self.abreast();
        let width = WIDTH / abreast as u32;
        for (k, panel) in self.panels.iter().enumerate() {
            let (row, place) = ((k / abreast) as u32, (k % abreast) as u32);
            // The last of each column has the axis.
            let is_last = k + abreast >= self.panels.len();
            let height = panel::HEIGHT + if is_last { panel::AXIS } else { 0 };
            let corner = (place * width, self.top() + row * panel::HEIGHT);
            let area = area.clone().shrink(corner, (width, height));
            panel.draw(&area, &self.across, is_last)?;
        }
        Ok(())
    }
}
