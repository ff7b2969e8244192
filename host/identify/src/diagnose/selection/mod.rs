//! Stage 3: effects are added one by one, as long as the error falls and the held-out recording agrees.

pub mod backward_elimination;
mod cross_start;
mod extension;
pub mod forms;
mod forward_selection;
pub mod judge;
pub mod nested_models;
pub mod substitution;

pub use extension::extensions;
pub use forward_selection::Level;

use super::context::Context;
use super::linear::{Linear, fit_linear_again};
use super::models::FittedModel;
use forward_selection::forward_selection;

/// What forward selection ended with.
pub struct Selected<'a> {
    /// The recordings.
    pub context: Context<'a>,
    /// The linear motor.
    pub base: FittedModel,
    /// The models with one effect, with two, and so on; none where the linear motor explains the recording.
    pub levels: Vec<Level>,
}

/// Adds effects to the linear motor. `done` is called after each piece of work.
pub fn select_effects<'a>(linear: Linear<'a>, done: &(dyn Fn() + Sync)) -> Selected<'a> {
    let Linear {
        context,
        mut base,
        anchor,
    } = linear;
    let mut levels = forward_selection(&context, &anchor, done);
    context.budget.release_reserve();
    // A search that ended early looks like missing physics: the linear motor is fitted again from where the
    // best model has it.
    if let Some(again) = levels
        .first()
        .and_then(|level| fit_linear_again(&context, &base, &level.best.candidate.machine))
    {
        base = again;
        levels.clear();
    }
    Selected {
        context,
        base,
        levels,
    }
}
