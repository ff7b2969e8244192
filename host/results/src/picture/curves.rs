//! Best cost against model evaluations: median over the seeds and the middle half as a band.

use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::short;
use crate::schema::contest::Row;
use plotly::common::{Fill, Line, Mode};
use plotly::layout::AxisType;
use plotly::{Plot, Scatter};

/// Draws the curves of all methods, both axes logarithmic; `None` where no method has one.
pub fn cost_curves(id: &str, title: &str, rows: &[Row], seeds: usize) -> Option<Picture> {
    let mut plot = Plot::new();
    let mut table = Table::new(&[
        "method",
        "median cost",
        "quartiles",
        "worst",
        "best",
        "evaluations to 1 %",
    ]);
    let mut any = false;
    for (k, row) in rows.iter().enumerate() {
        let colour = colour::of(k);
        let Some(runs) = row.runs.as_ref().filter(|runs| !runs.curve.is_empty()) else {
            continue;
        };
        any = true;
        if !runs.curve_band.is_empty() {
            let forth = runs.curve_band.iter().map(|p| (p.0, p.1));
            let back = runs.curve_band.iter().rev().map(|p| (p.0, p.2));
            let (x, y): (Vec<usize>, Vec<f64>) =
                forth.chain(back).map(|(n, c)| (n, rounded(c))).unzip();
            plot.add_trace(
                Scatter::new(x, y)
                    .legend_group(&row.algorithm)
                    .show_legend(false)
                    .hover_info(plotly::common::HoverInfo::Skip)
                    .mode(Mode::Lines)
                    .line(Line::new().width(0.0).color(colour))
                    .fill(Fill::ToSelf)
                    .fill_color(format!("{colour}33")),
            );
        }
        let (x, y): (Vec<usize>, Vec<f64>) =
            runs.curve.iter().map(|&(n, c)| (n, rounded(c))).unzip();
        plot.add_trace(
            Scatter::new(x, y)
                .name(&row.algorithm)
                .legend_group(&row.algorithm)
                .mode(Mode::Lines)
                .line(Line::new().color(colour).width(2.0)),
        );
        let cell = |x: Option<f64>| x.map_or("-".to_owned(), short);
        table.row([
            row.algorithm.clone(),
            cell(runs.median_cost),
            runs.quartiles_cost.map_or("-".to_owned(), |[low, high]| {
                format!("{} to {}", short(low), short(high))
            }),
            cell(runs.worst_cost),
            cell(runs.best_cost),
            runs.median_evaluations_to_1pct
                .map_or("never".to_owned(), |n| format!("{n:.0}")),
        ]);
    }
    if !any {
        return None;
    }
    plot.set_layout(
        layout(440)
            .x_axis(axis("model evaluations").type_(AxisType::Log))
            .y_axis(axis("best cost so far").type_(AxisType::Log)),
    );
    Some(Picture {
        id: id.to_owned(),
        title: title.to_owned(),
        caption: format!(
            "Best cost so far against model evaluations over {seeds} {}: the median, and the middle half as a band. One \
             run proves nothing: costs often spread fivefold over seeds.",
            if seeds == 1 { "seed" } else { "seeds" }
        ),
        drawing: Drawing::Chart(Box::new(plot)),
        table: Some(table),
    })
}
