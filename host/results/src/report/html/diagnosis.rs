//! The page of a diagnosis.

use super::fit::{model, named};
use super::{
    Model, OVERLAY, Recordings, failing, found, no_recording, parameters, recording_facts,
    timelines,
};
use crate::error::Error;
use crate::page::{Block, Page, Section};
use crate::picture::{self, Judged, LadderBar, Table};
use crate::report::diagnosis::bars::counts;
use crate::report::diagnosis::nothing_else;
use crate::schema::diagnosis::{Errors, Step};
use crate::schema::{Demo, Diagnosis};
use servoid_identify::diagnose::FloorKind;
use servoid_identify::fit::margins::Loop;
use servoid_io::recording::Drive;

/// Candidates that are listed for each step.
const LISTED: usize = 8;

pub(super) fn page(diagnosis: &Diagnosis, recordings: Recordings<'_>) -> Result<Page, Error> {
    let base = model("linear motor", &diagnosis.base.model, "base.model")?;
    let last = model(
        &named(&diagnosis.last.effects),
        &diagnosis.last.model,
        "final.model",
    )?;
    let loops = [&base, &last].map(|m| (m.name.clone(), Loop::from(&m.candidate.machine)));
    // A linear motor that explains all stands alone.
    let models: Vec<Model> = if diagnosis.last.effects.is_empty() {
        vec![last]
    } else {
        vec![base, last]
    };
    let mut sections = vec![
        ladder(diagnosis),
        found(&diagnosis.last.parameters),
        seen(diagnosis, recordings, &models)?,
    ];
    sections.extend(named_effects(diagnosis));
    sections.push(next(diagnosis));
    if let Some(data) = recordings.fitted {
        sections.extend(failing("model", data, &models)?);
    }
    let last = &diagnosis.last;
    let loops = &loops[2 - models.len()..];
    sections.push(parameters(
        "this diagnosis",
        &last.parameters,
        &last.notes,
        loops,
    ));
    let mut facts = recording_facts(recordings, &diagnosis.recording);
    facts.push(("held out, never fitted".to_owned(), held_out(diagnosis)));
    facts.push(("verdict".to_owned(), diagnosis.verdict.replace('_', " ")));
    facts.push(("seed".to_owned(), diagnosis.seed.to_string()));
    Ok(Page {
        title: format!("Diagnosis of {}", diagnosis.recording),
        lead: lead(diagnosis),
        facts,
        sections,
    })
}

/// What a demonstration hid, and how near the diagnosis came.
pub(super) fn truth(demo: &Demo) -> Section {
    let mut truth = Section::new("truth", "The truth");
    truth.blocks.push(Block::Text(format!(
        "This motor was made by the virtual bench, which shares no code with the model. Hidden in it was {}.",
        demo.hidden.as_deref().unwrap_or("nothing")
    )));
    if !demo.parameter_errors.is_empty() {
        let mut table = Table::new(&["parameter", "off by, %"]);
        for miss in &demo.parameter_errors {
            let name = format!("{}.{}", miss.effect, miss.parameter);
            table.row([name, format!("{:.4}", miss.percent)]);
        }
        let caption = "How far off the diagnosis is".to_owned();
        truth.blocks.push(Block::Table(caption, table));
    }
    truth
}

fn lead(diagnosis: &Diagnosis) -> Vec<String> {
    let mut lead = vec![diagnosis.summary.clone()];
    if diagnosis.interrupted {
        lead.push("The work was stopped by the user: this is the best so far.".to_owned());
    }
    lead
}

fn held_out(diagnosis: &Diagnosis) -> String {
    let held_out = &diagnosis.held_out;
    match (&held_out.source, held_out.from_s) {
        (Some(source), _) => source.clone(),
        (None, Some(from)) => format!("its end, from {from:.3} s on"),
        (None, None) => "nothing".to_owned(),
    }
}

fn ladder(diagnosis: &Diagnosis) -> Section {
    let bar = |name: String, whole: [Option<f64>; 2], windowed: Option<Errors>| {
        let [fitted, held_out] =
            windowed.map_or(whole, |own| [own.rms_counts, own.validate_rms_counts]);
        LadderBar {
            name,
            fitted,
            held_out,
        }
    };
    let (base, last) = (&diagnosis.base, &diagnosis.last);
    let whole = [base.rms_counts, base.validate_rms_counts];
    let mut entries = vec![bar("linear motor".to_owned(), whole, base.windowed)];
    entries.extend(diagnosis.steps.iter().map(|step| {
        let whole = [step.rms_counts, step.validate_rms_counts];
        bar(format!("+ {}", step.added), whole, step.windowed)
    }));
    let windowed = diagnosis
        .prediction
        .filter(|_| diagnosis.window_s.is_some());
    let windowed = windowed.map(|own| Errors {
        rms_counts: Some(own.windowed_rms_counts),
        validate_rms_counts: Some(own.validate_windowed_rms_counts),
    });
    if let Some(entry) = entries.last_mut() {
        let whole = [last.rms_counts, last.validate_rms_counts];
        if diagnosis.window_s.is_none() || windowed.is_some() {
            *entry = bar(entry.name.clone(), whole, windowed);
        }
    }
    let floor = diagnosis.floor.as_ref();
    let floor = floor.filter(|floor| floor.kind == FloorKind::Repeatability.name());
    let judged = Judged {
        window_s: diagnosis.window_s,
        repeatability: floor.and_then(|floor| floor.counts),
    };
    let mut section = Section::new("ladder", "The error falls");
    if diagnosis.steps.is_empty() {
        section.heading = "The error".to_owned();
    }
    section.blocks.push(Block::Picture(picture::ladder(
        "error-ladder",
        &entries,
        &judged,
    )));
    section
}

