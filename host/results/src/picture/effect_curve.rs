//! An effect beside a curve that was found without its form.

use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::short;
use crate::schema::effect_curve::{CurvePoint, EffectCurve};
use plotly::common::{Fill, Line, Marker, Mode};
use plotly::{Plot, Scatter};

/// Draws the law, and the recording's own curve with its band.
pub fn effect_curve(id: &str, effect: &str, curve: &EffectCurve) -> Picture {
    let x: Vec<f64> = curve.points.iter().map(|point| rounded(point.at)).collect();
    let y = |of: &dyn Fn(&CurvePoint) -> f64| -> Vec<f64> {
        curve
            .points
            .iter()
            .map(|point| rounded(of(point)))
            .collect()
    };
    let mut plot = Plot::new();
    let edge = |y: Vec<f64>| {
        let line = Line::new().color(colour::QUIET).width(0.0);
        Scatter::new(x.clone(), y).mode(Mode::Lines).line(line)
    };
    plot.add_trace(edge(y(&|p| p.found_v - p.band_v)).show_legend(false));
    plot.add_trace(
        edge(y(&|p| p.found_v + p.band_v))
            .name("band of 95 %")
            .fill(Fill::ToNextY),
    );
    plot.add_trace(
        Scatter::new(x.clone(), y(&|p| p.found_v))
            .name("measured, without a form")
            .mode(Mode::Markers)
            .marker(Marker::new().color(colour::MEASURED).size(7)),
    );
    plot.add_trace(
        Scatter::new(x.clone(), y(&|p| p.law_v))
            .name(effect)
            .mode(Mode::Lines)
            .line(Line::new().color(colour::MODEL).width(2.0)),
    );
    let variable = match curve.variable.as_str() {
        "current" => "current as the voltage across the resistance",
        "angle" => "angle within the revolution",
        other => other,
    };
    plot.set_layout(
        layout(360)
            .x_axis(axis(&format!("{variable}, {}", curve.unit)))
            .y_axis(axis("drive asked for, V").zero_line(true)),
    );
    let mut table = Table::new(&[
        &format!("{}, {}", curve.variable, curve.unit),
        "law, V",
        "measured, V",
        "± (95 %), V",
    ]);
    for point in &curve.points {
        table.row([point.at, point.law_v, point.found_v, point.band_v].map(short));
    }
    let says = match curve.leaves {
        Some([from, to]) => format!(
            "The measured curve leaves its band between {} and {} {}: {effect} is not the whole story there.",
            short(from),
            short(to),
            curve.unit
        ),
        None => format!(
            "The measured curve stays within its band: nothing in it speaks against the form of {effect}."
        ),
    };
    Picture {
        id: id.to_owned(),
        title: format!("{effect} and the measured curve"),
        caption: format!(
            "The drive that the effect asks for along the {}, and that the recording asks for there when no form is stated. {says}",
            curve.variable
        ),
        drawing: Drawing::Chart(Box::new(plot)),
        table: Some(table),
    }
}
