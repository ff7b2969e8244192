//! Best cost against model evaluations: median over the seeds and the middle half as a band.

use super::{FONT, failed, legend, rgb};
use crate::error::Error;
use crate::palette;
use crate::schema::contest::Row;
use plotters::prelude::*;

const SIZE: (u32, u32) = (960, 520);

/// Draws the curves of all methods, both axes logarithmic.
///
/// # Errors
/// [`Error::Failed`] where nothing can be drawn (no finite cost at all).
pub fn cost_curves(rows: &[Row], budget: usize, cost: &str) -> Result<String, Error> {
    let runs = || {
        rows.iter()
            .filter_map(|row| Some((row, row.runs.as_ref()?)))
    };
    // The axis is logarithmic.
    let shown = |n: usize, cost: f64| (cost > 0.0).then_some((n as f64, cost));
    let curves: Vec<[Vec<(f64, f64)>; 3]> = runs()
        .map(|(_, runs)| {
            let band = || runs.curve_band.iter();
            [
                band().filter_map(|&(n, low, _)| shown(n, low)).collect(),
                (runs.curve.iter())
                    .filter_map(|&(n, cost)| shown(n, cost))
                    .collect(),
                band().filter_map(|&(n, _, high)| shown(n, high)).collect(),
            ]
        })
        .collect();
    let all = || curves.iter().flatten().flatten();
    let low = all().fold(f64::INFINITY, |m, p| m.min(p.1));
    let high = all().fold(0.0f64, |m, p| m.max(p.1));
    if !low.is_finite() {
        return Err(failed("no run found a finite cost"));
    }
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let mut chart = ChartBuilder::on(&root)
            .caption(
                "best cost so far: median over the seeds, band of the middle half",
                (FONT, 18),
            )
            .margin(12)
            .x_label_area_size(42)
            .y_label_area_size(76)
            .build_cartesian_2d(
                (1.0..budget.max(2) as f64).log_scale(),
                (low * 0.8..high.max(low * 1.1) * 1.2).log_scale(),
            )
            .map_err(failed)?;
        chart
            .configure_mesh()
            .light_line_style(TRANSPARENT)
            .x_desc("model evaluations")
            .y_desc(format!("cost ({cost})"))
            .y_label_formatter(&|y| crate::number_text::short(*y))
            .draw()
            .map_err(failed)?;
        for (k, ((row, _), [lower, median, upper])) in runs().zip(curves).enumerate() {
            let colour = rgb(palette::of(k));
            // Where a quarter of the runs has no finite cost yet, the band has no upper edge.
            let band = lower
                .iter()
                .chain(upper.iter().rev())
                .copied()
                .collect::<Vec<_>>();
            chart
                .draw_series([Polygon::new(band, colour.mix(0.15))])
                .map_err(failed)?;
            chart
                .draw_series(LineSeries::new(median, colour.stroke_width(2)))
                .map_err(failed)?
                .label(row.algorithm.clone())
                .legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(2))
                });
        }
        legend!(chart);
        root.present().map_err(failed)?;
    }
    Ok(svg)
}
