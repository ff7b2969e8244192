//! "Did you mean …?": the nearest known name to one that is unknown.

use super::shown::quoted_list;

/// Below this similarity a suggestion would be noise. Measured on the names of this project: slips of
/// one or two letters lie above 0.85, unrelated names below 0.7.
const LEAST_SIMILARITY: f64 = 0.75;

/// The candidate most like `name` (Jaro–Winkler, ignoring case and `-` against `_`), or `None` where
/// nothing comes near. Of equals the first wins.
pub fn nearest<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = folded(name);
    let mut best = None;
    let mut best_score = LEAST_SIMILARITY;
    for candidate in candidates {
        let candidate_name = folded(candidate);
        // Two letters that are exchanged make a short word another one.
        let is_near = name.len().abs_diff(candidate_name.len()) <= 4;
        let slip = name.len() > 2 && is_near && strsim::osa_distance(&name, &candidate_name) == 1;
        let least = if slip { LEAST_SIMILARITY } else { 0.0 };
        let score = strsim::jaro_winkler(&name, &candidate_name).max(least);
        if score > best_score || (best.is_none() && score >= best_score) {
            best = Some(candidate);
            best_score = score;
        }
    }
    best
}

/// The end of an error about an unknown `name`: ``did you mean `x`?``, else the list of what is known.
pub fn did_you_mean(name: &str, candidates: &[&str]) -> String {
    match nearest(name, candidates.iter().copied()) {
        Some(near) => format!("did you mean `{near}`?"),
        None if candidates.is_empty() => "nothing is known by any name here".into(),
        None => format!("known: {}", quoted_list(candidates)),
    }
}

fn folded(name: &str) -> String {
    name.to_lowercase().replace('-', "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    const EFFECTS: [&str; 6] = [
        "coulomb",
        "asym_coulomb",
        "cogging",
        "compliance",
        "backlash",
        "brush_drop",
    ];

    #[test]
    fn every_slip_of_one_letter_finds_its_name() {
        for name in EFFECTS {
            for cut in 0..name.len() {
                let mut slip = name.to_string();
                slip.remove(cut);
                assert_eq!(nearest(&slip, EFFECTS), Some(name), "{slip}");
            }
            assert_eq!(
                nearest(&name.to_uppercase().replace('_', "-"), EFFECTS),
                Some(name)
            );
        }
    }

    #[test]
    fn strangers_get_the_list() {
        assert_eq!(nearest("xyz", EFFECTS), None);
        assert_eq!(nearest("", EFFECTS), None);
        assert_eq!(did_you_mean("xyz", &["a", "b"]), "known: `a`, `b`");
        assert_eq!(did_you_mean("colomb", &EFFECTS), "did you mean `coulomb`?");
    }
}
