//! Lines of the missing volts in the angle, forward above and backward mirrored below: a torque of the magnets stands
//! at the same orders in both directions.

use super::chart::{Chart, Properties, bars};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use servoid_identify::residual_analysis::{Line, Spectrum};

/// Orders that are drawn: as many as are the strongest of each direction.
const STRONGEST: usize = 12;

/// Draws the strongest lines of what the `model` misses, and those of the orders that are `named` in a model; `None` where
/// the motor never turned slowly enough.
pub fn orders(
    id: &str,
    model: &str,
    spectrum: &Spectrum,
    named: &[usize],
    symbol: &str,
) -> Option<Picture> {
    if spectrum.forward.is_empty() && spectrum.backward.is_empty() {
        return None;
    }
    let strongest = |lines: &[Line]| -> Vec<usize> {
        lines
            .iter()
            .take(STRONGEST)
            .map(|line| line.order)
            .collect()
    };
    let mut drawn = strongest(&spectrum.forward);
    drawn.extend(strongest(&spectrum.backward));
    drawn.extend_from_slice(named);
    let mut plot = Chart::default();
    let mut table = Table::new(&[
        "direction",
        "order",
        &format!("amplitude, {symbol}"),
        "crest, degrees",
        "of the missing, %",
    ]);
    for (name, lines, sign, colour) in [
        ("forward", &spectrum.forward, 1.0, colour::MODEL),
        ("backward", &spectrum.backward, -1.0, colour::QUIET),
    ] {
        let mut lines: Vec<&Line> = (lines.iter())
            .filter(|line| drawn.contains(&line.order))
            .collect();
        for line in &lines {
            table.row([
                name.to_owned(),
                line.order.to_string(),
                format!("{:.4}", line.volts),
                format!("{:.0}", line.phase_deg),
                format!("{:.1}", 100.0 * line.share),
            ]);
        }
        lines.sort_by_key(|line| line.order);
        let orders: Vec<usize> = lines.iter().map(|line| line.order).collect();
        let volts: Vec<f64> = lines
            .iter()
            .map(|line| rounded(sign * line.volts))
            .collect();
        plot.add(
            bars(orders, volts)
                .set("name", name)
                .set("marker", Properties::default().set("color", colour))
                .set(
                    "hovertemplate",
                    format!("order %{{x}}: %{{y:.4f}} {symbol}"),
                ),
        );
    }
    plot.lay_out(
        layout(320)
            .set("barmode", "overlay")
            .set("xaxis", axis("order, waves a revolution"))
            .set(
                "yaxis",
                axis(&format!("amplitude, {symbol} (backward mirrored)")).set("zeroline", true),
            ),
    );
    Some(Picture {
        id: id.to_owned(),
        title: "Order spectrum of what is missing".to_owned(),
        caption: format!(
            "Amplitude of each wave in the shaft's angle in what the {model} misses, forward upwards and backward \
             downwards: the {STRONGEST} strongest orders of each direction. Cogging and an unbalanced load stand at the \
             same orders in both directions, as high in both; what stands in one only is something else, or chance. Low \
             orders also pick up friction that changes with the speed."
        ),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}
