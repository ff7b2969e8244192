//! A motor's steady speed against its voltage, and what a straight line misses of it.

use super::chart::{Chart, marker, scatter, stroke};
use super::{Drawing, Picture, Table, axis, colour, layout, rounded};

/// A line `V = slope·ω + drop·sign ω` through steady speeds.
pub struct SteadyLine {
    /// What it is called.
    pub name: &'static str,
    /// V·s/rad.
    pub slope: f64,
    /// V.
    pub drop_v: f64,
}

impl SteadyLine {
    fn volts(&self, speed: f64) -> f64 {
        self.slope * speed + self.drop_v * sign(speed)
    }
}

/// Zero at standstill, where a drop can have any size.
fn sign(speed: f64) -> f64 {
    if speed == 0.0 { 0.0 } else { speed.signum() }
}

/// Measured points (V, rad/s) and lines through them.
pub fn steady_curve(id: &str, points: &[(f64, f64)], lines: &[SteadyLine]) -> Picture {
    let mut plot = Chart::default();
    let measured = scatter(
        points.iter().map(|p| rounded(p.1)).collect::<Vec<_>>(),
        points.iter().map(|p| rounded(p.0)).collect::<Vec<_>>(),
    );
    plot.add(
        measured
            .set("name", "measured")
            .set("mode", "markers")
            .set("marker", marker(colour::MEASURED, 8)),
    );
    let ends = ends(points);
    for (line, colour) in lines.iter().zip([colour::BASE, colour::MODEL]) {
        let drawn = scatter(
            ends.iter().map(|speed| rounded(*speed)).collect::<Vec<_>>(),
            ends.iter()
                .map(|speed| rounded(line.volts(*speed)))
                .collect::<Vec<_>>(),
        );
        plot.add(
            drawn
                .set("name", line.name)
                .set("mode", "lines")
                .set("line", stroke(colour, 1.5)),
        );
    }
    plot.lay_out(
        layout(360)
            .set("xaxis", axis("steady speed, rad/s"))
            .set("yaxis", axis("voltage, V").set("zeroline", true)),
    );
    let mut table = Table::new(&["voltage, V", "speed, rad/s"]);
    for (volts, speed) in points {
        table.row([volts.to_string(), speed.to_string()]);
    }
    Picture {
        id: id.to_owned(),
        title: "Voltage against steady speed".to_owned(),
        caption: "An unloaded motor with viscous friction alone follows a straight line through the origin; a constant \
                  loss shifts each half of it away from there."
            .to_owned(),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    }
}

/// What each line misses at each point.
pub fn steady_residual(id: &str, points: &[(f64, f64)], lines: &[SteadyLine]) -> Picture {
    let mut plot = Chart::default();
    let mut head = vec!["speed, rad/s".to_owned()];
    head.extend(
        lines
            .iter()
            .map(|line| format!("missed by {}, V", line.name)),
    );
    let mut table = Table {
        head,
        rows: Vec::new(),
    };
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (line, colour) in lines.iter().zip([colour::BASE, colour::MODEL]) {
        let missed = scatter(
            sorted.iter().map(|p| rounded(p.1)).collect::<Vec<_>>(),
            sorted
                .iter()
                .map(|p| rounded(p.0 - line.volts(p.1)))
                .collect::<Vec<_>>(),
        );
        plot.add(
            missed
                .set("name", line.name)
                .set("mode", "lines+markers")
                .set("line", stroke(colour, 1.5))
                .set("marker", marker(colour, 7)),
        );
    }
    for (volts, speed) in &sorted {
        let missed = lines
            .iter()
            .map(|line| format!("{:+.4}", volts - line.volts(*speed)));
        table.row(std::iter::once(speed.to_string()).chain(missed));
    }
    plot.lay_out(
        layout(320)
            .set("xaxis", axis("steady speed, rad/s"))
            .set("yaxis", axis("missing, V").set("zeroline", true)),
    );
    Picture {
        id: id.to_owned(),
        title: "What a straight line misses".to_owned(),
        caption: "Measured less the line. What is left should scatter about zero; a bend that comes back in both \
                  directions is physics."
            .to_owned(),
        drawing: Drawing::Chart(plot),
        table: Some(table),
    }
}

/// Speeds between which lines are drawn, with both sides of standstill where the motor was driven both ways.
fn ends(points: &[(f64, f64)]) -> Vec<f64> {
    let speeds = || points.iter().map(|p| p.1);
    let low = speeds().fold(0.0, f64::min);
    let high = speeds().fold(0.0, f64::max);
    let near = 1e-6 * high.max(-low);
    let mut ends = Vec::new();
    if low < 0.0 {
        ends.extend([low, -near]);
    }
    if high > 0.0 {
        ends.extend([near, high]);
    }
    ends
}
