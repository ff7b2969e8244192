//! Profile likelihoods as text of 80 columns.

use super::style::{HEADING, painted};
use crate::number_text::interval;
use servoid_identify::fit::Profile;

/// A line for each parameter; nothing where nobody asked.
pub(super) fn lines(profiles: &[Profile]) -> String {
    if profiles.is_empty() {
        return String::new();
    }
    let mut out = format!(
        "{}: 95 % intervals, all other parameters following\n",
        painted(HEADING, "profile likelihood")
    );
    for profile in profiles {
        let text = interval(profile.interval, profile.unit)
            .unwrap_or_else(|| "not bounded within its search range".to_owned());
        out += &format!("  {:26} {text}\n", profile.name);
    }
    out
}
