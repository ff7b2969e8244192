//! An effect beside a curve that was found without its form.

use super::chart::{Chart, marker, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::short;
use crate::schema::effect_curve::{CurvePoint, EffectCurve};

/// Draws the law, and the recording's own curve with its band.
pub fn effect_curve(id: &str, effect: &str, curve: &EffectCurve, symbol: &str) -> Picture {
    let x: Vec<f64> = curve.points.iter().map(|point| rounded(point.at)).collect();
    let y = |of: &dyn Fn(&CurvePoint) -> f64| -> Vec<f64> {
        curve
            .points
            .iter()
            .map(|point| rounded(of(point)))
            .collect()
    };
    let mut plot = Chart::default();
    let edge = |y: Vec<f64>| {
        let line = stroke(colour::QUIET, 0.0);
        scatter(x.clone(), y).set("mode", "lines").set("line", line)
    };
    plot.add(edge(y(&|p| p.found_v - p.band_v)).set("showlegend", false));
    plot.add(
        edge(y(&|p| p.found_v + p.band_v))
            .set("name", "band of 95 %")
            .set("fill", "tonexty"),
    );
    plot.add(
        scatter(x.clone(), y(&|p| p.found_v))
            .set("name", "measured, without a form")
            .set("mode", "markers")
            .set("marker", marker(colour::MEASURED, 7)),
    );
    plot.add(
        scatter(x.clone(), y(&|p| p.law_v))
            .set("name", effect)
            .set("mode", "lines")
            .set("line", stroke(colour::MODEL, 2.0)),
    );
    let variable = match curve.variable.as_str() {
        "current" => "current as the voltage across the resistance",
        "angle" => "angle within the revolution",
        other => other,
    };
    plot.lay_out(
        layout(360)
            .set("xaxis", axis(&format!("{variable}, {}", curve.unit)))
            .set(
                "yaxis",
                axis(&format!("drive asked for, {symbol}")).set("zeroline", true),
            ),
    );
    let mut table = Table::new(&[
        &format!("{}, {}", curve.variable, curve.unit),
        &format!("law, {symbol}"),
        &format!("measured, {symbol}"),
        &format!("± (95 %), {symbol}"),
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
        drawing: Drawing::Chart(plot),
        table: Some(table),
    }
}
