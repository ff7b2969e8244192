//! What would explain more than a model, as the page shows it.

use super::model::Model;
use super::state::{Proposed, State};
use serde_json::{Value, json};
use servoid_identify::diagnose::Suggestion;
use servoid_identify::plan::Hypothesis;
use servoid_identify::residual_analysis::{Axis, Signature};
use servoid_results::schema::diagnosis::Floor;
use std::cmp::Ordering;

/// Effects explain about equally if the logarithms of what they divide the held-out error by are within this part of the best one's.
const ABOUT: f64 = 0.7;
/// Next to the encoder's own error they do within this factor.
const ABOUT_FLOOR: f64 = 1.15;
/// What leaves more than this part of the model's error explains little.
const LITTLE: f64 = 0.7;

/// The proposals beside model `id`; `None` before anybody looked for them.
pub(super) fn view(state: &State, id: usize) -> Option<Value> {
    let proposed = state.proposed.get(&id)?;
    let before = state.model(id).ok()?.held_out_rms_counts();
    let list: Vec<Value> = ordered(proposed, before)
        .into_iter()
        .map(|suggestion| entry(state, proposed, suggestion, before))
        .collect();
    let floor = proposed.floor.as_ref().map(Floor::from);
    let rivals: Vec<&str> = (rivals(state, id).iter())
        .map(|one| one.effect.name())
        .collect();
    Some(json!({
        "of": id, "tried": proposed.tried, "seconds": proposed.seconds, "list": list, "rivals": rivals,
        "floor": floor,
    }))
}

/// The proposals beside model `id` that explain about as much as the best one, simplest first. What can become a simpler one of them is no rival
/// of that: where the simpler one is true, both are.
pub(super) fn rivals(state: &State, id: usize) -> Vec<&Suggestion> {
    let Some(proposed) = state.proposed.get(&id) else {
        return Vec::new();
    };
    let before = state.model(id).ok().and_then(Model::held_out_rms_counts);
    let near = near(proposed, before);
    let free = |one: &&Suggestion| near(one) && !state.locked.contains(&one.effect);
    let mut rivals: Vec<&Suggestion> = Vec::new();
    for one in ordered(proposed, before).into_iter().filter(free) {
        let model = Hypothesis::of(&one.model.candidate);
        let known = |other: &&Suggestion| model.contains(&Hypothesis::of(&other.model.candidate));
        if !rivals.iter().any(known) {
            rivals.push(one);
        }
    }
    rivals
}

/// Whether a proposal explains about as much as the best.
fn near(proposed: &Proposed, before: Option<f64>) -> impl Fn(&Suggestion) -> bool {
    let best = (proposed.list.iter().map(held_out)).fold(f64::INFINITY, f64::min);
    let before = before.unwrap_or(best).max(best);
    let floor = proposed.list.first().map_or(0.0, |one| one.errors.floor);
    move |one| {
        if best <= ABOUT_FLOOR * floor {
            held_out(one) <= ABOUT_FLOOR * best
        } else {
            (before / held_out(one)).ln() >= ABOUT * (before / best).ln()
        }
    }
}

fn held_out(one: &Suggestion) -> f64 {
    one.errors.held_out
}

/// Those that explain about as much as the best come first, the fewest parameters before all; the rest by what they leave.
fn ordered(proposed: &Proposed, before: Option<f64>) -> Vec<&Suggestion> {
    let near = near(proposed, before);
    let rank = |one: &Suggestion| {
        let near = near(one);
        (!near, if near { one.model.freedom() } else { 0 })
    };
    let mut list: Vec<&Suggestion> = proposed.list.iter().collect();
    list.sort_by(|a, b| {
        let by_rank: Ordering = rank(a).cmp(&rank(b));
        by_rank.then(held_out(a).total_cmp(&held_out(b)))
    });
    list
}

fn entry(
    state: &State,
    proposed: &Proposed,
    suggestion: &Suggestion,
    before: Option<f64>,
) -> Value {
    let description = suggestion.effect.description();
    let model = &suggestion.model;
    let errors = suggestion.errors;
    // A score knows what the motor itself does not repeat, which hides most of an error.
    let little = match proposed.floor {
        Some(_) => !suggestion.believed,
        None => before.is_some_and(|before| errors.held_out > LITTLE * before),
    };
    json!({
        "effect": suggestion.effect.name(),
        "title": description.title,
        "evidence": suggestion.evidence,
        "believed": suggestion.believed,
        "little": little,
        "worse": before.is_some_and(|before| errors.held_out > before),
        "locked": state.locked.contains(&suggestion.effect),
        "parameters": model.freedom(),
        "foreseen_rms_counts": finite(model.predicted_rms_counts),
        "rms_counts": finite(errors.fitted),
        "held_out_rms_counts": finite(errors.held_out),
        "looks_like": description.look_alikes,
        "signature": suggestion.signature.as_ref().map(drawn),
    })
}

fn finite(x: f64) -> Option<f64> {
    Some(x).filter(|x| x.is_finite())
}

/// A signature as it is drawn.
pub(super) fn drawn(signature: &Signature) -> Value {
    let (name, unit) = match signature.axis {
        Axis::Map(against) => {
            let (name, unit) = against.name();
            (name.replace('_', " "), unit.to_owned())
        }
        Axis::Wave(1) => ("angle".to_owned(), "revolution".to_owned()),
        Axis::Wave(waves) => ("angle".to_owned(), format!("1/{waves} revolution")),
    };
    let bins: Vec<Value> = (signature.bins.iter())
        .map(|bin| json!([0.5 * (bin.low + bin.high), bin.mean_v, finite(bin.error_v)]))
        .collect();
    json!({ "against": name, "unit": unit, "bins": bins, "curve": signature.curve })
}
