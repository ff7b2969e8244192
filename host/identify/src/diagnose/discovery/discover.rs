//! Proposed laws, tried as effects of the catalogue are.

use super::propose;
use crate::diagnose::{Budget, Diagnosis, diagnose};
use crate::error::Error;
use crate::fit::Options;
use servoid_engine::problem::Data;
use shared::effects::Kind;

/// Laws that are tried by simulation.
const MOST: usize = 3;

/// A law that was proposed, and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposed {
    /// Its text.
    pub text: String,
    /// Its name as an effect.
    pub name: String,
    /// Share of the missing volts on the held-out recording that it explains.
    pub explained: f64,
    /// Whether it was named, by the rules that every effect is named by.
    pub named: bool,
}

/// Proposes laws for what a diagnosis leaves, and diagnoses again with them beside the catalogue. The new diagnosis is given where
/// it names one of them; a law that is not confirmed by simulation changes nothing.
///
/// # Errors
/// As [`diagnose`].
pub fn discover(
    before: Diagnosis,
    data: &Data,
    held_out: &Data,
    options: &Options,
    budget: &Budget<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<(Diagnosis, Vec<Proposed>), Error> {
    let laws = propose(data, held_out, &before.last.candidate, MOST);
    let mut proposed = Vec::new();
    let mut kinds: Vec<Kind> = Vec::new();
    for law in laws {
        let name = format!("law{}", proposed.len() + 1);
        let text = law.formula(&name);
        // What no number format can compute is no proposal.
        let Ok(kind) = servoid_formula::define(&text) else {
            continue;
        };
        kinds.push(kind);
        proposed.push(Proposed {
            text,
            name,
            explained: law.explained,
            named: false,
        });
    }
    if kinds.is_empty() {
        return Ok((before, proposed));
    }
    let mut with = options.clone();
    with.candidates.extend(&kinds);
    let after = diagnose(data, held_out, &with, budget, done)?;
    for (kind, law) in kinds.iter().zip(&mut proposed) {
        law.named = after.steps.iter().any(|step| step.added == *kind);
    }
    let named = proposed.iter().any(|law| law.named);
    Ok((if named { after } else { before }, proposed))
}
