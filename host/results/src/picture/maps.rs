//! The command that a model's equation misses, volts at the winding for a voltage, along the measured motion, against everything that could tell why.

use super::chart::{Chart, Properties, marker, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::number_text::short;
use servoid_identify::residual_analysis::{Against, Bin, Map, ResidualAnalysis};

/// Half the width of a drawn interval, standard errors.
const WIDE: f64 = 2.0;

/// One drawing for each quantity: each of `models` with its name.
pub fn maps(id: &str, models: &[(&str, &ResidualAnalysis)], symbol: &'static str) -> Vec<Picture> {
    let all = Against::ALL.iter();
    all.filter_map(|&against| map(id, against, models, symbol))
        .collect()
}

fn map(
    id: &str,
    against: Against,
    models: &[(&str, &ResidualAnalysis)],
    symbol: &'static str,
) -> Option<Picture> {
    let (name, unit) = (against.name().0, against.unit(symbol));
    let name = name.replace('_', " ");
    let split = if against == Against::Speed {
        " Triangles point the way the shaft turned."
    } else {
        ""
    };
    let mut plot = Chart::default();
    let mut table = Table::new(&[
        "model",
        "from",
        "to",
        &format!("missing, {symbol}"),
        &format!("± {symbol}"),
        "samples",
    ]);
    let mut said = Vec::new();
    for (k, (model, found)) in models.iter().enumerate() {
        let Some(map) = found.map(against) else {
            continue;
        };
        let colour = [colour::BASE, colour::MODEL][k.min(1)];
        for line in lines(against, map, model, colour) {
            plot.add(line);
        }
        if map.beyond_chance {
            said.push(format!(
                "with the {model}, {:.0} % of what is missing depends on it",
                100.0 * map.share
            ));
        }
        for bin in &map.bins {
            table.row([
                (*model).to_owned(),
                short(bin.low),
                short(bin.high),
                format!("{:+.4}", bin.mean_v),
                format!("{:.4}", WIDE * bin.error_v),
                bin.samples.to_string(),
            ]);
        }
    }
    if table.rows.is_empty() {
        return None;
    }
    plot.lay_out(
        layout(320)
            .set("xaxis", axis(&format!("{name}, {unit}")))
            .set(
                "yaxis",
                axis(&format!("missing, {symbol}")).set("zeroline", true),
            ),
    );
    let turned = matches!(against, Against::Time | Against::Reversal);
    let sign = if turned {
        "against the motion"
    } else {
        "against forward motion"
    };
    let said = if said.is_empty() {
        "nothing depends on it beyond chance".to_owned()
    } else {
        said.join("; ")
    };
    Some(Picture {
        id: format!("{id}-{}", against.name().0.replace('_', "-")),
        title: format!("What is missing, against {name}"),
        caption: format!(
            "Command, in {symbol}, that the model's equation misses along the measured motion, mean and two standard \
             errors in each bin; a torque {sign} counts positive: {said}.{split}"
        ),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}

/// The bins of a map as a line; against speed one for each direction, since friction changes its sign there.
fn lines(against: Against, map: &Map, model: &str, colour: &'static str) -> Vec<Properties> {
    let middle = |bin: &Bin| 0.5 * (bin.low + bin.high);
    let parts: Vec<(String, Vec<&Bin>)> = if against == Against::Speed {
        let side = |forward: bool| -> Vec<&Bin> {
            let bins = map.bins.iter();
            bins.filter(|bin| (middle(bin) > 0.0) == forward).collect()
        };
        vec![
            (model.to_owned(), side(false)),
            (model.to_owned(), side(true)),
        ]
    } else {
        vec![(model.to_owned(), map.bins.iter().collect())]
    };
    parts
        .into_iter()
        .filter(|(_, bins)| !bins.is_empty())
        .enumerate()
        .map(|(part, (name, bins))| {
            let x: Vec<f64> = bins.iter().map(|bin| rounded(middle(bin))).collect();
            let y: Vec<f64> = bins.iter().map(|bin| rounded(bin.mean_v)).collect();
            // A bin whose error is not known is drawn without.
            let known = |x: f64| if x.is_finite() { rounded(x) } else { 0.0 };
            let wide: Vec<f64> = bins.iter().map(|bin| known(WIDE * bin.error_v)).collect();
            let symbol = if part == 0 && against == Against::Speed {
                "triangle-left"
            } else if against == Against::Speed {
                "triangle-right"
            } else {
                "circle"
            };
            let line: Properties = scatter(x, y)
                .set("name", name)
                .set("legendgroup", model)
                .set("showlegend", part == 0)
                .set("mode", "lines+markers")
                .set("line", stroke(colour, 1.5))
                .set("marker", marker(colour, 8).set("symbol", symbol))
                .set(
                    "error_y",
                    Properties::default()
                        .set("type", "data")
                        .set("array", wide)
                        .set("color", colour)
                        .set("thickness", 1.0),
                );
            line
        })
        .collect()
}
