//! The fleet as a page.

use crate::error::{Error, content};
use crate::population::Population;
use crate::quantity::Scale;
use crate::summary::{Fleet, Summary};
use crate::text::{effects, findings, lead};
use serde_json::Value;
use servoid_results::number_text::short;
use servoid_results::page::{Block, Page, Section, Unfold};
use servoid_results::picture::{Distribution, Table, distribution};
use servoid_results::report::html::{self, Recordings};
use servoid_results::schema::Document;
use std::collections::HashMap;

/// Odd units that the page lists.
const LISTED: usize = 200;

/// The page of a fleet, with its population where there are motors enough for one. What was found of its odd recordings unfolds there.
///
/// # Errors
/// A folder that cannot be read any more, or a result in it that is none.
pub fn page(
    fleet: &Fleet,
    summary: &Summary,
    population: Option<&Population>,
) -> Result<Page, Error> {
    let mut sections = vec![distributions(fleet, population)];
    sections.extend(odd(summary, own_pages(fleet)?));
    sections.extend(population.map(of_population));
    sections.extend(named(summary));
    sections.extend(compared(summary));
    sections.extend(gauge(summary));
    sections.extend(refused(summary));
    let refused: usize = summary.refused.iter().map(|cause| cause.recordings).sum();
    Ok(Page {
        title: "Fleet".to_owned(),
        lead: lead(summary),
        facts: [
            ("results", summary.results.clone()),
            ("recordings with a result", summary.recordings.to_string()),
            ("motors", summary.motors.to_string()),
            ("odd", summary.odd.len().to_string()),
            ("without a result", refused.to_string()),
            ("servoid of the batch", summary.version.clone()),
        ]
        .map(|(name, value)| (name.to_owned(), value))
        .to_vec(),
        sections,
    })
}

/// The page of one recording's own result, without drawings of its motion.
///
/// # Errors
/// What is no result.
pub fn unit_page(name: &str, result: &Value) -> Result<Page, Error> {
    let document = Document::from_json(result.clone()).map_err(content(name))?;
    html::page(&document, Recordings::default()).map_err(content(name))
}

/// The pages of the listed odd recordings, by their names.
fn own_pages(fleet: &Fleet) -> Result<HashMap<String, Page>, Error> {
    let results = fleet.odd_results(LISTED)?.into_iter();
    let page_of = |(name, text): (String, String)| {
        let result = serde_json::from_str(&text).map_err(content(&name))?;
        let mut page = unit_page(&name, &result)?;
        // Where the motion is drawn, which is not at hand here.
        page.sections.retain(|section| section.id != html::OVERLAY);
        Ok((name, page))
    };
    results.map(page_of).collect()
}

fn distributions(fleet: &Fleet, population: Option<&Population>) -> Section {
    let mut section = Section::new("parameters", "Parameters");
    section.blocks.push(Block::Text(
        "Each bar counts recordings. The line is the population with each recording's own uncertainty taken off; diamonds are \
         recordings that are odd by this parameter, and a click on one unfolds what was found of it."
            .to_owned(),
    ));
    let table = fleet.table();
    let mut drawn = Vec::new();
    for (k, quantity) in table.quantities.iter().enumerate() {
        let (mut usual, mut odd) = (Vec::new(), Vec::new());
        for (unit, reading) in table.column(k) {
            let value = quantity.scale.raise(reading.y);
            if fleet.is_odd_by(unit, &quantity.name) {
                odd.push((fleet.units()[unit].name.clone(), value));
            } else {
                usual.push(value);
            }
        }
        let member = population.and_then(|population| {
            let mut members = population.parameters.iter();
            members.find(|member| member.name == quantity.name)
        });
        let shown = Distribution {
            name: &quantity.name,
            unit: &quantity.unit,
            usual: &usual,
            odd: &odd,
            curve: member.map(|member| (member.centre, member.spread)),
            logarithmic: quantity.scale == Scale::Log,
        };
        drawn.extend(distribution(&format!("distribution-{k}"), &shown));
    }
    section.blocks.push(Block::Pictures(drawn));
    section
}

fn odd(summary: &Summary, mut own: HashMap<String, Page>) -> Option<Section> {
    if summary.odd.is_empty() {
        return None;
    }
    let mut section = Section::new("odd", "Recordings that are not like the others");
    let listed = match summary.odd.len().checked_sub(LISTED) {
        Some(more) if more > 0 => format!("The oddest {LISTED}; {more} more are in the JSON."),
        _ => "The oddest first.".to_owned(),
    };
    section.blocks.push(Block::Text(format!(
        "At most one in twenty of these is expected to be a usual one. {listed} A click on one unfolds what was found of it; its page \
         with the drawings: servoid fleet {} --unit NAME --report FILE",
        summary.results
    )));
    let unfolds = summary.odd.iter().take(LISTED).map(|odd| {
        let motor = odd.serial.as_ref().map(|serial| format!("motor {serial}"));
        let p = odd.p_value.map(|p| format!("p {p:.0e}"));
        let reasons = odd.reasons.iter().map(|reason| reason.text.clone());
        let line: Vec<String> = motor.into_iter().chain(reasons).chain(p).collect();
        Unfold {
            name: odd.unit.clone(),
            line: line.join("; "),
            blocks: own.remove(&odd.unit).map_or_else(Vec::new, Page::words),
        }
    });
    section.blocks.push(Block::Unfolds(unfolds.collect()));
    Some(section)
}

