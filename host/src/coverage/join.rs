//! The joint table of several machines' shards.

use super::tally::spread;
use crate::error::Error;
use servoid_results::schema::coverage::{Condition, Coverage, Covered};
use std::path::{Path, PathBuf};

/// The files that `prove --coverage --json` wrote, as one.
///
/// # Errors
/// A file that cannot be read or is no coverage, and parts that are not of the same plan.
pub fn join(paths: &[PathBuf]) -> Result<Coverage, Error> {
    let mut joint: Option<Coverage> = None;
    for path in paths {
        let part = read(path)?;
        joint = Some(match joint {
            None => part,
            Some(joint) => joined(joint, part)
                .map_err(|what| Error::Usage(format!("--merge {}: {what}", path.display())))?,
        });
    }
    joint.ok_or_else(|| Error::Usage("--merge: name the files".to_owned()))
}

fn read(path: &Path) -> Result<Coverage, Error> {
    let failed = |what: &dyn std::fmt::Display| {
        Error::Failed(format!(
            "{}: {what}; a part is what `servoid prove --coverage --json FILE` wrote",
            path.display()
        ))
    };
    let text = std::fs::read_to_string(path).map_err(|error| failed(&error))?;
    serde_json::from_str(&text).map_err(|error| failed(&error))
}

fn joined(one: Coverage, other: Coverage) -> Result<Coverage, String> {
    let differ = |what: &str| Err(format!("is of another {what} than the files before it"));
    if one.seed != other.seed {
        return differ("seed");
    }
    if one.version != other.version {
        return differ("version of servoid");
    }
    if one.conditions.len() != other.conditions.len() {
        return differ("plan");
    }
    let pairs = one.conditions.into_iter().zip(other.conditions);
    let conditions: Option<Vec<Condition>> = pairs.map(|(a, b)| condition(a, b)).collect();
    let Some(conditions) = conditions else {
        return differ("plan");
    };
    Ok(Coverage {
        recordings: one.recordings + other.recordings,
        failures: one.failures + other.failures,
        interrupted: one.interrupted || other.interrupted,
        conditions,
        ..other
    })
}

/// `None` where they are not the same one.
fn condition(one: Condition, other: Condition) -> Option<Condition> {
    let bare = |condition: &Condition| Condition {
        parameters: Vec::new(),
        ..condition.clone()
    };
    if bare(&one) != bare(&other) {
        return None;
    }
    // A part in which no recording was fitted has no parameters.
    if one.parameters.is_empty() || other.parameters.is_empty() {
        return Some(if one.parameters.is_empty() {
            other
        } else {
            one
        });
    }
    let pairs = one.parameters.into_iter().zip(other.parameters);
    let parameters = pairs.map(|(a, b)| {
        (a.name == b.name).then(|| {
            let Covered { name, mut z, .. } = a;
            z.extend(b.z);
            spread(name, z, a.not_stated + b.not_stated)
        })
    });
    Some(Condition {
        parameters: parameters.collect::<Option<_>>()?,
        ..other
    })
}
