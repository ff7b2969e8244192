//! What the page shows: the bench in words and numbers, and its drawings.

use super::model::{Model, Recordings};
use super::state::{Bench, State};
use super::words::on_the_page;
use crate::error::Error;
use serde_json::{Map, Value, json};
use servoid_engine::problem::Candidate;
use servoid_identify::fit::margins::Loop;
use servoid_results::export::FORMATS;
use servoid_results::page::{Block, Section, drawing, drawings, section};
use servoid_results::picture::{self, Estimates, LadderBar};
use servoid_results::report::html::{self, Model as Drawn, failing};
use servoid_results::schema::{Document, Estimate};
use shared::effects::{EffectSet, Kind};
use shared::encoder::FLOOR_RMS_COUNTS;

/// Most suggestions that are shown.
const SUGGESTED: usize = 6;
/// A slider goes from the value over this to the value times this.
const SLIDES: f64 = 3.0;

/// The bench in words and numbers.
pub(super) fn view(bench: &Bench) -> Value {
    let state = bench.state();
    let (undo, redo) = bench.history().has();
    json!({
        "revision": state.revision,
        "undo": undo,
        "redo": redo,
        "floor_counts": FLOOR_RMS_COUNTS,
        "recording": state.recordings.as_ref().map(recording),
        "models": state.models.iter().map(|model| entry(&state, model)).collect::<Vec<_>>(),
        "chosen": state.chosen,
        "against": state.against,
        "suggested": suggestions(&state),
        "diagnosis": state.diagnosis.as_ref().map(|d| json!({
            "verdict": d["verdict"], "summary": on_the_page(d["summary"].as_str().unwrap_or_default()), "advice": d["advice"], "cannot_tell": d["cannot_tell"],
        })),
        "race": state.race.is_some(),
        "job": bench.job.running(),
        "fault": state.fault.as_deref().map(on_the_page),
        "secret": state.secret.as_ref().map(|secret| json!({
            "seed": secret.seed,
            "told": secret.revealed.then(|| secret.hidden.described()),
        })),
        "effects": Kind::ALL.iter().map(|kind| json!({
            "name": kind.name(), "title": kind.description().title,
        })).collect::<Vec<_>>(),
        "algorithms": servoid_engine::solve::names(),
        "formats": FORMATS.iter().map(|format| format.name).collect::<Vec<_>>(),
        "version": env!("CARGO_PKG_VERSION"),
    })
}

fn recording(recordings: &Recordings) -> Value {
    let data = recordings.shown();
    json!({
        "name": data.source,
        "samples": data.len(),
        "seconds": data.time_s.last(),
        "counts_per_rev": data.units.counts_per_rev,
        "supply_v": data.supply,
        "held_out": recordings.kind().source(),
        "held_out_from_s": recordings.held_out_from(),
    })
}

fn entry(state: &State, model: &Model) -> Value {
    let fit = &model.fit;
    json!({
        "id": model.id,
        "name": model.name(),
        "effects": model.effects.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "algorithm": fit.algorithm,
        "evaluations": fit.evaluations,
        "rms_counts": fit.rms_counts,
        "held_out_rms_counts": fit.validate_rms_counts,
        "foreseen_rms_counts": model.predicted,
        "complete": !model.leaves_something(),
        "notes": fit.notes.iter().map(|note| on_the_page(note)).collect::<Vec<_>>(),
        "parameters": fit.parameters.iter().map(|p| json!({
            "name": p.name, "value": p.value, "unit": p.unit, "std": p.std, "identifiable": p.identifiable,
            "at_bound": p.at_bound,
        })).collect::<Vec<_>>(),
        "sliders": (state.chosen == Some(model.id)).then(|| sliders(&fit.candidate)),
    })
}

fn suggestions(state: &State) -> Value {
    let Some((of, list)) = &state.suggested else {
        return Value::Null;
    };
    let rank = |s: &servoid_identify::diagnose::Suggestion| {
        let description = s.effect.description();
        json!({
            "effect": s.effect.name(),
            "title": description.title,
            "equation": description.equation,
            "evidence": s.evidence,
            "believed": s.believed,
            "foreseen_rms_counts": s.model.predicted_rms_counts,
            "rms_counts": s.model.rms_counts,
            "held_out_rms_counts": s.model.validate_rms_counts,
            "chance": s.p_value,
            "looks_like": description.look_alikes,
            "exposed_by": description.exposed_by,
        })
    };
    json!({ "of": of, "list": list.iter().take(SUGGESTED).map(rank).collect::<Vec<_>>() })
}

/// Constants of a model that a slider may move, with their ranges: those of the machine as its terminals show it, then
/// those of its effects.
fn sliders(candidate: &Candidate) -> Value {
    let machine = &candidate.machine;
    let mut all = vec![
        ("machine.kb".to_owned(), machine.kb, "V*s/rad"),
        ("machine.inertia".to_owned(), machine.inertia, "V*s^2/rad"),
        ("machine.electrical".to_owned(), machine.electrical, "s"),
    ];
    if machine.damping > 0.0 {
        all.insert(
            1,
            ("machine.damping".to_owned(), machine.damping, "V*s/rad"),
        );
    }
    for (kind, values) in candidate.effects.iter() {
        for (parameter, &value) in kind.parameters().iter().zip(values) {
            let name = format!("{}.{}", kind.name(), parameter.name);
            all.push((name, value, parameter.quantity.unit()));
        }
    }
    let rows = all.into_iter().map(|(name, value, unit)| {
        let ends = [value / SLIDES, value * SLIDES];
        json!({
            "name": name, "value": value, "unit": unit,
            "low": ends[0].min(ends[1]), "high": ends[0].max(ends[1]),
        })
    });
    Value::Array(rows.collect())
}

