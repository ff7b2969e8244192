//! The residual's correlation with itself and with the command, with honest bands (Ljung, *System Identification*, 1999,
//! section 16.6).

use super::{Drawing, Picture, axis, colour, layout, rounded};
use plotly::common::{DashType, Line, Marker, Mode};
use plotly::layout::{LayoutGrid, Shape, ShapeLayer, ShapeLine, ShapeType};
use plotly::{Bar, Plot, Scatter};
use servoid_identify::diagnose::residual_analysis::Correlations;

/// Half the width of the drawn band, standard deviations: nineteen of twenty independent values lie within.
const WIDE: f64 = 1.96;

/// Draws the correlations of the residuals of `models`, each with its name.
pub fn correlations(id: &str, models: &[(&str, &Correlations)]) -> Picture {
    let mut plot = Plot::new();
    for (k, (name, found)) in models.iter().enumerate() {
        let colour = [colour::BASE, colour::MODEL][k.min(1)];
        let lags: Vec<usize> = (0..found.own.len()).collect();
        let own: Vec<f64> = found.own.iter().map(|r| rounded(*r)).collect();
        plot.add_trace(
            Bar::new(lags, own)
                .name(*name)
                .legend_group(*name)
                .marker(Marker::new().color(colour)),
        );
        let first = -(found.input.len() as i64 / 2);
        let lags: Vec<i64> = (0..found.input.len() as i64).map(|k| first + k).collect();
        let input: Vec<f64> = found.input.iter().map(|r| rounded(*r)).collect();
        plot.add_trace(
            Scatter::new(lags, input)
                .name(*name)
                .legend_group(*name)
                .show_legend(false)
                .mode(Mode::LinesMarkers)
                .line(Line::new().color(colour).width(1.5))
                .marker(Marker::new().color(colour).size(5))
                .x_axis("x2")
                .y_axis("y2"),
        );
    }
    let mut shapes = Vec::new();
    if let Some((_, last)) = models.last() {
        let band = WIDE / last.effective_samples.max(1.0).sqrt();
        for (x, y) in [("x domain", "y"), ("x2 domain", "y2")] {
            for side in [-band, band] {
                shapes.push(
                    Shape::new()
                        .shape_type(ShapeType::Line)
                        .layer(ShapeLayer::Above)
                        .x_ref(x)
                        .y_ref(y)
                        .x0(0)
                        .x1(1)
                        .y0(rounded(side))
                        .y1(rounded(side))
                        .line(
                            ShapeLine::new()
                                .color(colour::FLOOR)
                                .dash(DashType::Dash)
                                .width(1.5),
                        ),
                );
            }
        }
    }
    plot.set_layout(
        layout(340)
            .grid(
                LayoutGrid::new()
                    .rows(1)
                    .columns(2)
                    .pattern(plotly::layout::GridPattern::Independent),
            )
            .x_axis(axis("lag, samples"))
            .y_axis(axis("with itself").range(vec![-1.05, 1.05]))
            .x_axis2(axis("lead of the command, samples"))
            .y_axis2(axis("with the command"))
            .shapes(shapes),
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
        drawing: Drawing::Chart(Box::new(plot)),
        table: None,
    }
}
