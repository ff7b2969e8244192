//! What a log holds: the columns of its tables, a panel each, over time or over rows. Nothing needs to be known of the motor.

mod across;
mod panel;
mod section;

use super::{FONT, failed, rgb};
use crate::error::Error;
use crate::palette::QUIET;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use section::Section;
use servoid_io::input::Survey;

/// Panels of a drawing; further columns are counted.
const PANELS: usize = 60;
const WIDTH: u32 = 1000;
const TITLE: u32 = 40;
const NOTE: u32 = 30;
/// Distance of what is drawn from the edges.
const EDGE: i32 = 12;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Draws the tables of which most is guessed first.
///
/// # Errors
/// [`Error::Failed`] where nothing can be drawn.
pub fn columns(file: &str, survey: &Survey) -> Result<String, Error> {
    let (sections, left_out) = Section::of(survey);
    let heights: Vec<u32> = sections.iter().map(Section::height).collect();
    let height = TITLE + heights.iter().sum::<u32>() + NOTE;
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (WIDTH, height)).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let title = format!("{file}: {}", survey.format);
        text(&root, &cut(&title, 100), (EDGE, 10), 20, BLACK, HPos::Left)?;
        let mut top = TITLE;
        for (section, height) in sections.iter().zip(heights) {
            section.draw(&root.clone().shrink((0, top), (WIDTH, height)))?;
            top += height;
        }
        let at = (EDGE, top as i32 + 6);
        text(&root, &left_out, at, 15, rgb(QUIET), HPos::Left)?;
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

/// A line of text whose upper edge is at `at`, and whose left or right end.
fn text(
    area: &Area<'_>,
    text: &str,
    at: (i32, i32),
    size: u32,
    colour: RGBColor,
    end: HPos,
) -> Result<(), Error> {
    let style = TextStyle::from((FONT, size).into_font())
        .color(&colour)
        .pos(Pos::new(end, VPos::Top));
    area.draw_text(text, &style, at).map_err(failed)
}

/// At most so many characters: names differ at their ends.
fn cut(text: &str, most: usize) -> String {
    let count = text.chars().count();
    if count <= most {
        return text.to_owned();
    }
    let kept = text.chars().skip(count + 1 - most.max(1));
    format!("…{}", kept.collect::<String>())
}