/// A model with some of its constants moved.
///
/// # Errors
/// A name that the model does not have, or a value that is no number.
pub(super) fn moved(
    candidate: &Candidate,
    values: &Map<String, Value>,
) -> Result<Candidate, Error> {
    let mut left: Vec<&String> = values.keys().collect();
    let mut take = |name: &str, own: f64| -> Result<f64, Error> {
        let Some(value) = values.get(name) else {
            return Ok(own);
        };
        left.retain(|other| *other != name);
        (value.as_f64().filter(|x| x.is_finite()))
            .ok_or_else(|| Error::Usage(format!("{name}: `{value}` is no number")))
    };
    let mut moved = *candidate;
    let machine = &mut moved.machine;
    machine.kb = take("machine.kb", machine.kb)?;
    machine.damping = take("machine.damping", machine.damping)?;
    machine.inertia = take("machine.inertia", machine.inertia)?;
    machine.electrical = take("machine.electrical", machine.electrical)?;
    moved.effects = EffectSet::default();
    for (kind, values) in candidate.effects.iter() {
        let parameters = kind.parameters().iter().zip(values);
        let values: Vec<f64> = parameters
            .map(|(parameter, &own)| take(&format!("{}.{}", kind.name(), parameter.name), own))
            .collect::<Result<_, _>>()?;
        moved.effects.push(kind, &values)?;
    }
    match left.first() {
        None => Ok(moved),
        Some(name) => Err(Error::Usage(format!("the model has no constant `{name}`"))),
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

/// Measured against the models, the best last.
pub(super) fn timeline(recordings: &Recordings, models: &[Drawn]) -> Result<Value, Error> {
    let data = recordings.shown();
    let runs: Vec<picture::Run> = models
        .iter()
        .map(|model| model.run(data))
        .collect::<Result<_, _>>()?;
    let title = "Measured and model";
    let from = recordings.held_out_from();
    let picture = picture::timeline(
        "bench-timeline",
        title,
        data,
        &runs,
        from,
        picture::FROM_THE_BENCH,
    );
    Ok(drawing(&picture).map_or(Value::Null, |(_, drawing)| drawing))
}

/// All drawings of the bench beneath the timeline, as HTML with places, and what to draw there.
pub(super) fn pictures(bench: &Bench) -> Result<Value, Error> {
    let (recordings, models, chosen, against, race) = {
        let state = bench.state();
        let recordings = state.recordings()?;
        let find = |id: Option<usize>| id.and_then(|id| state.model(id).ok().cloned());
        (
            recordings,
            state.models.clone(),
            find(state.chosen),
            find(state.against),
            state.race.clone(),
        )
    };
    let mut shown = Vec::new();
    if let Some(model) = &against {
        shown.push(drawn(&model.name(), model));
    }
    if let Some(model) = &chosen {
        shown.push(drawn(&model.name(), model));
    }
    let timeline = timeline(&recordings, &shown)?;
    let mut sections = vec![ladder(&models)];
    if !shown.is_empty() {
        sections.extend(failing("bench", recordings.shown(), &shown)?);
    }
    if let Some(model) = &chosen {
        sections.push(parameters(model, against.as_ref()));
    }
    if let Some(Ok(Document::Contest(contest))) = race.map(Document::from_json) {
        let mut section = Section::new("bench-race", "The race");
        let title = "Best cost so far";
        let seeds = contest.seeds.len();
        let drawn = picture::cost_curves("bench-curves", title, &contest.rows, seeds);
        section.blocks.extend(drawn.map(Block::Picture));
        sections.push(section);
    }
    let html: String = sections.iter().map(section).collect();
    let drawings = drawings(&sections);
    Ok(json!({ "timeline": timeline, "html": html, "drawings": drawings }))
}

fn ladder(models: &[Model]) -> Section {
    let entries: Vec<LadderBar> = models
        .iter()
        .map(|model| LadderBar {
            name: model.name(),
            fitted: Some(model.fit.rms_counts),
            held_out: model.fit.validate_rms_counts,
        })
        .collect();
    let mut section = Section::new("bench-ladder", "The error");
    let drawn = picture::ladder("bench-error-ladder", &entries);
    section.blocks.push(Block::Picture(drawn));
    section
}

fn parameters(model: &Model, against: Option<&Model>) -> Section {
    let estimates = |model: &Model| -> Vec<Estimate> {
        let parameters = model.fit.parameters.iter();
        parameters.map(Estimate::from).collect()
    };
    let mut found = vec![(model.name(), estimates(model))];
    let mut loops = vec![(model.name(), Loop::from(&model.fit.candidate.machine))];
    if let Some(other) = against {
        found.push((other.name(), estimates(other)));
        loops.insert(0, (other.name(), Loop::from(&other.fit.candidate.machine)));
    }
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
    let bode = picture::bode("bench-bode", &loops);
    section.blocks.push(Block::Picture(bode));
    section
}

/// The report of the bench: of its diagnosis if there is one, else of the chosen model.
pub(super) fn report(bench: &Bench) -> Result<String, Error> {
    let (recordings, json) = {
        let state = bench.state();
        let recordings = state.recordings()?;
        let json = match (&state.diagnosis, state.chosen) {
            (Some(diagnosis), _) => diagnosis.clone(),
            (None, Some(id)) => state.model(id)?.json(&recordings)?,
            (None, None) => {
                return Err(Error::Usage("nothing is fitted yet; fit first".to_owned()));
            }
        };
        (recordings, json)
    };
    let document = Document::from_json(json).map_err(|fault| Error::Failed(fault.to_string()))?;
    let drawn = html::Recordings {
        fitted: Some(recordings.shown()),
        held_out: recordings.kind().source().map(|_| recordings.parts().1),
    };
    Ok(html::page(&document, drawn)?.render())
}
