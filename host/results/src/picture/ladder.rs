//! The error as effects are added, fitted and held out, down to what the encoder alone leaves.

use super::chart::{Chart, Properties, bars, scatter};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::report::diagnosis::bars::counts;
use shared::encoder::FLOOR_RMS_COUNTS;

/// One model on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct LadderBar {
    /// What was added, as in `+ coulomb`.
    pub name: String,
    /// On what was fitted, counts RMS.
    pub fitted: Option<f64>,
    /// On what was held out, counts RMS.
    pub held_out: Option<f64>,
}

/// How the models were judged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged {
    /// Length of the windows through which they ran, s; whole runs for none.
    pub window_s: Option<f64>,
    /// What the motor itself does not repeat there, counts RMS, where that is known.
    pub repeatability: Option<f64>,
}

/// Draws the ladder.
pub fn ladder(id: &str, entries: &[LadderBar], judged: &Judged) -> Picture {
    let names: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
    let mut plot = Chart::default();
    // The first and the last model have their colours; how full they are tells what was fitted.
    let colours: Vec<&str> = (0..entries.len())
        .map(|k| match k {
            _ if k + 1 == entries.len() => colour::MODEL,
            0 => colour::BASE,
            _ => colour::QUIET,
        })
        .collect();
    let mut bars = |name: &str, full: f64, of: fn(&LadderBar) -> Option<f64>| {
        if entries.iter().any(|entry| of(entry).is_some()) {
            let values: Vec<Option<f64>> = entries.iter().map(|r| of(r).map(rounded)).collect();
            let shown = entries.iter().map(|r| of(r).map_or(String::new(), counts));
            plot.add(
                bars(names.clone(), values)
                    .set("name", name)
                    .set(
                        "marker",
                        Properties::default().set("color", colours.clone()),
                    )
                    .set("opacity", full)
                    .set("textposition", "outside")
                    .set("text", shown.collect::<Vec<_>>())
                    .set("hovertemplate", "%{x}: %{text} counts RMS"),
            );
        }
    };
    bars("fitted (pale)", 0.45, |entry| entry.fitted);
    bars("held out, never fitted (full)", 1.0, |entry| entry.held_out);
    plot.add(
        scatter(names.clone(), vec![rounded(FLOOR_RMS_COUNTS); names.len()])
            .set("name", "what the encoder alone leaves")
            .set("mode", "lines")
            .set(
                "line",
                Properties::default()
                    .set("color", colour::FLOOR)
                    .set("dash", "dash"),
            ),
    );
    // The line of the floor over the whole width, which a trace over names does not have.
    let floor = Properties::default()
        .set("type", "line")
        .set("xref", "paper")
        .set("x0", 0)
        .set("x1", 1)
        .set("y0", rounded(FLOOR_RMS_COUNTS))
        .set("y1", rounded(FLOOR_RMS_COUNTS))
        .set(
            "line",
            Properties::default()
                .set("color", colour::FLOOR)
                .set("dash", "dash")
                .set("width", 2.0),
        );
    let band = judged.repeatability.map(|counts| {
        Properties::default()
            .set("type", "rect")
            .set("layer", "below")
            .set("xref", "paper")
            .set("x0", 0)
            .set("x1", 1)
            .set("y0", rounded(FLOOR_RMS_COUNTS))
            .set("y1", rounded(counts))
            .set("fillcolor", colour::FLOOR)
            .set("opacity", 0.15)
            .set("line", Properties::default().set("width", 0))
    });
    let span = match judged.window_s {
        Some(seconds) => format!("runs through windows of {seconds:.3} s"),
        None => "the free run over the whole recording".to_owned(),
    };
    let repeated = judged.repeatability.map_or(String::new(), |repeated| {
        format!(
            " What this motor does not repeat, {} counts there, is shaded: no model explains that.",
            counts(repeated)
        )
    });
    plot.lay_out(
        layout(360)
            .set(
                "shapes",
                band.into_iter().chain([floor]).collect::<Vec<_>>(),
            )
            .set("xaxis", axis(""))
            .set("yaxis", axis("error, counts RMS").set("type", "log")),
    );
    let mut table = Table::new(&["model", "fitted, counts RMS", "held out, counts RMS"]);
    for entry in entries {
        let cell = |value: Option<f64>| value.map_or("-".to_owned(), counts);
        table.row([entry.name.clone(), cell(entry.fitted), cell(entry.held_out)]);
    }
    Picture {
        id: id.to_owned(),
        title: "Error ladder".to_owned(),
        caption: format!(
            "Error of {span} as effects are added, logarithmic. No model can leave less than the encoder's own \
             {FLOOR_RMS_COUNTS:.3} counts for long.{repeated}"
        ),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    }
}
