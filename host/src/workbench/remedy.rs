//! The speed loop of the chosen model, before and after what is known of its effects.

use super::state::Bench;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_results::remedy::remedy;

/// The loop in numbers, and its speeds.
///
/// # Errors
/// A motor for which no loop can be designed.
pub(super) fn of(bench: &Bench) -> Result<Value, Error> {
    let (recordings, model) = {
        let state = bench.state();
        (state.recordings()?, state.chosen_model()?.clone())
    };
    let subject = model.subject(&recordings)?;
    let found = remedy(&subject, &model.fit.candidate, recordings.shown().units)?;
    let forward = &found.feed_forward;
    let [kp, ki] = found.gains;
    let [before, after] = found.rms;
    let crossing = found.crossing.map(|crossing| {
        let [before, after] = found.rms_angle;
        json!({ "gap_rad": crossing.gap_rad, "time_s": crossing.time_s, "rms_before": before, "rms_after": after })
    });
    Ok(json!({
        "kp": kp, "ki": ki,
        "k_s": forward.k_s, "k_s_from": forward.k_s_from,
        "k_g": forward.k_g, "k_g_from": forward.k_g_from,
        "k_v": forward.k_v, "k_a": forward.k_a,
        "by_angle": found.by_angle, "crossing": crossing,
        "time_s": found.time_s, "wanted": found.wanted, "before": found.before, "after": found.after,
        "rms_before": before, "rms_after": after,
    }))
}
