//! Bode plot of several position loops, with the lines at which margins are read.

use super::{failed, legend, rgb};
use crate::error::Error;
use crate::palette;
use plotters::prelude::*;
use servoid_identify::fit::margins::Loop;

const SIZE: (u32, u32) = (960, 640);
const POINTS: usize = 400;

/// Draws magnitude (dB of rad/V) and phase of each loop between two frequencies, rad/s.
///
/// # Errors
/// [`Error::Failed`] where nothing can be drawn.
pub fn bode(loops: &[(String, Loop)], from: f64, to: f64) -> Result<String, Error> {
    let frequencies: Vec<f64> = (0..=POINTS)
        .map(|k| from * (to / from).powf(k as f64 / POINTS as f64))
        .collect();
    let line = |l: &Loop, f: &dyn Fn((f64, f64)) -> f64| -> Vec<(f64, f64)> {
        frequencies.iter().map(|&w| (w, f(l.response(w)))).collect()
    };
    let decibels = |(magnitude, _): (f64, f64)| 20.0 * magnitude.log10();
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
        root.fill(&WHITE).map_err(failed)?;
        let (upper, lower) = root.split_vertically(340);
        let all: Vec<f64> = loops
            .iter()
            .flat_map(|(_, l)| line(l, &decibels))
            .map(|p| p.1)
            .collect();
        let low = all.iter().copied().fold(f64::INFINITY, f64::min);
        let high = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let phase = |(_, phase): (f64, f64)| phase;
        let values: [&dyn Fn((f64, f64)) -> f64; 2] = [&decibels, &phase];
        let spans = [low - 5.0..high + 5.0, -280.0..-80.0];
        let names = ["magnitude, dB(rad/V)", "phase, degrees"];
        for (pane, (area, span)) in [&upper, &lower].into_iter().zip(spans).enumerate() {
            let (name, value) = (names[pane], values[pane]);
            // Margins are read where these are crossed.
            let mark = [0.0, -180.0][pane];
            let mut chart = ChartBuilder::on(area)
                .margin(10)
                .x_label_area_size(38)
                .y_label_area_size(64)
                .build_cartesian_2d((from..to).log_scale(), span)
                .map_err(failed)?;
            chart
                .configure_mesh()
                .light_line_style(TRANSPARENT)
                .x_desc(if pane == 1 { "frequency, rad/s" } else { "" })
                .y_desc(name)
                .draw()
                .map_err(failed)?;
            chart
                .draw_series(LineSeries::new([(from, mark), (to, mark)], BLACK.mix(0.5)))
                .map_err(failed)?;
            for (k, (label, l)) in loops.iter().enumerate() {
                let colour = rgb(palette::of(k));
                // Drawn one over the other, the wide ones first, so that equal ones all show.
                let width = 2 + 2 * (loops.len() - k) as u32 / loops.len().max(1) as u32;
                chart
                    .draw_series(LineSeries::new(line(l, value), colour.stroke_width(width)))
                    .map_err(failed)?
                    .label(label.clone())
                    .legend(move |(x, y)| {
                        PathElement::new([(x, y), (x + 18, y)], colour.stroke_width(3))
                    });
            }
            if pane == 0 {
                legend!(chart);
            }
        }
        root.present().map_err(failed)?;
    }
    Ok(svg)
}
