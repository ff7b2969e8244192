//! Measured against model, with the residual beneath and the quantiser's band in it.

use super::{FONT, failed, legend, rgb};
use crate::error::Error;
use crate::palette::{FLOOR, MEASURED, MODEL};
use plotters::prelude::*;
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use servoid_identify::fit::scores;

const SIZE: (u32, u32) = (960, 560);
/// Points of a line; more than the width of the drawing shows.
const POINTS: usize = 3000;

/// Draws the whole recording against the free-running model.
///
/// # Errors
/// [`Error::Model`] where the model cannot run; [`Error::Failed`] where nothing can be drawn.
pub fn overlay(data: &Data, candidate: &Candidate, method: Method) -> Result<String, Error> {
    let errors = scores::whole(data, candidate, method)?;
    let centre = data.half_cell();
    let turns = |counts: f64| counts / data.units.counts_per_rev;
    let index: Vec<usize> = thinned(data.len(), POINTS).collect();
    let measured: Vec<(f64, f64)> = index
        .iter()
        .map(|&k| (data.time_s[k], turns(data.counts[k])))
        .collect();
    let model: Vec<(f64, f64)> = index
        .iter()
        .map(|&k| (data.time_s[k], turns(data.counts[k] + errors[k])))
        .collect();
    let residual: Vec<(f64, f64)> = index
        .iter()
        .map(|&k| (data.time_s[k], errors[k] - centre))
        .collect();
    let end = data.time_s.last().copied().unwrap_or(1.0);

    let (measured_colour, model_colour) = (rgb(MEASURED), rgb(MODEL));
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (upper, lower) = root.split_vertically(360);
        let mut chart = ChartBuilder::on(&upper)
            .caption(format!("measured and model: {}", data.source), (FONT, 18))
            .margin(10)
            .x_label_area_size(28)
            .y_label_area_size(64)
            .build_cartesian_2d(0.0..end, range(&measured))
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .y_desc("shaft angle, turns")
            .draw()
            .map_err(failed)?;
        chart
            .draw_series(LineSeries::new(measured, measured_colour.stroke_width(4)))
            .map_err(failed)?
            .label("measured")
            .legend(move |(x, y)| {
                PathElement::new([(x, y), (x + 18, y)], measured_colour.stroke_width(4))
            });
        chart
            .draw_series(LineSeries::new(model, model_colour.stroke_width(1)))
            .map_err(failed)?
            .label("model")
            .legend(move |(x, y)| {
                PathElement::new([(x, y), (x + 18, y)], model_colour.stroke_width(1))
            });
        legend!(chart);
        draw_residual(&lower, residual, end)?;
        root.present().map_err(failed)?;
    }
    Ok(svg)
}

fn draw_residual(
    area: &DrawingArea<SVGBackend<'_>, plotters::coord::Shift>,
    residual: Vec<(f64, f64)>,
    end: f64,
) -> Result<(), Error> {
    let (floor_colour, model_colour) = (rgb(FLOOR), rgb(MODEL));
    let span = range(&residual);
    let span = span.start.min(-0.7)..span.end.max(0.7);
    let mut chart = ChartBuilder::on(area)
        .margin(10)
        .x_label_area_size(40)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..end, span)
        .map_err(failed)?;
    chart
        .configure_mesh()
        .light_line_style(TRANSPARENT)
        .x_desc("time, s")
        .y_desc("model - measured, counts")
        .draw()
        .map_err(failed)?;
    chart
        .draw_series([Rectangle::new(
            [(0.0, -0.5), (end, 0.5)],
            floor_colour.mix(0.2).filled(),
        )])
        .map_err(failed)?
        .label("half a count: the encoder's own")
        .legend(move |(x, y)| {
            Rectangle::new(
                [(x, y - 5), (x + 18, y + 5)],
                floor_colour.mix(0.3).filled(),
            )
        });
    chart
        .draw_series(LineSeries::new(residual, model_colour.stroke_width(1)))
        .map_err(failed)?;
    legend!(chart);
    Ok(())
}

fn range(points: &[(f64, f64)]) -> std::ops::Range<f64> {
    let low = points.iter().fold(f64::INFINITY, |m, p| m.min(p.1));
    let high = points.iter().fold(f64::NEG_INFINITY, |m, p| m.max(p.1));
    let room = (0.05 * (high - low)).max(1e-9);
    low - room..high + room
}

/// At most about `most` of `count` indices, the last included.
fn thinned(count: usize, most: usize) -> impl Iterator<Item = usize> {
    let step = count.div_ceil(most.max(1)).max(1);
    (0..count)
        .step_by(step)
        .chain(count.checked_sub(1).filter(|last| last % step != 0))
}
