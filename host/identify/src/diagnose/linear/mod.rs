//! Stage 2: the linear motor. It decides how far models run on their own, and where the search for effects starts.

mod fit;
mod offset_regressor;

use crate::diagnose::settings::OTHER_MOTOR;
pub use fit::fit_linear;

use super::context::Context;
use super::models::FittedModel;
use crate::error::Error;
use crate::fit::Options;
use offset_regressor::regressed_beside_offset;

/// The linear motor and what follows from it.
pub struct Linear<'a> {
    /// The recordings, over the span that the linear motor allows.
    pub context: Context<'a>,
    /// The linear motor.
    pub base: FittedModel,
    /// The same where the search for effects starts: with another gain where a constant beside the motor shows one.
    pub anchor: FittedModel,
}

/// Fits the linear motor, in windows where its free run says little.
///
/// # Errors
/// [`Error::Failed`] where no motor fits even roughly.
pub fn fit_linear_motor<'a>(prepared: Context<'a>, options: &Options) -> Result<Linear<'a>, Error> {
    let (mut context, mut base) = fit_linear(prepared, options)?;
    let beside_offset = (!base.free().at_floor())
        .then(|| regressed_beside_offset(&context, options))
        .flatten();
    let left = beside_offset.map_or(f64::INFINITY, |(_, rms)| rms);
    let span = context.span.clone().after(context.data, base.free(), left);
    if span != context.span {
        (context, base) = fit_linear(context.over(span), options)?;
    }
    // In windows the error of a whole run says little.
    let whole = context.span.window_s.is_none();
    let mut anchor = base.clone();
    if let Some((machine, _)) =
        beside_offset.filter(|(_, rms)| whole && *rms < OTHER_MOTOR * base.rms_counts)
    {
        anchor.candidate.machine = machine;
    }
    Ok(Linear {
        context,
        base,
        anchor,
    })
}
