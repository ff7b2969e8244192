//! The recordings with fewer readings.

use super::along::along;
use super::settings::{FEWEST_READINGS, IN_TIME_CONSTANT, IN_WINDOW, MOST_READINGS, MOST_TURNS};
use crate::diagnose::context::Context;
use crate::diagnose::linear::Linear;
use crate::diagnose::score::Plant;
use servoid_engine::problem::Data;

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

    /// The first readings of a long bench, enough for a proposal; `None` of a short one, and in windows.
    pub fn begin_of(linear: &Linear<'_>) -> Option<Self> {
        let Context {
            data,
            held_out,
            span,
            ..
        } = &linear.context;
        let is_long = data.len() > MOST_READINGS && span.window_s.is_none();
        is_long.then(|| Thinned {
            data: data.first(MOST_READINGS),
            held_out: held_out.first(MOST_READINGS.min(held_out.len())),
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
    let corrected_s = Plant::of(&linear.base.candidate.machine).interval_s(data.drive);
    let turns_per_s = units.speed / std::f64::consts::TAU;
    let longest_s = (corrected_s / IN_TIME_CONSTANT)
        .min(span.window_s? / IN_WINDOW)
        .min(MOST_TURNS / turns_per_s);
    let most = data.len().min(linear.context.held_out.len()) / FEWEST_READINGS;
    let every = (longest_s / units.interval).min(most as f64) as usize;
    (every > 1).then_some(every)
}
