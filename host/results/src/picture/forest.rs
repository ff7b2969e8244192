//! Parameters with intervals, several estimates side by side: each as a part of the first one's value, since units and
//! sizes differ.

use super::chart::{Chart, Properties, marker, scatter};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::stated;
use crate::schema::Estimate;

/// Half the width of a drawn interval, standard errors.
const WIDE: f64 = 1.96;

/// Estimates of one source.
pub struct Estimates<'a> {
    /// The source, as in `device`.
    pub name: String,
    /// The parameters.
    pub parameters: &'a [Estimate],
}

/// Draws the parameters of all sources that are determined; the table has all.
pub fn forest(id: &str, sources: &[Estimates<'_>]) -> Option<Picture> {
    let first = sources.first()?;
    let reference = |name: &str| {
        let found = first.parameters.iter().find(|p| p.name == name);
        found.filter(|p| p.identifiable && p.std.is_some_and(f64::is_finite) && p.value != 0.0)
    };
    let mut table = Table::new(&["parameter", "source", "value", "unit", "interval of 95 %"]);
    let mut plot = Chart::default();
    let mut drawn = 0;
    for (k, source) in sources.iter().enumerate() {
        let (mut x, mut y, mut wide) = (Vec::new(), Vec::new(), Vec::new());
        for parameter in source.parameters {
            table.row(cells(&source.name, parameter));
            let (Some(around), Some(std)) = (reference(&parameter.name), parameter.std) else {
                continue;
            };
            if !parameter.identifiable {
                continue;
            }
            x.push(rounded(100.0 * (parameter.value / around.value - 1.0)));
            wide.push(rounded(100.0 * WIDE * std / around.value.abs()));
            y.push(parameter.name.clone());
        }
        drawn = drawn.max(x.len());
        plot.add(
            scatter(x, y)
                .set("name", &source.name)
                .set("mode", "markers")
                .set("marker", marker(colour::of(k), 9))
                .set(
                    "error_x",
                    Properties::default()
                        .set("type", "data")
                        .set("array", wide)
                        .set("thickness", 2.0),
                ),
        );
    }
    if table.rows.is_empty() {
        return None;
    }
    plot.lay_out(
        layout(130 + 34 * drawn)
            .set(
                "xaxis",
                axis(&format!("off {}, %", first.name)).set("zeroline", true),
            )
            // The first on top.
            .set(
                "yaxis",
                axis("").set("range", vec![drawn as f64 - 0.5, -0.5]),
            ),
    );
    Some(Picture {
        id: id.to_owned(),
        title: "Parameters".to_owned(),
        caption: format!(
            "Each parameter that the data determine with its interval of 95 %, in parts of what {} found. What is not \
             determined is in the table only, and says so.",
            first.name
        ),
        drawing: if drawn > 0 {
            Drawing::Chart(plot)
        } else {
            Drawing::Nothing
        },
        table: Some(table),
    })
}

fn cells(source: &str, parameter: &Estimate) -> [String; 5] {
    let (value, interval) = match (parameter.std, parameter.identifiable) {
        (Some(std), true) => {
            let changes = parameter.systematic.iter().map(|one| one.change.abs());
            let (value, _) = stated(parameter.value, std, changes.fold(0.0, f64::max));
            (
                value,
                format!("± {}", crate::number_text::short(WIDE * std)),
            )
        }
        (Some(std), false) => (
            format!(
                "below {}",
                crate::number_text::short(parameter.value.abs() + 2.0 * std)
            ),
            "not seen".to_owned(),
        ),
        (None, _) if parameter.at_bound => (
            crate::number_text::short(parameter.value),
            "held by a bound of its search range".to_owned(),
        ),
        (None, _) => ("-".to_owned(), "not determined".to_owned()),
    };
    [
        parameter.name.clone(),
        source.to_owned(),
        value,
        parameter.unit.clone(),
        interval,
    ]
}
