//! The page of a fit.

use super::{
    Model, OVERLAY, Recordings, failing, found, no_recording, parameters, recording_facts,
    timelines,
};
use crate::error::Error;
use crate::page::{Block, Page, Section};
use crate::picture::{self, Drawing, Judged, LadderBar, Picture, Table};
use crate::report::diagnosis::bars::counts;
use crate::report::repeats;
use crate::schema::certificate::Certificate;
use crate::schema::{self, Fit};
use servoid_engine::problem::Data;
use servoid_identify::fit::margins::Loop;
use shared::encoder::FLOOR_RMS_COUNTS;

pub(super) fn page(fit: &Fit, recordings: Recordings<'_>) -> Result<Page, Error> {
    let model = model(&fit.name(), &fit.model, "model")?;
    let mut seen = Section::new(OVERLAY, "Measured and model");
    let models = [model];
    if recordings.fitted.is_some() {
        let titles = [
            "The fitted recording",
            "The recording that was never fitted",
        ];
        seen.blocks = timelines(titles, recordings, &models, None)?;
    } else {
        seen.blocks.push(Block::Text(no_recording(&fit.recording)));
    }
    let mut sections = vec![found(&fit.parameters), seen];
    if fit.ladder.len() > 1 {
        let mut ladder = Section::new("ladder", "What each effect brings");
        ladder.blocks.push(Block::Picture(picture::ladder(
            "error-ladder",
            &entries(fit),
            &Judged::default(),
        )));
        sections.push(ladder);
    }
    sections.extend(
        fit.certificate
            .as_ref()
            .map(|c| certificate(c, recordings.fitted)),
    );
    if let Some(data) = recordings.fitted {
        sections.extend(failing("model", data, &models)?);
    }
    let loops = models.map(|model| (fit.name(), Loop::from(&model.candidate.machine)));
    sections.push(parameters(
        &fit.algorithm,
        &fit.parameters,
        &fit.notes,
        &loops,
    ));
    let drawn = picture::profiles("profiles", &fit.profiles);
    sections.extend(drawn.map(|drawn| {
        let mut section = Section::new("profile", "How far each parameter may go");
        section.blocks.push(Block::Picture(drawn));
        section
    }));
    let mut facts = recording_facts(recordings, &fit.recording);
    facts.extend([
        ("method".to_owned(), fit.algorithm.clone()),
        ("evaluations".to_owned(), fit.evaluations.to_string()),
        (
            format!("cost, {}", fit.cost_kind),
            crate::number_text::short(fit.cost),
        ),
        ("seed".to_owned(), fit.seed.to_string()),
    ]);
    facts.extend(fit.sigma_counts.map(|sigma| {
        let name = "noise before the counter, counts".to_owned();
        (
            name,
            crate::number_text::with_error(sigma, fit.sigma_std_counts),
        )
    }));
    Ok(Page {
        title: format!("Fit of {}", fit.recording),
        lead: vec![lead(fit)],
        facts,
        sections,
    })
}

/// Whether one model reproduces every reading, and its bounds or where it is refuted.
fn certificate(certificate: &Certificate, fitted: Option<&Data>) -> Section {
    let mut section = Section::new("certificate", "Certificate");
    let Certificate {
        readings,
        reproduced,
        ..
    } = certificate;
    let what = if certificate.feasible {
        "Beyond the bounds below a model near the fit contradicts at least one reading."
    } else {
        "No model of this structure near the fit reproduces all."
    };
    let text = format!("{reproduced} of {readings} readings are reproduced. {what}");
    section.blocks.push(Block::Text(text));
    if certificate.feasible {
        let mut table = Table::new(&["parameter", "from", "to", "unit"]);
        for bounds in &certificate.bounds {
            let end = |end: Option<f64>| end.map_or_else(|| "-".to_owned(), |end| end.to_string());
            table.row([
                bounds.name.clone(),
                end(bounds.low),
                end(bounds.high),
                bounds.unit.clone(),
            ]);
        }
        section.blocks.push(Block::Picture(Picture {
            id: "certificate-bounds".to_owned(),
            title: "Bounds of the parameters".to_owned(),
            caption: "A dash is where the search range ends before the readings say so.".to_owned(),
            drawing: Drawing::Nothing,
            table: Some(table),
        }));
    }
    let measured = |data: &Data| {
        let times = data.time_s.iter().copied();
        times.zip(data.counts.iter().copied()).collect::<Vec<_>>()
    };
    let measured = fitted.map(measured).unwrap_or_default();
    let drawn = picture::refuted("refuted", certificate, &measured);
    section.blocks.extend(drawn.map(Block::Picture));
    section
}

/// A model of the result with its name.
pub(super) fn model(name: &str, saved: &schema::Model, place: &str) -> Result<Model, Error> {
    let candidate = saved
        .candidate(place)
        .map_err(|fault| Error::Failed(format!("{fault}; write the result again with --json")))?;
    Ok(Model {
        name: name.to_owned(),
        candidate,
        method: saved.method(),
    })
}

impl Fit {
    fn name(&self) -> String {
        named(&self.effects)
    }
}

/// What a model with these effects is called.
pub(super) fn named(effects: &[String]) -> String {
    match effects {
        [] => "linear motor".to_owned(),
        some => format!("motor with {}", some.join(", ")),
    }
}

fn lead(fit: &Fit) -> String {
    let floor = format!("the encoder alone leaves {FLOOR_RMS_COUNTS:.3}");
    let held_out = fit.validate_rms_counts.map_or(String::new(), |rms| {
        format!(", and by {} where it was never fitted", counts(rms))
    });
    let verdict = if fit.rms_counts > 2.0 * FLOOR_RMS_COUNTS {
        " What is left is more than the encoder's: servoid diagnose says which physics is missing."
    } else {
        " Nothing but the encoder is left."
    };
    let stopped = if fit.interrupted {
        " The search was stopped by the user: this is the best so far."
    } else if !fit.converged {
        " The search did not come to its end, so the errors of the parameters are not known."
    } else {
        ""
    };
    let repeats = (fit.lack_of_fit.as_ref()).map_or(String::new(), |found| {
        format!(" {}", repeats::sentences(found))
    });
    format!(
        "The {} misses this recording by {} counts RMS on its own from start to end{held_out}; {floor}.{verdict}{repeats}{stopped}",
        fit.name(),
        counts(fit.rms_counts)
    )
}

fn entries(fit: &Fit) -> Vec<LadderBar> {
    fit.ladder
        .iter()
        .map(|entry| LadderBar {
            name: entry
                .added
                .as_ref()
                .map_or("linear motor".to_owned(), |name| format!("+ {name}")),
            fitted: entry.rms_counts,
            held_out: entry.validate_rms_counts,
        })
        .collect()
}
