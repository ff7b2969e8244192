//! The error as effects are added, fitted and held out, down to what the encoder alone leaves.

use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::report::diagnosis::bars::counts;
use plotly::common::{DashType, Line, Marker, Mode, TextPosition};
use plotly::layout::{AxisType, Shape, ShapeLine, ShapeType};
use plotly::{Bar, Plot, Scatter};
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

/// Draws the ladder.
pub fn ladder(id: &str, entries: &[LadderBar]) -> Picture {
    let names: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
    let mut plot = Plot::new();
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
            plot.add_trace(
                Bar::new(names.clone(), values)
                    .name(name)
                    .marker(Marker::new().color_array(colours.clone()))
                    .opacity(full)
                    .text_position(TextPosition::Outside)
                    .text_array(shown.collect())
                    .hover_template("%{x}: %{text} counts RMS"),
            );
        }
    };
    bars("fitted (pale)", 0.45, |entry| entry.fitted);
    bars("held out, never fitted (full)", 1.0, |entry| entry.held_out);
    plot.add_trace(
        Scatter::new(names.clone(), vec![rounded(FLOOR_RMS_COUNTS); names.len()])
            .name("what the encoder alone leaves")
            .mode(Mode::Lines)
            .line(Line::new().color(colour::FLOOR).dash(DashType::Dash)),
    );
    // The line of the floor over the whole width, which a trace over names does not have.
    let floor = Shape::new()
        .shape_type(ShapeType::Line)
        .x_ref("paper")
        .x0(0)
        .x1(1)
        .y0(rounded(FLOOR_RMS_COUNTS))
        .y1(rounded(FLOOR_RMS_COUNTS))
        .line(
            ShapeLine::new()
                .color(colour::FLOOR)
                .dash(DashType::Dash)
                .width(2.0),
        );
    plot.set_layout(
        layout(360)
            .shapes(vec![floor])
            .x_axis(axis(""))
            .y_axis(axis("error of the free run, counts RMS").type_(AxisType::Log)),
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
            "Error of the free run over the whole recording as effects are added, logarithmic. No model can leave less \
             than the encoder's own {FLOOR_RMS_COUNTS:.3} counts for long."
        ),
        drawing: Drawing::Chart(Box::new(plot)),
        table: Some(table),
    }
}