fn seen(
    diagnosis: &Diagnosis,
    recordings: Recordings<'_>,
    models: &[Model],
) -> Result<Section, Error> {
    let mut section = Section::new(OVERLAY, "Measured and model");
    let titles = [
        "The fitted recording",
        "The recording that was never fitted",
    ];
    section.blocks = timelines(titles, recordings, models, diagnosis.held_out.from_s)?;
    if recordings.fitted.is_none() {
        let text = no_recording(&diagnosis.recording);
        section.blocks.push(Block::Text(text));
    }
    if !diagnosis.remarks.is_empty() {
        section.blocks.push(Block::List(diagnosis.remarks.clone()));
    }
    Ok(section)
}

/// One section for each effect that was added.
fn named_effects(diagnosis: &Diagnosis) -> Vec<Section> {
    let steps = diagnosis.steps.iter().enumerate();
    let stopped = diagnosis.interrupted || diagnosis.ran_out;
    let symbol = Drive::by_name(&diagnosis.drive).map_or("V", Drive::symbol);
    steps
        .map(|(k, step)| effect(k, step, stopped, symbol))
        .collect()
}

fn effect(index: usize, step: &Step, stopped: bool, symbol: &str) -> Section {
    let description = servoid_formula::by_name(&step.added).map(|kind| kind.description());
    let title = description.map_or("", |d| d.title);
    let heading = format!("{}. {}: {title}", index + 1, step.added);
    let mut section = Section::new(&format!("effect-{}", index + 1), &heading);
    let mut facts = Table::new(&["", ""]);
    let mut say = |name: &str, text: String| facts.row([name.to_owned(), text]);
    if let Some(description) = description {
        say("equation", description.equation.to_owned());
    }
    say("evidence", step.evidence.clone());
    say("looks alike here", company(step, stopped));
    if let Some(confidence) = step.confidence {
        say("confidence", format!("{:.0} %", 100.0 * confidence));
    }
    if let (Some(foreseen), Some(reached)) = (step.foreseen_rms_counts, step.rms_counts) {
        say(
            "foreseen",
            format!(
                "{} counts RMS before the refit; {} reached",
                counts(foreseen),
                counts(reached)
            ),
        );
    }
    section.blocks.push(Block::Table(String::new(), facts));
    if let Some(curve) = &step.curve {
        let id = format!("curve-{}", index + 1);
        section.blocks.push(Block::Picture(picture::effect_curve(
            &id,
            &step.added,
            curve,
            symbol,
        )));
    }
    if !step.candidates.is_empty() {
        section.blocks.push(Block::Table(
            "What was tried here, best first".to_owned(),
            candidates(step),
        ));
    }
    section
}

/// Other effects that explain the data as well, in the words of the terminal.
fn company(step: &Step, stopped: bool) -> String {
    let refines = |name: &&String| step.refined_by.contains(name);
    let alike: Vec<String> = (step.indistinguishable_from.iter())
        .filter(|name| !refines(name))
        .cloned()
        .collect();
    let mut text = if alike.is_empty() {
        nothing_else(stopped).to_owned()
    } else {
        format!("{} would explain these data as well", alike.join(", "))
    };
    if !step.refined_by.is_empty() {
        text += &format!(
            "; {} would refine it, and these data do not ask for that",
            step.refined_by.join(" or ")
        );
    }
    text
}

fn candidates(step: &Step) -> Table {
    let mut table = Table::new(&[
        "effect",
        "fitted, counts RMS",
        "held out, counts RMS",
        "foreseen",
        "chance",
    ]);
    for candidate in step.candidates.iter().take(LISTED) {
        let cell = |value: Option<f64>| value.map_or("-".to_owned(), counts);
        table.row([
            candidate.effect.clone(),
            cell(candidate.rms_counts),
            cell(candidate.validate_rms_counts),
            cell(candidate.foreseen_rms_counts),
            candidate.p_value.map_or("-".to_owned(), chance),
        ]);
    }
    table
}

/// A chance, which may be far smaller than any number that is worth its digits.
fn chance(p: f64) -> String {
    if p < 1e-9 {
        "below 1e-9".to_owned()
    } else {
        format!("{p:.1e}")
    }
}

fn next(diagnosis: &Diagnosis) -> Section {
    let mut section = Section::new("next", "What to do next, and what stays open");
    if let Some(effect) = &diagnosis.not_named {
        section.blocks.push(Block::Text(format!(
            "{effect} would reduce what is left the most, but not beyond doubt: it is not named."
        )));
    }
    if diagnosis.advice.is_empty() {
        section.blocks.push(Block::Text(
            match diagnosis.verdict.as_str() {
                "complete" | "missing_effects" => {
                    "Nothing more needs to be recorded to name what is missing."
                }
                _ => {
                    "What is missing is not named, and these data do not tell which recording would name it: see below where \
                     the last model fails."
                }
            }
            .to_owned(),
        ));
    } else {
        section.blocks.push(Block::List(diagnosis.advice.clone()));
    }
    if !diagnosis.cannot_tell.is_empty() {
        section
            .blocks
            .push(Block::Text("These recordings cannot tell:".to_owned()));
        section
            .blocks
            .push(Block::List(diagnosis.cannot_tell.clone()));
    }
    section
}
