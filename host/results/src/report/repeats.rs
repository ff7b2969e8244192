//! What repeats of a command say of a model, in words.

use super::diagnosis::bars::counts;
use crate::schema::lack_of_fit::LackOfFit;
use servoid_identify::repeats::settings::REPEATED;

/// More than this may be chance.
const CHANCE: f64 = 0.05;

/// One or two sentences.
pub(super) fn sentences(found: &LackOfFit) -> String {
    let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
    let ratio = number(found.ratio);
    let common = format!(
        "{} counts are common to all runs (p = {:.3})",
        counts(number(found.systematic_counts)),
        number(found.p_value)
    );
    let rest = if ratio <= REPEATED {
        "nothing is left that a model could explain".to_owned()
    } else if number(found.p_value) <= CHANCE {
        format!("{common}, and a model could explain them")
    } else {
        format!("{common}, which may be chance")
    };
    format!(
        "{} runs of the same command part by {} counts RMS in windows of {} s, and by {} over the whole run; no model explains that. This one \
         misses them by {} in the windows, {ratio:.2} times as much: {rest}.",
        found.repeats,
        counts(number(found.noise_counts)),
        number(found.window_s),
        counts(number(found.over_run_counts)),
        counts(number(found.model_counts)),
    )
}
