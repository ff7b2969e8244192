//! The drawings of the tabs beneath the lanes.

use super::model::Model;
use super::state::Bench;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_engine::problem::Data;
use servoid_identify::fit::margins::Loop;
use servoid_results::page::{Block, Section, drawings, section};
use servoid_results::picture::{self, Estimates};
use servoid_results::report::html::{Model as Drawn, missing_drive, whether_noise};
use servoid_results::schema::{Document, Estimate};

/// A tab.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tab {
    /// What is missing, against everything that could tell why.
    Maps,
    /// Frequency response of the position loop.
    Response,
    /// The sample clock.
    Clock,
    /// What the recording does not tell: intervals, correlations of the error.
    Limits,
    /// The race of search methods.
    Race,
}

impl Tab {
    const ALL: [Tab; 5] = [Tab::Maps, Tab::Response, Tab::Clock, Tab::Limits, Tab::Race];

    /// Its name in addresses.
    pub(super) fn name(self) -> &'static str {
        match self {
            Tab::Maps => "maps",
            Tab::Response => "response",
            Tab::Clock => "clock",
            Tab::Limits => "limits",
            Tab::Race => "race",
        }
    }

    /// The tab of that name.
    ///
    /// # Errors
    /// A name that no tab has.
    pub(super) fn by_name(name: &str) -> Result<Self, Error> {
        let found = Tab::ALL.into_iter().find(|tab| tab.name() == name);
        found.ok_or_else(|| Error::Usage(format!("there is no tab `{name}`")))
    }

    /// Its drawings: HTML with places, and what to draw there.
    ///
    /// # Errors
    /// Where a model cannot run.
    pub(super) fn drawn(self, bench: &Bench) -> Result<Value, Error> {
        let sections = self.sections(bench)?;
        let html: String = sections.iter().map(section).collect();
        Ok(json!({ "html": html, "drawings": drawings(&sections) }))
    }

    fn sections(self, bench: &Bench) -> Result<Vec<Section>, Error> {
        let (recordings, mut models, race) = {
            let state = bench.state();
            (state.recordings()?, state.both(), state.race.clone())
        };
        // The one that is looked at lies on top.
        models.reverse();
        let drawn: Vec<Drawn> = models
            .iter()
            .map(|model| drawn(&model.name(), model))
            .collect();
        let data = recordings.shown();
        Ok(match self {
            Tab::Maps => missing_drive("bench", data, &drawn)?.into_iter().collect(),
            Tab::Response => response(&models),
            Tab::Clock => clock(data),
            Tab::Limits => {
                let mut sections = intervals(&models);
                sections.extend(whether_noise("bench", data, &drawn)?);
                sections
            }
            Tab::Race => raced(race),
        })
    }
}

/// A model as it is drawn.
pub(super) fn drawn(name: &str, model: &Model) -> Drawn {
    Drawn {
        name: name.to_owned(),
        candidate: model.fit.candidate,
        method: model.fit.method,
    }
}

/// The frequency response of each model.
fn response(models: &[Model]) -> Vec<Section> {
    let loops: Vec<_> = models
        .iter()
        .map(|model| (model.name(), Loop::from(&model.fit.candidate.machine)))
        .collect();
    if loops.is_empty() {
        return Vec::new();
    }
    let mut section = Section::new("bench-response", "Frequency response");
    let bode = picture::bode("bench-bode", &loops);
    section.blocks.push(Block::Picture(bode));
    vec![section]
}

fn clock(data: &Data) -> Vec<Section> {
    let mut section = Section::new("bench-clock", "Sample clock");
    let drawn = picture::intervals("bench-clock-intervals", data);
    section.blocks.extend(drawn.map(Block::Picture));
    vec![section]
}

/// The intervals of each model's parameters.
fn intervals(models: &[Model]) -> Vec<Section> {
    let found: Vec<(String, Vec<Estimate>)> = models
        .iter()
        .rev()
        .map(|model| {
            (
                model.name(),
                model.fit.parameters.iter().map(Estimate::from).collect(),
            )
        })
        .collect();
    let sources: Vec<Estimates<'_>> = found
        .iter()
        .map(|(name, parameters)| Estimates {
            name: name.clone(),
            parameters,
        })
        .collect();
    let mut section = Section::new("bench-parameters", "Parameters");
    let forest = picture::forest("bench-forest", &sources);
    section.blocks.extend(forest.map(Block::Picture));
    vec![section]
}

fn raced(race: Option<Value>) -> Vec<Section> {
    let Some(Ok(Document::Contest(contest))) = race.map(Document::from_json) else {
        return Vec::new();
    };
    let mut section = Section::new("bench-race", "The race");
    let title = "Best cost so far";
    let seeds = contest.seeds.len();
    let drawn = picture::cost_curves("bench-curves", title, &contest.rows, seeds);
    section.blocks.extend(drawn.map(Block::Picture));
    vec![section]
}