fn of_population(population: &Population) -> Section {
    let mut section = Section::new("population", "Population");
    section.blocks.push(Block::Text(format!(
        "{} motors with {}. Means and standard deviations are between motors; intervals are of 95 %.",
        population.motors,
        effects(&population.effects)
    )));
    let mut table = Table::new(&["parameter", "unit", "mean", "interval", "std", "interval"]);
    for member in &population.parameters {
        table.row([
            member.name.clone(),
            member.unit.clone(),
            short(member.mean.value),
            format!("{} .. {}", short(member.mean.low), short(member.mean.high)),
            short(member.std.value),
            format!("{} .. {}", short(member.std.low), short(member.std.high)),
        ]);
    }
    section
        .blocks
        .push(Block::Table("Parameters".to_owned(), table));
    let names: Vec<&str> = population
        .parameters
        .iter()
        .map(|p| p.name.as_str())
        .collect();
    if names.len() > 1 {
        let mut head = vec![""];
        head.extend(&names);
        let mut table = Table::new(&head);
        for (name, row) in names.iter().zip(&population.correlation) {
            let cells = row.iter().map(|r| format!("{r:.2}"));
            table.row(std::iter::once((*name).to_owned()).chain(cells));
        }
        section
            .blocks
            .push(Block::Table("Correlations".to_owned(), table));
    }
    section
}

fn named(summary: &Summary) -> Option<Section> {
    let mut section = Section::new("effects", "Effects");
    let mut table = Table::new(&["effects", "recordings"]);
    for set in &summary.effects {
        table.row([effects(&set.effects), set.recordings.to_string()]);
    }
    section
        .blocks
        .push(Block::Table("Sets of effects".to_owned(), table));
    for (what, groups) in [("lot", &summary.lots), ("station", &summary.stations)] {
        if groups.is_empty() {
            continue;
        }
        let mut table = Table::new(&[what, "recordings", "effects"]);
        for group in groups {
            let named: Vec<String> = group
                .effects
                .iter()
                .map(|(name, count)| format!("{name} {count}"))
                .collect();
            table.row([
                if group.name.is_empty() {
                    "not said".to_owned()
                } else {
                    group.name.clone()
                },
                group.recordings.to_string(),
                named.join(", "),
            ]);
        }
        section
            .blocks
            .push(Block::Table(format!("By {what}"), table));
    }
    (!summary.effects.is_empty()).then_some(section)
}

fn compared(summary: &Summary) -> Option<Section> {
    let tested =
        summary.lot_differences.len() + summary.station_differences.len() + summary.drifts.len();
    if tested == 0 {
        return None;
    }
    let mut section = Section::new("compared", "Lots, stations and time");
    let said = findings(summary);
    section.blocks.push(if said.is_empty() {
        Block::Text(format!(
            "None of {tested} comparisons shows a difference (p below 0.01 for all together)."
        ))
    } else {
        Block::List(said)
    });
    Some(section)
}

fn gauge(summary: &Summary) -> Option<Section> {
    if summary.gauges.is_empty() {
        return None;
    }
    let mut section = Section::new("gauge", "Repeatability and reproducibility");
    section.blocks.push(Block::Text(
        "Motors that were recorded more than once tell what part of all differences is the measurement's: below 10 % is good, \
         above 30 % is not acceptable (AIAG). Standard deviations are in the parameter's scale, as in the population."
            .to_owned(),
    ));
    let mut table = Table::new(&[
        "parameter",
        "motors",
        "recordings",
        "repeatability",
        "reproducibility",
        "between motors",
        "part, %",
    ]);
    for gauge in &summary.gauges {
        table.row([
            gauge.quantity.clone(),
            gauge.motors.to_string(),
            gauge.recordings.to_string(),
            short(gauge.repeatability),
            gauge
                .reproducibility
                .map_or_else(|| "one station".to_owned(), short),
            short(gauge.motor_to_motor),
            format!("{:.1}", gauge.percent),
        ]);
    }
    section
        .blocks
        .push(Block::Table("Standard deviations".to_owned(), table));
    Some(section)
}

fn refused(summary: &Summary) -> Option<Section> {
    if summary.refused.is_empty() {
        return None;
    }
    let mut section = Section::new("refused", "Recordings without a result");
    let mut table = Table::new(&["cause", "recordings", "one of them", "what was said of it"]);
    for cause in &summary.refused {
        table.row([
            cause.cause.clone(),
            cause.recordings.to_string(),
            cause.example.clone(),
            cause.message.clone(),
        ]);
    }
    section
        .blocks
        .push(Block::Table("By cause".to_owned(), table));
    Some(section)
}
