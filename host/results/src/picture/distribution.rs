//! A quantity over many motors: how often which value, the population's curve, and the motors that are odd.

use super::chart::{Chart, Properties, bars, marker, scatter, stroke};
use super::histogram::histogram;
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::short;

/// Points of the curve.
const POINTS: usize = 121;
/// Of its spreads on either side of the middle.
const WIDE: f64 = 3.5;

/// A quantity over many motors.
pub struct Distribution<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// The usual motors' values.
    pub usual: &'a [f64],
    /// The odd motors with their values.
    pub odd: &'a [(String, f64)],
    /// Centre and spread of the population, of the logarithm where `logarithmic`; none where there is no population.
    pub curve: Option<(f64, f64)>,
    /// Whether units differ evenly in the logarithm.
    pub logarithmic: bool,
}

/// Draws it; none without values.
pub fn distribution(id: &str, shown: &Distribution<'_>) -> Option<Picture> {
    let bins = (shown.usual.len() as f64).sqrt().ceil().clamp(8.0, 60.0) as usize;
    let (middles, counts) = histogram(shown.usual, bins);
    let width = middles.get(1).map_or(1.0, |second| second - middles[0]);
    let highest = *counts.iter().max()? as f64;
    let mut table = Table::new(&["from", "to", "motors"]);
    for (middle, count) in middles.iter().zip(&counts) {
        table.row([
            short(middle - 0.5 * width),
            short(middle + 0.5 * width),
            count.to_string(),
        ]);
    }
    let mut plot = Chart::default();
    plot.add(
        bars(
            middles.iter().copied().map(rounded).collect::<Vec<_>>(),
            counts,
        )
        .set("name", "motors")
        .set(
            "marker",
            Properties::default()
                .set("color", colour::MODEL)
                .set("opacity", 0.55),
        ),
    );
    if let Some((centre, spread)) = shown.curve.filter(|(_, spread)| *spread > 0.0) {
        let (x, y): (Vec<f64>, Vec<f64>) = (0..POINTS)
            .map(|k| {
                let z = WIDE * (2.0 * k as f64 / (POINTS - 1) as f64 - 1.0);
                let at = centre + z * spread;
                let density = (-0.5 * z * z).exp() / (spread * std::f64::consts::TAU.sqrt());
                let (x, density) = if shown.logarithmic {
                    (at.exp(), density / at.exp())
                } else {
                    (at, density)
                };
                (
                    rounded(x),
                    rounded(density * width * shown.usual.len() as f64),
                )
            })
            .unzip();
        plot.add(
            scatter(x, y)
                .set("name", "population")
                .set("mode", "lines")
                .set("line", stroke(colour::MEASURED, 2.0)),
        );
    }
    if !shown.odd.is_empty() {
        plot.add(
            scatter(
                shown
                    .odd
                    .iter()
                    .map(|(_, x)| rounded(*x))
                    .collect::<Vec<_>>(),
                vec![0.04 * highest; shown.odd.len()],
            )
            .set("name", "odd")
            .set("mode", "markers")
            .set(
                "text",
                shown
                    .odd
                    .iter()
                    .map(|(name, _)| name.clone())
                    .collect::<Vec<_>>(),
            )
            .set("marker", marker(colour::BASE, 9).set("symbol", "diamond")),
        );
    }
    let title = match shown.unit {
        "1" => shown.name.to_owned(),
        unit => format!("{}, {unit}", shown.name),
    };
    plot.lay_out(
        layout(260)
            .set("xaxis", axis(&title))
            .set("yaxis", axis("motors"))
            .set("bargap", 0.06),
    );
    Some(Picture {
        id: id.to_owned(),
        title: shown.name.to_owned(),
        caption: String::new(),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}
