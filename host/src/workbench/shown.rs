//! What the page shows: the bench in words and numbers.

use super::device::Device;
use super::model::Model;
use super::proposals;
use super::recordings::Recordings;
use super::sliders::sliders;
use super::state::{Bench, State};
use super::words::on_the_page;
use super::work::TWINS;
use serde_json::{Map, Value, json};
use servoid_results::export::FORMATS;
use servoid_results::schema::Estimate;
use shared::effects::Kind;

/// The bench in words and numbers.
pub(super) fn view(bench: &Bench) -> Value {
    let state = bench.state();
    let (undo, redo) = bench.history().has();
    json!({
        "revision": state.revision,
        "undo": undo,
        "redo": redo,
        "next": state.next_number(),
        "floor_counts": state.floor_counts(),
        "recording": state.recordings.as_ref().map(recording),
        "models": state.models.iter().map(|model| entry(&state, model)).collect::<Vec<_>>(),
        "chosen": state.chosen,
        "against": state.against,
        "proposed": state.chosen.and_then(|id| proposals::view(&state, id)),
        "twins": state.chosen.and_then(|id| state.twins.get(&id)).map(|found| json!({
            "of": TWINS, "tried": found.tried, "same": found.same, "others": found.others,
        })),
        "locked": state.locked.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "diagnosis": state.diagnosis.as_ref().map(|d| json!({
            "verdict": d["verdict"], "summary": on_the_page(d["summary"].as_str().unwrap_or_default()), "advice": d["advice"], "cannot_tell": d["cannot_tell"],
        })),
        "race": state.race.is_some(),
        "job": bench.job.running(),
        "device": bench.device().ok().map(Device::view),
        "fault": state.fault.as_deref().map(on_the_page),
        "secret": state.secret.as_ref().map(|secret| json!({
            "seed": secret.seed,
            "told": secret.revealed.then(|| secret.hidden.described()),
        })),
        "effects": Kind::ALL.iter().map(described).collect::<Vec<_>>(),
        "algorithms": servoid_engine::solve::names(),
        "formats": FORMATS.iter().map(|format| format.name).collect::<Vec<_>>(),
        "version": env!("CARGO_PKG_VERSION"),
    })
}

fn described(kind: &Kind) -> Value {
    let own = kind.description();
    json!({
        "name": own.name, "title": own.title, "equation": own.equation, "sign": own.signature, "exposed_by": own.exposed_by, "source": own.source,
    })
}

fn recording(recordings: &Recordings) -> Value {
    let data = recordings.shown();
    let span = recordings.criterion_if_known().map(|found| &found.span);
    json!({
        "name": data.source,
        "samples": data.len(),
        "seconds": data.time_s.last(),
        "motor": recordings.motor(),
        "counts_per_rev": data.units.counts_per_rev,
        "supply_v": data.supply,
        "held_out": recordings.kind().source(),
        "held_out_from_s": recordings.held_out_from(),
        "stamp": recordings.stamp,
        "drive_unit": data.drive.symbol(),
        "quantised": data.quantised,
        "window_s": span.and_then(|span| span.window_s),
        "window_reason": span.map(|span| &span.reason),
        "sources": sources(recordings),
    })
}

/// Each recording by its name, with its role.
fn sources(recordings: &Recordings) -> Vec<Value> {
    let fitted: Vec<_> = recordings.fitted.recordings().collect();
    // Of several the last judges, where no other one does.
    let last = fitted.len() - 1;
    let judges = |k: usize| recordings.held_out.is_none() && last > 0 && k == last;
    let fitted = fitted.into_iter().enumerate();
    let fitted = fitted.map(|(k, own)| (own, if judges(k) { "held out" } else { "fitted" }));
    let held_out = recordings
        .held_out
        .iter()
        .flat_map(|held_out| held_out.recordings());
    let ignored = recordings
        .ignored
        .iter()
        .flat_map(|ignored| ignored.recordings());
    let sources = recordings.all().flat_map(|loaded| &loaded.sources);
    let spans = sources.map(|source| source.span_s);
    let turned = recordings.all().flat_map(|loaded| loaded.turned());
    fitted
        .chain(held_out.map(|own| (own, "held out")))
        .chain(ignored.map(|own| (own, "ignored")))
        .zip(spans.zip(turned))
        .map(|(((name, seconds, samples), role), (span, turned))| {
            json!({
                "name": name, "seconds": seconds, "samples": samples, "role": role, "span_s": span, "turned_counts": turned,
            })
        })
        .collect()
}

fn entry(state: &State, model: &Model) -> Value {
    let fit = &model.fit;
    let chosen = state.chosen == Some(model.id);
    json!({
        "id": model.id,
        "name": model.name(),
        "effects": model.effects.iter().map(|kind| kind.name()).collect::<Vec<_>>(),
        "algorithm": fit.algorithm,
        "evaluations": fit.evaluations,
        "rms_counts": model.judged.fitted,
        "held_out_rms_counts": model.held_out_rms_counts(),
        "whole_rms_counts": fit.validate_rms_counts.unwrap_or(fit.rms_counts),
        "foreseen_rms_counts": model.predicted,
        "at_floor": !model.leaves_something(),
        "white": model.white,
        "explained": model.explains(),
        "parent": model.parent.filter(|parent| state.model(*parent).is_ok()),
        "signatures": chosen.then(|| model.signatures.iter().map(|(kind, signature)| {
            (kind.name().to_owned(), proposals::drawn(signature))
        }).collect::<Map<_, _>>()),
        "stamp": model.stamp,
        "notes": fit.notes.iter().map(|note| on_the_page(note)).collect::<Vec<_>>(),
        "parameters": fit.parameters.iter().map(Estimate::from).collect::<Vec<_>>(),
        "sliders": chosen.then(|| sliders(&fit.candidate)),
    })
}
