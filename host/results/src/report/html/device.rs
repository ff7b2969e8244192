//! The page of a motor that commissioned itself, and of the host's check of it.

use super::{
    Model, OVERLAY, Recordings, diagnosis, failing, no_recording, parameters, recording_facts,
    timelines,
};
use crate::error::Error;
use crate::page::{Block, Page, Section};
use crate::report::diagnosis::bars::counts;
use crate::schema::device::Outcome;
use crate::schema::{DeviceRun, Estimate, Verification};
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::Method;
use servoid_identify::fit::margins::Loop;
use shared::effects::{EffectSet, Kind};
use shared::motor::Machine;

pub(super) fn page(run: &DeviceRun, recordings: Recordings<'_>) -> Result<Page, Error> {
    let mut sections = Vec::new();
    if let Some(outcome) = &run.outcome {
        let model = model(outcome)?;
        let mut seen = Section::new(OVERLAY, "Measured and the device's model");
        if recordings.fitted.is_none() {
            seen.blocks.push(Block::Text(no_recording("fitted.csv")));
        }
        let titles = [
            "What the device recorded and fitted",
            "What it verified on, never fitted",
        ];
        let models = [model];
        seen.blocks
            .extend(timelines(titles, recordings, &models, None)?);
        sections.push(seen);
        if let Some(data) = recordings.fitted {
            sections.extend(failing("model", data, &models)?);
        }
        let loops = models.map(|m| {
            (
                "the device's model".to_owned(),
                Loop::from(&m.candidate.machine),
            )
        });
        sections.push(parameters("the device", &estimates(outcome), &[], &loops));
    }
    let mut facts = recording_facts(recordings, "fitted.csv");
    facts.extend([
        (
            "board".to_owned(),
            format!("{}, firmware {}", run.board, run.firmware),
        ),
        ("supply".to_owned(), format!("{} V", run.supply_v)),
        ("control period".to_owned(), format!("{} µs", run.period_us)),
        ("number format".to_owned(), run.format.clone()),
        (
            "first moved at".to_owned(),
            format!("{:.3} V", run.breakaway_v),
        ),
        ("periods lost".to_owned(), run.missing.to_string()),
    ]);
    Ok(Page {
        title: format!("Commissioning on {}", run.board),
        lead: vec![lead(run)],
        facts,
        sections,
    })
}

/// The host's check: its verdict above the page of its diagnosis.
pub(super) fn verification(
    verification: &Verification,
    recordings: Recordings<'_>,
) -> Result<Page, Error> {
    let mut page = match &verification.diagnosis {
        Some(found) => diagnosis::page(found, recordings)?,
        None => Page::default(),
    };
    page.title = "The device's answer, checked by the host".to_owned();
    page.lead.insert(0, verification.verdict.clone());
    let same = if verification.same_bits {
        "the same bits"
    } else {
        "other bits"
    };
    page.facts
        .push(("the fit, repeated".to_owned(), same.to_owned()));
    Ok(page)
}

fn lead(run: &DeviceRun) -> String {
    if let Some(failure) = &run.failure {
        return format!(
            "The run was given up {:.3} s after its start, in {}: {}",
            failure.at_s, failure.stage, failure.message
        );
    }
    let Some(outcome) = &run.outcome else {
        return "The device recorded and did not fit.".to_owned();
    };
    let verified = run.verified_rms_counts.map_or(String::new(), |rms| {
        format!(
            " What it had not seen it predicts to {} counts RMS.",
            counts(rms)
        )
    });
    let grade = run.grade.map_or(String::new(), |grade| {
        let why = run.reason.as_ref().map(|why| format!(": {why}"));
        format!(" Its verdict is {grade}{}.", why.unwrap_or_default())
    });
    format!(
        "The device fitted its own motor to {} counts RMS in {} model runs.{verified}{grade} Whether that stands, `servoid device \
         verify` says.",
        counts(outcome.rms_counts),
        outcome.evaluations
    )
}

fn estimates(outcome: &Outcome) -> Vec<Estimate> {
    outcome
        .parameters
        .iter()
        .map(|p| Estimate {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit.clone(),
            std: p.std,
            identifiable: p.std.is_some_and(|std| 2.0 * std < p.value.abs()),
            spread: None,
            at_bound: false,
            usual: None,
            systematic: Vec::new(),
        })
        .collect()
}

/// The device's model: its damping is all back-EMF, since voltage and angle do not tell the two apart.
fn model(outcome: &Outcome) -> Result<Model, Error> {
    let of = |name: &str| {
        outcome.value(name).ok_or_else(|| {
            Error::Failed(format!(
                "device.json lacks the parameter `{name}`; commission the motor again"
            ))
        })
    };
    let gain = of("gain")?;
    let kb = 1.0 / gain;
    let mut effects = EffectSet::default();
    for (name, kind) in [("coulomb", Kind::Coulomb), ("load", Kind::LoadTorque)] {
        if let Some(value) = outcome.value(name) {
            effects.push(kind, &[value])?;
        }
    }
    Ok(Model {
        name: "device's model".to_owned(),
        candidate: Candidate {
            machine: Machine {
                kb,
                damping: 0.0,
                inertia: of("a1")? * kb,
                electrical: of("electrical")?,
            },
            effects,
            start_speed: 0.0,
            start_offset: 0.0,
        },
        method: Method {
            substeps: 2,
            ..Method::default()
        },
    })
}
