//! A search on fewer readings. An observer corrects a motor about once a time constant; what a log holds many times in between costs time and
//! tells nothing where the motor's own noise is far above the encoder's. What was found is then judged on all readings.

use super::baseline::Prediction;
use super::candidate::descent::Descent;
use super::candidate::score::score_candidate;
use super::confirmation::Confirmed;
use super::context::Context;
use super::linear::Linear;
use super::models::FittedModel;
use super::score::Plant;
use super::score::settings::UNDAMPED_INTERVAL_S;
use super::screening::restart;
use super::selection::Level;
use rayon::prelude::*;
use servoid_engine::problem::Data;

/// Fewest readings that are left of a recording.
const FEWEST_READINGS: usize = 5000;
/// Fewest in a time constant of the motor, and in a window.
const IN_TIME_CONSTANT: f64 = 6.0;
const IN_WINDOW: f64 = 50.0;
/// Most of a revolution between two of them: torque that repeats with the angle must still be seen.
const MOST_TURNS: f64 = 0.1;

/// The recordings with fewer readings.
pub struct Thinned {
    data: Data,
    held_out: Data,
}

impl Thinned {
    /// Those of a diagnosis in windows; `None` where every reading is needed.
    pub fn of(linear: &Linear<'_>) -> Option<Self> {
        let Context { data, held_out, .. } = linear.context;
        let every = every(linear)?;
        Some(Thinned {
            data: data.thinned(every).ok()?,
            held_out: held_out.thinned(every).ok()?,
        })
    }

    /// The linear motor along them.
    pub fn linear<'b>(&'b self, linear: &Linear<'b>) -> Option<Linear<'b>> {
        let whole = &linear.context;
        let thin = whole.with_recordings(&self.data, &self.held_out);
        let context = Context {
            floor: whole.floor,
            ..thin.over(whole.span.clone())
        };
        Some(Linear {
            base: along(&context, &linear.base)?,
            anchor: along(&context, &linear.anchor)?,
            context,
        })
    }
}

/// How many readings one may stand for, if more than one.
fn every(linear: &Linear<'_>) -> Option<usize> {
    let Context { data, span, .. } = &linear.context;
    let units = &data.units;
    let time_constant_s = if data.drive.is_voltage() {
        Plant::of(&linear.base.candidate.machine).time_constant_s
    } else {
        UNDAMPED_INTERVAL_S
    };
    let turns_per_s = units.speed / std::f64::consts::TAU;
    let longest_s = (time_constant_s / IN_TIME_CONSTANT)
        .min(span.window_s? / IN_WINDOW)
        .min(MOST_TURNS / turns_per_s);
    let most = data.len().min(linear.context.held_out.len()) / FEWEST_READINGS;
    let every = (longest_s / units.interval).min(most as f64) as usize;
    (every > 1).then_some(every)
}

/// What was found on fewer readings, judged on all of them.
pub fn on_all_readings<'a>(whole: Linear<'a>, found: Confirmed<'_>) -> Confirmed<'a> {
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
            ..level
        })
    };
    let chosen = found.chosen.and_then(|model| along(&context, &model));
    let predicts = |before: Prediction| {
        let model = chosen.as_ref().unwrap_or(&base);
        Prediction::of(&context, model).unwrap_or(before)
    };
    Confirmed {
        levels: found.levels.into_iter().filter_map(level).collect(),
        known: on_all(found.known),
        predicts: found.predicts.map(predicts),
        not_named: found.not_named,
        baseline: found.baseline,
        as_one: found.as_one,
        scores: found.scores,
        floor: found.floor,
        base: along(&context, &found.base).unwrap_or(base),
        chosen,
        context,
    }
}

/// A model along the recordings of a context, where it stands.
fn along(context: &Context<'_>, model: &FittedModel) -> Option<FittedModel> {
    let start = restart(context, model);
    let found = Descent {
        x: start.x,
        squares: 0.0,
        evaluations: model.evaluations,
    };
    let predicted = model.predicted_rms_counts;
    score_candidate(context, start.structure, &found, predicted, model.method).ok()
}
