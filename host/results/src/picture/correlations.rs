//! The residual's correlation with itself and with the command, with honest bands (Ljung, *System Identification*, 1999,
//! section 16.6).

use super::chart::{Chart, Properties, bars, marker, scatter, stroke};
use super::{Drawing, Picture, axis, colour, layout, rounded};
use servoid_identify::residual_analysis::Correlations;

/// Half the width of the drawn band, standard deviations: nineteen of twenty independent values lie within.
const WIDE: f64 = 1.96;

/// Draws the correlations of the residuals of `models`, each with its name.
pub fn correlations(id: &str, models: &[(&str, &Correlations)]) -> Picture {
    let mut plot = Chart::default();
    for (k, (name, found)) in models.iter().enumerate() {
        let colour = [colour::BASE, colour::MODEL][k.min(1)];
        let lags: Vec<usize> = (0..found.own.len()).collect();
        let own: Vec<f64> = found.own.iter().map(|r| rounded(*r)).collect();
        plot.add(
            bars(lags, own)
                .set("name", *name)
                .set("legendgroup", *name)
                .set("marker", Properties::default().set("color", colour)),
        );
        let first = -(found.input.len() as i64 / 2);
        let lags: Vec<i64> = (0..found.input.len() as i64).map(|k| first + k).collect();
        let input: Vec<f64> = found.input.iter().map(|r| rounded(*r)).collect();
        plot.add(
            scatter(lags, input)
                .set("name", *name)
                .set("legendgroup", *name)
                .set("showlegend", false)
                .set("mode", "lines+markers")
                .set("line", stroke(colour, 1.5))
                .set("marker", marker(colour, 5))
                .set("xaxis", "x2")
                .set("yaxis", "y2"),
        );
    }
    let mut shapes = Vec::new();
    if let Some((_, last)) = models.last() {
        let band = WIDE / last.effective_samples.max(1.0).sqrt();
        for (x, y) in [("x domain", "y"), ("x2 domain", "y2")] {
            for side in [-band, band] {
                shapes.push(
                    Properties::default()
                        .set("type", "line")
                        .set("layer", "above")
                        .set("xref", x)
                        .set("yref", y)
                        .set("x0", 0)
                        .set("x1", 1)
                        .set("y0", rounded(side))
                        .set("y1", rounded(side))
                        .set(
                            "line",
                            Properties::default()
                                .set("color", colour::FLOOR)
                                .set("dash", "dash")
                                .set("width", 1.5),
                        ),
                );
            }
        }
    }
    plot.lay_out(
        layout(340)
            .set(
                "grid",
                Properties::default()
                    .set("rows", 1)
                    .set("columns", 2)
                    .set("pattern", "independent"),
            )
            .set("xaxis", axis("lag, samples"))
            .set("yaxis", axis("with itself").set("range", vec![-1.05, 1.05]))
            .set("xaxis2", axis("lead of the command, samples"))
            .set("yaxis2", axis("with the command"))
            .set("shapes", shapes),
    );
    let samples = models
        .last()
        .map_or((0, 0.0), |(_, last)| (last.samples, last.effective_samples));
    Picture {
        id: id.to_owned(),
        title: "Is anything left but the encoder?".to_owned(),
        caption: format!(
            "Correlation of the residual with itself and with the command. Samples count only where the reading moved on \
             ({} of them, worth {:.0} independent ones): a motor at rest repeats one error a thousand times. Dashed: where \
             nineteen of twenty correlations of so many independent samples would lie.",
            samples.0, samples.1
        ),
        drawing: Drawing::Chart(plot),
        table: None,
    }
}
