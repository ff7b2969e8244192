//! The page of a curve of steady speeds.

use crate::page::{Block, Page, Section};
use crate::picture::{self, SteadyLine, Table};
use crate::schema::Steady;

pub(super) fn page(found: &Steady) -> Page {
    let curve = &found.steady;
    let lines = [
        SteadyLine {
            name: "a line through the origin",
            slope: curve.linear.slope_v_s_rad,
            drop_v: 0.0,
        },
        SteadyLine {
            name: "with a constant drop",
            slope: curve.with_drop.slope_v_s_rad,
            drop_v: curve.with_drop.drop_v,
        },
    ];
    let mut drawn = Section::new("curve", "The curve");
    for picture in [
        picture::steady_curve("steady-curve", &curve.curve, &lines),
        picture::steady_residual("steady-residual", &curve.curve, &lines),
    ] {
        drawn.blocks.push(Block::Picture(picture));
    }
    let mut fits = Table::new(&[
        "model",
        "slope, V*s/rad",
        "drop, V",
        "error, % of the voltage",
    ]);
    for (line, fit) in lines.iter().zip([&curve.linear, &curve.with_drop]) {
        fits.row([
            line.name.to_owned(),
            format!("{:.5}", line.slope),
            format!("{:.4}", line.drop_v),
            format!("{:.2}", 100.0 * fit.relative),
        ]);
    }
    drawn
        .blocks
        .push(Block::Table("The two lines".to_owned(), fits));
    let mut sections = vec![drawn];
    if !curve.indistinguishable.is_empty() || !found.advice.is_empty() {
        sections.push(next(found));
    }
    Page {
        title: format!("Diagnosis of {}", found.recording),
        lead: vec![found.summary.clone()],
        facts: vec![
            ("curve".to_owned(), found.recording.clone()),
            ("points".to_owned(), curve.curve.len().to_string()),
            ("verdict".to_owned(), found.verdict.replace('_', " ")),
        ],
        sections,
    }
}

fn next(found: &Steady) -> Section {
    let mut section = Section::new("next", "What to do next, and what stays open");
    let alike = &found.steady.indistinguishable;
    if !alike.is_empty() {
        section.blocks.push(Block::Text(format!(
            "Steady speeds cannot tell which of these takes the drop: {}.",
            alike.join(", ")
        )));
    }
    if !found.advice.is_empty() {
        section.blocks.push(Block::List(found.advice.clone()));
    }
    section
}
