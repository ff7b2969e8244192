//! One step of a diagnosis on its own: which effects would explain more than a given model does.

use super::candidate::descent::Descent;
use super::candidate::score::score_candidate;
use super::candidate::search::fit_problem;
use super::context::{Budget, Context};
use super::criterion::Criterion;
use super::explain::evidence;
use super::gain::p_value;
use super::linear::Linear;
use super::models::{Errors, FittedModel};
use super::outcome::{Floor, Verdict};
use super::thinned::{MOST_ON_ALL, Thinned, along};
use super::walk::{Neighbour, Ring, ring};
use crate::error::Error;
use crate::fit::{Options, base_for};
use crate::residual_analysis::{Signature, analyse_residual, signature};
use servoid_engine::problem::{Candidate, Data, Structure};
use servoid_engine::solve::Objective;
use shared::effects::Kind;

/// An effect that would explain more.
#[derive(Clone, Debug)]
pub struct Suggestion {
    /// The effect.
    pub effect: Kind,
    /// The model with it, fitted.
    pub model: FittedModel,
    /// The errors by which it is judged, as those of a fit are.
    pub errors: Errors,
    /// What was measured that speaks for it, if the recording shows it.
    pub evidence: Option<String>,
    /// Its volts along the motion, and those that the motor asked for; nothing where no quantity tells them.
    pub signature: Option<Signature>,
    /// Chance of so large a gain if it were absent.
    pub p_value: f64,
    /// Whether its score is beyond doubt above that of the model without it.
    pub believed: bool,
}

/// What a look at one model gave.
#[derive(Clone, Debug)]
pub struct Suggestions {
    /// The model's own errors, as they were judged.
    pub verdict: Verdict,
    /// Best first; empty where the model leaves nothing but the encoder's error.
    pub list: Vec<Suggestion>,
    /// What stands below the model's error, where models run in windows.
    pub floor: Option<Floor>,
}

/// Looks for effects beside those of `candidate`, judged by `held_out`, which is never fitted, over the span of `criterion`.
///
/// # Errors
/// Where the model cannot run.
pub fn suggest(
    data: &Data,
    held_out: &Data,
    candidate: &Candidate,
    criterion: &Criterion,
    options: &Options,
    budget: &Budget<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<Suggestions, Error> {
    let context = criterion.context(data, held_out, options, budget);
    let parent = standing(&context, candidate)?;
    if parent.judged().at_floor() {
        let verdict = if parent.effects.is_empty() {
            Verdict::Complete
        } else {
            Verdict::MissingEffects
        };
        return Ok(Suggestions {
            verdict,
            list: Vec::new(),
            floor: None,
        });
    }
    let Ring { neighbours, floor } = by_score(&context, &parent, done);
    let mut list = Vec::new();
    for neighbour in neighbours {
        let Neighbour {
            added: effect,
            model,
            believed,
        } = neighbour;
        let bare = model.candidate.without(effect);
        let missing = analyse_residual(data, &bare, &model.candidate, model.method)?;
        let values = model.values_of(effect);
        list.push(Suggestion {
            effect,
            evidence: evidence::sentence(effect, &values, &missing),
            signature: signature(data, &model.candidate, effect, model.method),
            p_value: p_value(data, &parent, &model),
            believed,
            errors: criterion.errors_of(data, held_out, &model)?,
            model,
        });
    }
    Ok(Suggestions {
        verdict: Verdict::Unexplained,
        list,
        floor,
    })
}

/// By the score, along as many readings as a diagnosis needs.
fn by_score(context: &Context<'_>, parent: &FittedModel, done: &(dyn Fn() + Sync)) -> Ring {
    let whole = Linear {
        context: context.with_recordings(context.data, context.held_out),
        base: parent.clone(),
        anchor: parent.clone(),
    };
    let thinned = Thinned::of(&whole).or_else(|| Thinned::begin_of(&whole));
    let Some(fewer) = thinned.as_ref().and_then(|thinned| thinned.linear(&whole)) else {
        return ring(context, parent, done);
    };
    let Ring { neighbours, floor } = ring(&fewer.context, &fewer.base, done);
    let most = context
        .span
        .window_s
        .map_or(MOST_ON_ALL, |_| neighbours.len());
    let on_all = neighbours.into_iter().take(most).filter_map(|neighbour| {
        let model = along(context, &neighbour.model)?;
        Some(Neighbour { model, ..neighbour })
    });
    Ring {
        neighbours: on_all.collect(),
        floor,
    }
}

/// A model as it stands, in the terms of a diagnosis.
fn standing(context: &Context<'_>, candidate: &Candidate) -> Result<FittedModel, Error> {
    let effects: Vec<Kind> = candidate.effects.iter().map(|(kind, _)| kind).collect();
    let values: Vec<f64> = (candidate.effects.iter())
        .flat_map(|(_, values)| values.to_vec())
        .collect();
    let data = context.data;
    let mut structure = Structure::around(
        data,
        base_for(data, &effects, context.span.window_s.is_some()),
        &effects,
        &candidate.machine,
        candidate.start_speed != 0.0,
    );
    let x = structure.values_of(&candidate.machine, &values, candidate.start_speed);
    structure.free_forms_in(&x);
    let x = structure.coordinates(&x);
    let squares = fit_problem(context, &structure, context.method).cost(&x);
    let found = Descent {
        x,
        squares,
        evaluations: 1,
    };
    let predicted = (squares / data.len() as f64).sqrt();
    score_candidate(context, structure, &found, predicted, context.method)
}
