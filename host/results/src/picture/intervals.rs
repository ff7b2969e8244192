//! How even the samples are.

use super::chart::{Chart, Properties, bars};
use super::histogram::histogram;
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use servoid_engine::problem::Data;

const BINS: usize = 60;

/// Draws the lengths of the sample intervals; `None` of fewer than two samples.
pub fn intervals(id: &str, data: &Data) -> Option<Picture> {
    let steps: Vec<f64> = data
        .time_s
        .windows(2)
        .map(|pair| 1e3 * (pair[1] - pair[0]))
        .collect();
    let least = steps.iter().copied().fold(f64::INFINITY, f64::min);
    let most = steps.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if steps.is_empty() {
        return None;
    }
    let (middles, counts) = histogram(&steps, BINS);
    let mut plot = Chart::default();
    let middles: Vec<f64> = middles.into_iter().map(rounded).collect();
    plot.add(
        bars(middles, counts)
            .set(
                "width",
                (0.9 * (most - least) / BINS as f64).max(0.02 * most),
            )
            .set(
                "marker",
                Properties::default().set("color", colour::MEASURED),
            )
            .set("hovertemplate", "%{x} ms: %{y} samples<extra></extra>"),
    );
    plot.lay_out(
        layout(260)
            .set("showlegend", false)
            .set(
                "xaxis",
                axis("sample interval, ms").set("range", shown(least, most)),
            )
            .set("yaxis", axis("samples").set("type", "log")),
    );
    let mut table = Table::new(&["", "ms"]);
    let median = 1e3 * data.units.interval;
    for (name, value) in [("shortest", least), ("median", median), ("longest", most)] {
        table.row([name.to_owned(), format!("{value:.6}")]);
    }
    Some(Picture {
        id: id.to_owned(),
        title: "Sample intervals".to_owned(),
        caption: format!(
            "{} intervals from {least:.4} to {most:.4} ms, median {median:.4} ms; logarithmic, so that a single gap \
             shows. The model steps over each as long as it was.",
            steps.len()
        ),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}

/// Range of the axis: around the lengths, or from zero where all are the same.
fn shown(least: f64, most: f64) -> Vec<f64> {
    let room = 0.05 * (most - least);
    if most - least > 1e-6 * most {
        vec![least - room, most + room]
    } else {
        vec![0.0, 2.0 * most]
    }
}
