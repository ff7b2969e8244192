//! Forms other than the textbook's. They are searched for where the textbook's leave something to explain, and must earn
//! their freedom as an effect must: a parameter that is free in every model would cost naming power in every diagnosis.

use super::settings::FORM_PROMISING;
use crate::diagnose::candidate::descent::Settings;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::candidate::search::{fit_problem, search};
use crate::diagnose::context::Context;
use crate::diagnose::gain::removes;
use crate::diagnose::models::{Errors, FittedModel};
use crate::diagnose::screening::FORMS;
use crate::fit::forms::MUST_REMOVE;
use servoid_engine::problem::Structure;

/// `model` with its forms free, if that removes enough of what it leaves. `None` where nothing is left, no form is held, or
/// free runs are chaotic.
pub fn with_other_forms(context: &Context<'_>, model: &FittedModel) -> Option<FittedModel> {
    if model.is_proven() || model.losses.is_some() || model.observed.is_some() {
        return None;
    }
    let structure = model.structure.with_forms_free()?;
    // From the textbook's and from their relatives: between the two may lie a ridge.
    let freed = FORMS.iter().filter_map(|&form| {
        context.budget.checkpoint();
        let tried = tried(context, model, started_at(model, &structure, form))?;
        polish(context, &tried).ok()
    });
    freed
        .min_by(FittedModel::by_score)
        .filter(|freed| removes(model, freed))
}

/// `freed` after a short search, which costs a small part of one that converges; `None` where that removes too little of what
/// `model` leaves.
fn tried(context: &Context<'_>, model: &FittedModel, freed: FittedModel) -> Option<FittedModel> {
    let problem = fit_problem(context, &freed.structure, freed.method);
    let found = search(context, &problem, &freed.x, Settings::ROUGH, freed.method)?;
    let ran = model.ran();
    let fitted = (found.squares / context.samples() as f64).sqrt();
    let left = Errors { fitted, ..ran }.fitted_excess() / ran.fitted_excess();
    (1.0 - left > FORM_PROMISING * MUST_REMOVE).then_some(FittedModel {
        x: found.x,
        ..freed
    })
}

/// `model` in the freedom of `structure`, with each form that it holds at `form`.
fn started_at(model: &FittedModel, structure: &Structure, form: f64) -> FittedModel {
    let mut values = model.structure.values(&model.x);
    for (unknown, value) in model.structure.unknowns.iter().zip(&mut values) {
        if unknown.held_from.is_some() {
            *value = form;
        }
    }
    FittedModel {
        x: structure.coordinates(&values),
        structure: structure.clone(),
        ..model.clone()
    }
}
