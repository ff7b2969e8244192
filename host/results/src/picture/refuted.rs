//! Where a model is refuted: the few readings that no model of its structure meets together, along the recording.

use super::chart::{Chart, marker, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use crate::schema::certificate::{Certificate, Contradicting};

/// Most points of the drawn recording.
const MOST_POINTS: usize = 4000;
/// Size of a reading's mark, pixels.
const MARK: usize = 12;

/// Draws the contradicting readings of a certificate on the measured angle (s, counts). `None` where there are none.
pub fn refuted(id: &str, certificate: &Certificate, measured: &[(f64, f64)]) -> Option<Picture> {
    if certificate.contradiction.is_empty() {
        return None;
    }
    let every = measured.len().div_ceil(MOST_POINTS).max(1);
    let (times, counts): (Vec<f64>, Vec<f64>) = measured.iter().step_by(every).copied().unzip();
    let mut plot = Chart::default();
    plot.add(
        scatter(times, counts)
            .set("name", "measured")
            .set("mode", "lines")
            .set("line", stroke(colour::MEASURED, 1.2)),
    );
    for (above, name, symbol) in [
        (true, "models lie above", "triangle-up"),
        (false, "models lie below", "triangle-down"),
    ] {
        let some = certificate
            .contradiction
            .iter()
            .filter(|reading| reading.above == above);
        let (times, counts): (Vec<f64>, Vec<f64>) = some
            .map(|reading| (rounded(reading.time_s), reading.counts))
            .unzip();
        if !times.is_empty() {
            plot.add(
                scatter(times, counts)
                    .set("name", name)
                    .set("mode", "markers")
                    .set("marker", marker(colour::MODEL, MARK).set("symbol", symbol)),
            );
        }
    }
    plot.lay_out(
        layout(340)
            .set("xaxis", axis("time, s"))
            .set("yaxis", axis("angle, counts")),
    );
    let mut table = Table::new(&[
        "time, s",
        "reading, counts",
        "models that meet the others lie",
    ]);
    for reading in &certificate.contradiction {
        table.row([
            reading.time_s.to_string(),
            reading.counts.to_string(),
            side(reading).to_owned(),
        ]);
    }
    Some(Picture {
        id: id.to_owned(),
        title: "Where the model is refuted".to_owned(),
        caption: format!(
            "No model of this structure near the fit meets these {} readings together: each misses one of them by {:.3} counts \
             at least.",
            certificate.contradiction.len(),
            -certificate.room_counts
        ),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    })
}

fn side(reading: &Contradicting) -> &'static str {
    if reading.above { "above" } else { "below" }
}
