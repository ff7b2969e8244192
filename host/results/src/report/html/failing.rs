//! Where models fail on a recording: what is missing against everything that could tell why, and whether anything is
//! left but the encoder.

use super::waves::waves;
use crate::error::Error;
use crate::page::{Block, Section};
use crate::picture;
use servoid_engine::problem::{Candidate, Data};
use servoid_engine::simulation::Method;
use servoid_identify::residual_analysis::{
    Correlations, ResidualAnalysis, analyse_residual, correlations,
};
use shared::effects::Kind;

/// A model with its name.
pub struct Model {
    /// As in `linear motor`.
    pub name: String,
    /// The model.
    pub candidate: Candidate,
    /// How it is run.
    pub method: Method,
}

impl Model {
    /// Its free run along the recording that it was fitted to.
    ///
    /// # Errors
    /// Where it cannot run.
    pub fn run(&self, data: &Data) -> Result<picture::Run, Error> {
        picture::Run::fitted(&self.name, data, &self.candidate, self.method)
    }

    /// Its free run along a recording that it has not seen.
    ///
    /// # Errors
    /// Where it cannot run.
    pub fn run_unseen(&self, data: &Data) -> Result<picture::Run, Error> {
        picture::Run::held_out(&self.name, data, &self.candidate, self.method)
    }
}

/// The drawings of where `models` fail on `data`, the best model last; ids begin with `id`.
///
/// # Errors
/// Where a model cannot run.
pub fn failing(id: &str, data: &Data, models: &[Model]) -> Result<Vec<Section>, Error> {
    let fails = missing_drive(id, data, models)?;
    Ok(fails
        .into_iter()
        .chain(whether_noise(id, data, models)?)
        .collect())
}

/// What is missing against everything that could tell why; nothing without a model.
///
/// # Errors
/// Where a model cannot run.
pub fn missing_drive(id: &str, data: &Data, models: &[Model]) -> Result<Option<Section>, Error> {
    let Some(best) = models.last() else {
        return Ok(None);
    };
    let mut found: Vec<(&str, ResidualAnalysis)> = Vec::new();
    for model in models {
        let at = analyse_residual(data, &model.candidate, &best.candidate, best.method)?;
        found.push((&model.name, at));
    }
    let mut fails = Section::new(&format!("{id}-where"), "Where it fails");
    let maps: Vec<(&str, &ResidualAnalysis)> = found.iter().map(|(n, w)| (*n, w)).collect();
    fails
        .blocks
        .push(Block::Text(missing(&found, data.drive.symbol())));
    let mut pictures = picture::maps(&format!("{id}-against"), &maps, data.drive.symbol());
    // What a wave in the angle explains shows only without it.
    let (name, flat) = match without_waves(&best.candidate) {
        Some(flat) => (
            format!("{} without its effects of the angle", best.name),
            flat,
        ),
        None => (best.name.clone(), best.candidate),
    };
    let lines = waves(data, &flat);
    let named = orders_of(&best.candidate);
    pictures.extend(picture::orders(
        &format!("{id}-orders"),
        &name,
        &lines,
        &named,
        data.drive.symbol(),
    ));
    fails.blocks.push(Block::Pictures(pictures));
    Ok(Some(fails))
}

/// Whether anything is left but the encoder; nothing without a model.
///
/// # Errors
/// Where a model cannot run.
pub fn whether_noise(id: &str, data: &Data, models: &[Model]) -> Result<Option<Section>, Error> {
    if models.is_empty() {
        return Ok(None);
    }
    let mut related: Vec<(&str, Correlations)> = Vec::new();
    for model in models {
        let run = model.run(data)?;
        if let Some(correlations) = correlations(data, &run.residual) {
            related.push((&model.name, correlations));
        }
    }
    let mut noise = Section::new(&format!("{id}-noise"), "Is the rest noise?");
    let related: Vec<(&str, &Correlations)> = related.iter().map(|(n, c)| (*n, c)).collect();
    if !related.is_empty() {
        let drawn = picture::correlations(&format!("{id}-correlations"), &related);
        noise.blocks.push(Block::Picture(drawn));
    }
    let drawn = picture::intervals(&format!("{id}-intervals"), data);
    noise.blocks.extend(drawn.map(Block::Picture));
    Ok(Some(noise))
}

/// The model without its effects of the angle; `None` if it has none.
fn without_waves(candidate: &Candidate) -> Option<Candidate> {
    let waves = |kind: Kind| kind.periodic_torque().is_some();
    let any = candidate.effects.iter().any(|(kind, _)| waves(kind));
    any.then(|| candidate.keeping(|kind| !waves(kind)))
}

/// Orders of the waves that a model names.
fn orders_of(candidate: &Candidate) -> Vec<usize> {
    let orders = candidate
        .effects
        .iter()
        .filter_map(|(kind, values)| kind.periodic_torque()?.of(values));
    orders.collect()
}

fn missing(found: &[(&str, ResidualAnalysis)], symbol: &str) -> String {
    let said: Vec<String> = found
        .iter()
        .map(|(name, found)| {
            let most = found.most().map_or(String::new(), |map| {
                let (against, share) = (map.against.name().0.replace('_', " "), map.share);
                let percent = format!("{:.0} %", 100.0 * share);
                if share > 0.5 {
                    format!(", most of it ({percent}) against {against}")
                } else {
                    format!(", of which the largest part, {percent}, depends on {against}")
                }
            });
            format!(
                "the {name} misses {:.4} {symbol} RMS{most}",
                found.volts_rms
            )
        })
        .collect();
    let perfect = found.last().map_or(0.0, |(_, w)| w.perfect_volts_rms);
    format!(
        "Along the measured motion {}; a perfect model would show {perfect:.4} {symbol} here, which is the encoder's.",
        said.join(", and ")
    )
}
