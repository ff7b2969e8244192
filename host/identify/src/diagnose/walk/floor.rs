//! What stands below a model's error in windows.

use super::evidence::Evidence;
use crate::diagnose::models::FittedModel;
use crate::diagnose::outcome::{Floor, FloorKind};
use crate::diagnose::score::settings::FORETOLD;

/// The motor's own noise over `window_s`, where nothing of the innovations of a model can be foretold.
pub fn floor(evidence: &Evidence<'_>, model: &FittedModel, window_s: f64) -> Floor {
    let foretold = evidence.foretold(&model.candidate);
    Floor {
        kind: match foretold {
            Some(foretold) if foretold.share <= FORETOLD => FloorKind::Repeatability,
            _ => FloorKind::Unknown,
        },
        counts: evidence.repeatability_counts(&model.candidate, window_s),
        window_s: Some(window_s),
        foretold,
        repeats: None,
    }
}
