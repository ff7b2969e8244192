//! Best cost against model evaluations: median over the seeds and the middle half as a band.

use super::chart::{Chart, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::short;
use crate::schema::contest::Row;

/// Draws the curves of all methods, both axes logarithmic; `None` where no method has one.
pub fn cost_curves(id: &str, title: &str, rows: &[Row], seeds: usize) -> Option<Picture> {
    let mut plot = Chart::default();
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
            plot.add(
                scatter(x, y)
                    .set("legendgroup", &row.algorithm)
                    .set("showlegend", false)
                    .set("hoverinfo", "skip")
                    .set("mode", "lines")
                    .set("line", stroke(colour, 0.0))
                    .set("fill", "toself")
                    .set("fillcolor", format!("{colour}33")),
            );
        }
        let (x, y): (Vec<usize>, Vec<f64>) =
            runs.curve.iter().map(|&(n, c)| (n, rounded(c))).unzip();
        plot.add(
            scatter(x, y)
                .set("name", &row.algorithm)
                .set("legendgroup", &row.algorithm)
                .set("mode", "lines")
                .set("line", stroke(colour, 2.0)),
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
    plot.lay_out(
        layout(440)
            .set("xaxis", axis("model evaluations").set("type", "log"))
            .set("yaxis", axis("best cost so far").set("type", "log")),
    );
    Some(Picture {
        id: id.to_owned(),
        title: title.to_owned(),
        caption: format!(
            "Best cost so far against model evaluations over {seeds} {}: the median, and the middle half as a band. One \
             run proves nothing: costs often spread fivefold over seeds.",
            if seeds == 1 { "seed" } else { "seeds" }
        ),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}
