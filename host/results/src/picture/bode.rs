//! Bode plot of several position loops, with the lines at which margins are read.

use super::chart::{Chart, Properties, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};
use servoid_identify::fit::margins::Loop;

const POINTS: usize = 240;

/// Draws the loops, each with its name, over the decades around their crossovers.
pub fn bode(id: &str, loops: &[(String, Loop)]) -> Picture {
    let (from, to) = span(loops);
    let frequencies: Vec<f64> = (0..=POINTS)
        .map(|k| rounded(from * (to / from).powf(k as f64 / POINTS as f64)))
        .collect();
    let mut plot = Chart::default();
    let mut table = Table::new(&["loop", "gain margin, dB", "phase margin, degrees"]);
    for (k, (name, l)) in loops.iter().enumerate() {
        // Equal loops lie on each other: the wide ones below, so that all show.
        let width = 1.5 + 1.2 * (loops.len() - 1 - k) as f64;
        let line = || {
            Properties::default()
                .set("color", colour::of(loops.len() - 1 - k))
                .set("width", width)
                .set("simplify", false)
        };
        let of = |value: fn((f64, f64)) -> f64| -> Vec<f64> {
            let values = frequencies.iter().map(|&w| rounded(value(l.response(w))));
            values.collect()
        };
        plot.add(
            scatter(frequencies.clone(), of(|(size, _)| 20.0 * size.log10()))
                .set("name", name)
                .set("legendgroup", name)
                .set("mode", "lines")
                .set("line", line()),
        );
        plot.add(
            scatter(frequencies.clone(), of(|(_, phase)| phase))
                .set("name", name)
                .set("legendgroup", name)
                .set("showlegend", false)
                .set("mode", "lines")
                .set("line", line())
                .set("yaxis", "y2"),
        );
        let cells = match l.margins() {
            Some(m) if m.gain_db.is_finite() => {
                [format!("{:.1}", m.gain_db), format!("{:.1}", m.phase_deg)]
            }
            Some(m) => ["infinite".to_owned(), format!("{:.1}", m.phase_deg)],
            None => ["-".to_owned(), "-".to_owned()],
        };
        let [gain, phase] = cells;
        table.row([name.clone(), gain, phase]);
    }
    for (mark, pane) in [(0.0, "y"), (-180.0, "y2")] {
        plot.add(
            scatter(vec![rounded(from), rounded(to)], vec![mark; 2])
                .set("mode", "lines")
                .set("showlegend", false)
                .set("hoverinfo", "skip")
                .set("line", stroke(colour::QUIET, 1.0).set("dash", "dash"))
                .set("yaxis", pane),
        );
    }
    plot.lay_out(
        layout(520)
            .set(
                "xaxis",
                axis("frequency, rad/s")
                    .set("type", "log")
                    .set("anchor", "y2"),
            )
            .set(
                "yaxis",
                axis("magnitude, dB(rad/V)").set("domain", [0.54, 1.0]),
            )
            .set(
                "yaxis2",
                axis("phase, degrees")
                    .set("domain", [0.0, 0.46])
                    .set("range", vec![-280.0, -80.0]),
            ),
    );
    Picture {
        id: id.to_owned(),
        title: "Position loop".to_owned(),
        caption: "Angle per volt of the linear motor, closed with unity feedback in radians as in the paper. The gain \
                  margin is read where the phase crosses -180 degrees, the phase margin where the magnitude crosses 0 dB."
            .to_owned(),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    }
}

/// Frequencies to draw, rad/s: around the corners of all loops.
fn span(loops: &[(String, Loop)]) -> (f64, f64) {
    let corners: Vec<f64> = loops
        .iter()
        .flat_map(|(_, l)| [l.a1 / l.a2, (l.a1 / l.a3).sqrt(), 1.0 / l.a1])
        .filter(|w| w.is_finite() && *w > 0.0)
        .collect();
    let low = corners.iter().copied().fold(f64::INFINITY, f64::min);
    let high = corners.iter().copied().fold(0.0, f64::max);
    if low.is_finite() {
        ((0.1 * low).max(1e-3), (10.0 * high).min(1e7))
    } else {
        (0.1, 1e3)
    }
}
