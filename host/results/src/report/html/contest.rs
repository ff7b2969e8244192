//! The page of a comparison of search methods, and of the paper's.

use crate::number_text::short;
use crate::page::{Block, Page, Section};
use crate::picture::{self, Table};
use crate::schema::contest::{Row, Runs};
use crate::schema::{Contest, Margins};
use servoid_identify::fit::margins::Loop;
use shared::motor::Physical;

pub(super) fn page(contest: &Contest) -> Page {
    let is_paper = contest.rows.iter().any(|row| row.paper.is_some());
    let seeds = contest.seeds.len();
    let mut sections = Vec::new();
    let mut curves = Section::new("curves", "Cost against evaluations");
    if contest.variants().is_empty() {
        let title = "Best cost so far";
        curves.blocks.extend(
            picture::cost_curves("cost-curves", title, &contest.rows, seeds).map(Block::Picture),
        );
    }
    for (k, variant) in contest.variants().iter().enumerate() {
        let title = match variant.truth_cost {
            Some(cost) => format!("{} (the true motor costs {})", variant.name, short(cost)),
            None => variant.name.clone(),
        };
        let id = format!("cost-curves-{k}");
        let drawn = picture::cost_curves(&id, &title, &variant.rows, seeds);
        curves.blocks.extend(drawn.map(Block::Picture));
    }
    sections.push(curves);
    if is_paper {
        sections.push(printed(contest));
    }
    let loops = loops(contest);
    if !loops.is_empty() {
        let mut bode = Section::new("loops", "Position loops");
        bode.blocks
            .push(Block::Picture(picture::bode("bode", &loops)));
        sections.push(bode);
    }
    Page {
        title: if is_paper {
            "The paper's comparison, run again".to_owned()
        } else {
            "Search methods compared".to_owned()
        },
        lead: vec![lead(contest)],
        facts: vec![
            ("seeds".to_owned(), seeds.to_string()),
            (
                "model evaluations of each run".to_owned(),
                contest.budget.to_string(),
            ),
        ],
        sections,
    }
}

/// Which method leads, and by what.
fn lead(contest: &Contest) -> String {
    let mut rows: Vec<(&Row, &Runs)> = (contest.rows.iter())
        .filter_map(|row| Some((row, row.runs.as_ref()?)))
        .filter(|(_, runs)| runs.median_cost.is_some())
        .collect();
    rows.sort_by(|(_, a), (_, b)| {
        let cost = |runs: &Runs| runs.median_cost.unwrap_or(f64::INFINITY);
        let work = |runs: &Runs| runs.median_evaluations_to_1pct.unwrap_or(f64::INFINITY);
        cost(a)
            .total_cmp(&cost(b))
            .then(work(a).total_cmp(&work(b)))
    });
    let Some((best, best_runs)) = rows.first() else {
        return "No method found a model of finite cost.".to_owned();
    };
    let fastest = rows
        .iter()
        .filter_map(|(row, runs)| Some((row, runs.median_evaluations_to_1pct?)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let quick = fastest.map_or(String::new(), |(row, n)| {
        format!(
            " Within 1 % of the least cost {} is first, after a median of {n:.0} model evaluations.",
            row.algorithm
        )
    });
    format!(
        "At {} model evaluations a run and over {} seeds, {} has the least median cost ({}).{quick}",
        contest.budget,
        contest.seeds.len(),
        best.algorithm,
        best_runs.median_cost.map_or("-".to_owned(), short)
    )
}

/// The paper's table beside ours.
fn printed(contest: &Contest) -> Section {
    let mut table = Table::new(&[
        "method",
        "paper's cost",
        "our median cost",
        "our best",
        "paper's margins as printed",
        "from its parameters",
        "ours, best run",
    ]);
    let cost = |x: Option<f64>| x.map_or("-".to_owned(), short);
    for row in &contest.rows {
        let Some(paper) = &row.paper else { continue };
        let ours = row.runs.as_ref();
        table.row([
            row.algorithm.clone(),
            cost(paper.cost),
            cost(ours.and_then(|runs| runs.median_cost)),
            cost(ours.and_then(|runs| runs.best_cost)),
            margins(Some(paper.margins_printed)),
            margins(paper.margins_computed),
            margins(ours.and_then(|runs| runs.margins)),
        ]);
    }
    let mut section = Section::new("table", "Table 1 of the paper, and ours");
    section.blocks.push(Block::Table(String::new(), table));
    section
}

fn margins(margins: Option<Margins>) -> String {
    let Some(m) = margins else {
        return "-".to_owned();
    };
    let gain = m
        .gain_db
        .map_or("infinite".to_owned(), |db| format!("{db:.1} dB"));
    format!("{gain}, {:.1}°", m.phase_deg)
}

/// The loops of the actual motor and of each method: ours, and the paper's where there are any.
fn loops(contest: &Contest) -> Vec<(String, Loop)> {
    let mut loops = Vec::new();
    for row in &contest.rows {
        if let Some(paper) = &row.paper {
            let of = |name: &str| paper.parameters.get(name).copied();
            let physical = (|| {
                Some(Physical {
                    resistance: of("resistance")?,
                    inductance: of("inductance")?,
                    kt: of("kt")?,
                    kb: of("kb")?,
                    inertia: of("inertia")?,
                    viscous: of("viscous")?,
                })
            })();
            let name = if row.algorithm == "actual" {
                "actual".to_owned()
            } else {
                format!("paper's {}", row.algorithm)
            };
            loops.extend(physical.map(|p: Physical<f64>| (name, Loop::from(&p.machine()))));
        }
        if let Some(l) = row.runs.as_ref().and_then(|runs| runs.position_loop) {
            let name = if row.paper.is_some() {
                format!("our {}, best run", row.algorithm)
            } else {
                format!("{}, best run", row.algorithm)
            };
            loops.push((name, Loop::from(l)));
        }
    }
    loops
}
