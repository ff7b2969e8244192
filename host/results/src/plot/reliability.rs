//! What was stated against how often it was right: a probability, or the level of an interval.

use super::{FONT, failed, rgb};
use crate::error::Error;
use crate::palette;
use plotters::prelude::*;

/// The drawing and the names beside it.
const SIZE: (u32, u32) = (1180, 720);
const SQUARE: u32 = 720;
/// Most characters of a name in one line.
const NAME: usize = 56;
/// Distance of the names, pixels.
const LINE: i32 = 40;

/// One series.
pub struct ReliabilityLine {
    /// Its name.
    pub name: String,
    /// In the order of what was stated.
    pub points: Vec<Statement>,
}

/// One point, in parts of one.
#[derive(Clone, Copy, Debug)]
pub struct Statement {
    /// What was stated.
    pub stated: f64,
    /// How often it was right.
    pub found: f64,
    /// The 95 % interval of that, where it is known.
    pub interval: Option<(f64, f64)>,
}

/// Draws the lines beside the diagonal, on which statements are as often right as they say; `axes` name the two.
///
/// # Errors
/// [`Error::Failed`] where nothing can be drawn.
pub fn reliability(lines: &[ReliabilityLine], axes: [&str; 2]) -> Result<String, Error> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (square, names) = root.split_horizontally(SQUARE);
        let mut chart = ChartBuilder::on(&square)
            .caption(
                "on the diagonal statements are as often right as they say",
                (FONT, 18),
            )
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..1.0, 0.0..1.0)
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc(axes[0])
            .y_desc(axes[1])
            .draw()
            .map_err(failed)?;
        chart
            .draw_series(LineSeries::new([(0.0, 0.0), (1.0, 1.0)], BLACK.mix(0.5)))
            .map_err(failed)?;
        for (k, line) in lines.iter().enumerate() {
            let colour = rgb(palette::of(k));
            let bars = line.points.iter().filter_map(|point| {
                let (low, high) = point.interval?;
                let ends = [(point.stated, low), (point.stated, high)];
                Some(PathElement::new(ends, colour.mix(0.6)))
            });
            chart.draw_series(bars).map_err(failed)?;
            let points = line.points.iter().map(|point| (point.stated, point.found));
            chart
                .draw_series(LineSeries::new(points, colour.stroke_width(2)).point_size(3))
                .map_err(failed)?;
            let y = LINE * (k as i32 + 1);
            let mark = PathElement::new([(0, y), (24, y)], colour.stroke_width(3));
            names.draw(&mark).map_err(failed)?;
            // In two lines where it is long.
            let at = line.name.len().min(NAME);
            let end = line.name[..at]
                .rfind(", ")
                .map_or(line.name.len(), |end| end + 1);
            let end = if line.name.len() > NAME {
                end
            } else {
                line.name.len()
            };
            for (row, text) in [&line.name[..end], line.name[end..].trim()]
                .into_iter()
                .enumerate()
            {
                let place = (32, y - 8 + 16 * row as i32);
                names
                    .draw(&Text::new(text.to_owned(), place, (FONT, 14)))
                    .map_err(failed)?;
            }
        }
        root.present().map_err(failed)?;
    }
    Ok(svg)
}
