//! A result as a page: the verdict in words, then the drawings, from the result's JSON and its recordings. So a page
//! made today and one made from a file next year are the same.
//!
//! | file | makes the page of |
//! |---|---|
//! | `diagnosis` | `diagnose`, and of `demo` and `device verify`, which hold one |
//! | `fit` | `fit` |
//! | `steady` | `diagnose` of a curve of steady speeds |
//! | `contest` | `compare` and `paper` |
//! | `device` | a motor that commissioned itself |
//! | `belongs` | whether recordings are those that a result was made from |
//! | `waves` | lines of the missing volts in the angle |
//! | `failing` | drawings of where models fail, for several of these |

mod belongs;
mod contest;
mod device;
mod diagnosis;
mod failing;
mod fit;
mod steady;
mod waves;

pub use belongs::doubts;
pub use failing::{Model, failing, missing_drive, whether_noise};

use crate::error::Error;
use crate::number_text::{rough, short};
use crate::page::{Block, Page, Section};
use crate::picture::{self, Drawing, Estimates, Picture, Run, Table};
use crate::schema::{Document, Estimate};
use servoid_engine::problem::Data;
use servoid_identify::fit::Cause;
use servoid_identify::fit::margins::Loop;

/// Id of the section in which the motion is drawn, of a page of one model.
pub const OVERLAY: &str = "overlay";

/// The recordings that a result was made from, as far as they are at hand.
#[derive(Clone, Copy, Default)]
pub struct Recordings<'a> {
    /// The fitted one.
    pub fitted: Option<&'a Data>,
    /// The one that was never fitted.
    pub held_out: Option<&'a Data>,
}

/// The page of a result.
///
/// # Errors
/// A model in it that is none, or that cannot run along the recordings.
pub fn page(document: &Document, recordings: Recordings<'_>) -> Result<Page, Error> {
    match document {
        Document::Fit(fit) => fit::page(fit, recordings),
        Document::Demo(demo) => match &demo.diagnosis {
            Some(diagnosis) => {
                let mut page = diagnosis::page(diagnosis, recordings)?;
                page.sections.push(diagnosis::truth(demo));
                Ok(page)
            }
            None => fit::page(&demo.fit, recordings),
        },
        Document::Diagnosis(diagnosis) => diagnosis::page(diagnosis, recordings),
        Document::Steady(steady) => Ok(steady::page(steady)),
        Document::Contest(contest) => Ok(contest::page(contest)),
        Document::Verification(verification) => device::verification(verification, recordings),
        Document::Device(run, _) => device::page(run, recordings),
    }
}

/// What a page says of a recording.
fn recording_facts(recordings: Recordings<'_>, source: &str) -> Vec<(String, String)> {
    let mut facts = vec![("recording".to_owned(), source.to_owned())];
    if let Some(data) = recordings.fitted {
        let seconds = data.time_s.last().copied().unwrap_or(0.0);
        facts.push((
            "length".to_owned(),
            format!("{seconds:.3} s, {} samples", data.len()),
        ));
        facts.push((
            "encoder".to_owned(),
            format!("{} counts a revolution", data.units.counts_per_rev),
        ));
    }
    facts
}

/// Measured against `models`: the fitted recording, and the one that was not fitted, as far as they are at hand. The end of
/// the fitted one may be held out, from `held_out_from` s on.
fn timelines(
    titles: [&str; 2],
    recordings: Recordings<'_>,
    models: &[Model],
    held_out_from: Option<f64>,
) -> Result<Vec<Block>, Error> {
    let draw = |id: &str, title: &str, data: &Data, runs: Vec<Run>, from: Option<f64>| {
        let drawn = picture::timeline(id, title, data, &runs, from, picture::IN_A_FILE);
        Block::Picture(drawn)
    };
    let mut blocks = Vec::new();
    if let Some(data) = recordings.fitted {
        let runs = models.iter().map(|model| model.run(data));
        let runs = runs.collect::<Result<_, _>>()?;
        blocks.push(draw("timeline", titles[0], data, runs, held_out_from));
    }
    if let Some(data) = recordings.held_out {
        let runs = models.iter().map(|model| model.run_unseen(data));
        let runs = runs.collect::<Result<_, _>>()?;
        blocks.push(draw("timeline-held-out", titles[1], data, runs, None));
    }
    Ok(blocks)
}

/// The parameters in one table, for who reads no further.
fn found(parameters: &[Estimate]) -> Section {
    let mut table = Table::new(&["parameter", "value", "± (95 %)", "unit"]);
    for p in parameters {
        let wide = match (p.std, p.at_bound) {
            (_, true) => "at a bound of its search".to_owned(),
            (Some(std), _) if p.identifiable => short(SURE * std),
            (None, _) if p.identifiable => "known".to_owned(),
            _ => "not determined".to_owned(),
        };
        let value = if p.identifiable {
            short(p.value)
        } else {
            "-".to_owned()
        };
        table.row([p.name.clone(), value, wide, p.unit.clone()]);
    }
    let mut section = Section::new("found", "The motor");
    let caption = "Parameters of the last model".to_owned();
    section.blocks.push(Block::Table(caption, table));
    section
}

/// Half the width of an interval of 95 %, standard errors.
const SURE: f64 = 1.96;

/// Parameters with their intervals, notes on them, and position loops.
fn parameters(
    source: &str,
    parameters: &[Estimate],
    notes: &[String],
    loops: &[(String, Loop)],
) -> Section {
    let sources = [Estimates {
        name: source.to_owned(),
        parameters,
    }];
    let mut section = Section::new("parameters", "Parameters");
    let forest = picture::forest("forest", &sources);
    section.blocks.extend(forest.map(Block::Picture));
    section
        .blocks
        .extend(systematic(parameters).map(Block::Picture));
    if !notes.is_empty() {
        section.blocks.push(Block::List(notes.to_vec()));
    }
    let bode = picture::bode("bode", loops);
    section.blocks.push(Block::Picture(bode));
    section
}

/// What the parameters change by if the recording is not what it says.
fn systematic(parameters: &[Estimate]) -> Option<Picture> {
    let known = parameters.iter().filter(|p| !p.systematic.is_empty());
    let mut head = vec!["parameter".to_owned()];
    head.extend(Cause::ALL.map(super::systematic::words));
    head.push("unit".to_owned());
    let mut table = Table {
        head,
        rows: Vec::new(),
    };
    for p in known {
        let change = |cause: Cause| {
            let own = p.systematic.iter().find(|s| s.cause == cause.name());
            own.map_or("-".to_owned(), |s| rough(s.change.abs()))
        };
        let changes = Cause::ALL.map(change);
        let cells = std::iter::once(p.name.clone()).chain(changes);
        table.row(cells.chain([p.unit.clone()]));
    }
    (!table.rows.is_empty()).then(|| Picture {
        id: "systematic".to_owned(),
        title: "Systematic errors".to_owned(),
        caption: "Standard errors are of readings that scatter. These are what a parameter would be off by if the command acted later \
                  than the log says, if the encoder's edges were displaced, or if the command were larger."
            .to_owned(),
        drawing: Drawing::Nothing,
        table: Some(table),
    })
}

/// A remark in the place of the drawings of a recording that is not at hand.
fn no_recording(source: &str) -> String {
    format!(
        "The drawings of the recording itself are left out: {source} was not found when this page was made. Name it with \
         --recording."
    )
}
