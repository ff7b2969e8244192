//! One column: its name, what it may be, its unit, its range and its values.

use super::across::Across;
use super::{Area, cut, text};
use crate::error::Error;
use crate::number_text::short;
use crate::palette::{BASE, LIST, MODEL, OTHER, QUIET};
use crate::plot::{FONT, failed, rgb};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;
use servoid_io::input::{Envelope, SurveyColumn};

/// Of a panel.
pub(super) const HEIGHT: u32 = 104;
/// Of the numbers and the title below the last.
pub(super) const AXIS: u32 = 44;
/// Of the name.
const NAME: u32 = 22;
/// Room for the ends of the range.
const RANGE: u32 = 88;
/// Between the values and the frame, above and below.
const ROOM: f64 = 0.08;
/// So few bins are points.
const POINTS: usize = 64;
/// Width of a character of a name, about.
const CHARACTER: u32 = 8;

/// One column as it is drawn.
pub(super) struct Panel<'s> {
    column: &'s SurveyColumn,
    envelope: &'s Envelope,
    least: f64,
    greatest: f64,
}

impl<'s> Panel<'s> {
    /// None where the column has no number.
    pub(super) fn of(column: &'s SurveyColumn) -> Option<Self> {
        let [least, greatest] = column.profile.range()?;
        Some(Panel {
            column,
            envelope: column.envelope.as_ref()?,
            least,
            greatest,
        })
    }

    pub(super) fn draw(
        &self,
        area: &Area<'_>,
        across: &Across,
        with_axis: bool,
    ) -> Result<(), Error> {
        let (width, _) = area.dim_in_pixel();
        let colour = rgb(self.colour());
        let role = self.role();
        let right = width as i32 - 16;
        text(area, &role, (right, 4), 15, colour, HPos::Right)?;
        let room = (width.saturating_sub(RANGE + 32) / CHARACTER) as usize;
        let room = room.saturating_sub(role.chars().count());
        let name = cut(&self.column.name, room);
        text(area, &name, (RANGE as i32, 4), 15, BLACK, HPos::Left)?;

        let mut chart = ChartBuilder::on(area)
            .margin_top(NAME)
            .margin_bottom(4)
            .margin_right(16)
            .x_label_area_size(if with_axis { AXIS } else { 0 })
            .y_label_area_size(RANGE)
            .build_cartesian_2d(across.span.clone(), -ROOM..1.0 + ROOM)
            .map_err(failed)?;
        let mut mesh = chart.configure_mesh();
        mesh.disable_y_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(BLACK.mix(0.1))
            .axis_style(BLACK.mix(0.3))
            .y_labels(0)
            .x_labels(across.labels)
            .x_label_formatter(&|x| plain(*x))
            .label_style((FONT, 14));
        if with_axis {
            mesh.x_desc(cut(&across.title, room))
                .axis_desc_style((FONT, 15));
        }
        mesh.draw().map_err(failed)?;
        if self.least < 0.0 && self.greatest > 0.0 {
            let zero = self.height(0.0);
            let ends = [(across.span.start, zero), (across.span.end, zero)];
            let line = PathElement::new(ends, BLACK.mix(0.25));
            chart.draw_series([line]).map_err(failed)?;
        }
        for run in self.runs(across) {
            let is_alone = run.len() == 1;
            let points = if is_alone || self.envelope.bins().len() <= POINTS {
                run.clone()
            } else {
                Vec::new()
            };
            let points = points
                .into_iter()
                .map(|at| Circle::new(at, 2, colour.filled()));
            chart.draw_series(points).map_err(failed)?;
            if !is_alone {
                let line = LineSeries::new(run, colour.stroke_width(1));
                chart.draw_series(line).map_err(failed)?;
            }
        }
        let plotted = HEIGHT - NAME - 4;
        let ends: &[(f64, f64)] = if self.least == self.greatest {
            &[(self.least, 0.5)]
        } else {
            &[(self.least, 0.0), (self.greatest, 1.0)]
        };
        for (value, height) in ends {
            let part = (1.0 + ROOM - height) / (1.0 + 2.0 * ROOM);
            let middle = f64::from(NAME) + part * f64::from(plotted);
            let at = (RANGE as i32 - 8, middle as i32 - 7);
            text(area, &plain(*value), at, 14, BLACK, HPos::Right)?;
        }
        Ok(())
    }

    /// What it may be, and its unit.
    fn role(&self) -> String {
        let column = self.column;
        let said = [column.guess, column.any_unit()].into_iter().flatten();
        said.collect::<Vec<&str>>().join(", ")
    }

    fn colour(&self) -> &'static str {
        match self.column.guess {
            Some("voltage" | "target") => BASE,
            Some("angle") => MODEL,
            Some("current") => OTHER,
            Some(_) => LIST[3],
            None => QUIET,
        }
    }

    /// Its place between the ends of the range, from 0 to 1. Halves do not overflow.
    fn height(&self, value: f64) -> f64 {
        if self.least == self.greatest {
            return 0.5;
        }
        (0.5 * value - 0.5 * self.least) / (0.5 * self.greatest - 0.5 * self.least)
    }

    /// The line from bin to bin, broken where there is nothing. Through each bin it goes from the end that is nearer to where it came from.
    fn runs(&self, across: &Across) -> Vec<Vec<(f64, f64)>> {
        let mut runs = vec![Vec::new()];
        for (bin, place) in self.envelope.bins().iter().zip(&across.places) {
            let Some((ends, place)) = bin.ends().zip(*place) else {
                runs.push(Vec::new());
                continue;
            };
            let [low, high] = ends.map(|value| self.height(value));
            if let Some(run) = runs.last_mut() {
                let falls = run
                    .last()
                    .is_some_and(|(_, y): &(f64, f64)| (y - high).abs() < (y - low).abs());
                let (one, other) = if falls { (high, low) } else { (low, high) };
                run.push((place, one));
                if one != other {
                    run.push((place, other));
                }
            }
        }
        runs.retain(|run| !run.is_empty());
        runs
    }
}

/// A number without the zeros behind its last digit.
fn plain(x: f64) -> String {
    let text = short(x);
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
