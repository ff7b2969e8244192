//! What was found on fewer readings, judged on all of them.

use super::along::along;
use crate::diagnose::baseline::Prediction;
use crate::diagnose::chosen::{Chosen, Level};
use crate::diagnose::linear::Linear;
use crate::diagnose::models::FittedModel;
use rayon::prelude::*;

/// What was found on fewer readings, judged on all of them.
pub fn on_all_readings<'a>(whole: Linear<'a>, found: Chosen<'_>) -> Chosen<'a> {
    let Linear { context, base, .. } = whole;
    let on_all = |models: Vec<FittedModel>| -> Vec<FittedModel> {
        let models = models.par_iter();
        models.filter_map(|model| along(&context, model)).collect()
    };
    let level = |level: Level| {
        let best = along(&context, &level.best)?;
        Some(Level {
            models: on_all(level.models),
            best,
        })
    };
    let chosen = found.model.and_then(|model| along(&context, &model));
    let predicts = |before: Prediction| {
        let model = chosen.as_ref().unwrap_or(&base);
        Prediction::of(&context, model).unwrap_or(before)
    };
    Chosen {
        levels: found.levels.into_iter().filter_map(level).collect(),
        known: on_all(found.known),
        predicts: found.predicts.map(predicts),
        baseline: found.baseline,
        as_one: found.as_one,
        scores: found.scores,
        floor: found.floor,
        base: along(&context, &found.base).unwrap_or(base),
        model: chosen,
        context,
    }
}
