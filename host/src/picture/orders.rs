//! Lines of the missing volts in the angle, forward above and backward mirrored below: a torque of the magnets stands
//! at the same orders in both directions.

use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::diagnose::whereabouts::{Line, Whereabouts};
use plotly::common::Marker;
use plotly::layout::BarMode;
use plotly::{Bar, Plot};

/// Lines in the table, for each direction.
const TOLD: usize = 8;

/// Draws the lines of what `found` says that the `model` misses; `None` where the motor never turned slowly enough.
pub fn orders(id: &str, model: &str, found: &Whereabouts) -> Option<Picture> {
    let spectrum = &found.spectrum;
    if spectrum.forward.is_empty() && spectrum.backward.is_empty() {
        return None;
    }
    let mut plot = Plot::new();
    let mut table = Table::new(&["direction", "order", "amplitude, V", "crest, degrees"]);
    for (name, lines, sign, colour) in [
        ("forward", &spectrum.forward, 1.0, colour::MEASURED),
        ("backward", &spectrum.backward, -1.0, colour::MODEL),
    ] {
        let mut lines: Vec<&Line> = lines.iter().collect();
        for line in lines.iter().take(TOLD) {
            table.row([
                name.to_owned(),
                line.order.to_string(),
                format!("{:.4}", line.volts),
                format!("{:.0}", line.phase_deg),
            ]);
        }
        lines.sort_by_key(|line| line.order);
        let orders: Vec<usize> = lines.iter().map(|line| line.order).collect();
        let volts: Vec<f64> = lines
            .iter()
            .map(|line| rounded(sign * line.volts))
            .collect();
        plot.add_trace(
            Bar::new(orders, volts)
                .name(name)
                .marker(Marker::new().color(colour))
                .hover_template("order %{x}: %{y:.4f} V"),
        );
    }
    plot.set_layout(
        layout(320)
            .bar_mode(BarMode::Overlay)
            .x_axis(axis("order, waves a revolution"))
            .y_axis(axis("amplitude, V (backward mirrored)").zero_line(true)),
    );
    Some(Picture {
        id: id.to_owned(),
        title: "Order spectrum of what is missing".to_owned(),
        caption: format!(
            "Amplitude of each wave in the shaft's angle in what the {model} misses, forward upwards and backward \
             downwards. Cogging and an unbalanced load stand at the same orders in both directions; what stands in one \
             only is something else."
        ),
        drawing: Drawing::Chart(Box::new(plot)),
        table: Some(table),
    })
}
