//! Proposed laws, tried as effects of the catalogue are.

use super::{Law, propose};
use crate::diagnose::{self, Budget, Diagnosis, Errors, FittedModel, Verdict};
use crate::error::Error;
use crate::fit::Options;
use servoid_engine::problem::{Candidate, Data};
use shared::effects::{Kind, MAX_PARAMETERS};

/// Effects that together are suspected to stand in for a law.
const STAND_INS: usize = 3;
/// Logarithms of both errors' product: what counts as more, and what as equal.
const GAIN: f64 = 0.2;
const TIE: f64 = 0.05;
/// Effects of each step that stand against laws.
const NEAREST: usize = 4;
/// Share of what is missing beyond which a law leaves nothing to other laws of one term.
const ALL: f64 = 0.99;
/// What it leaves at most, in the least that one of one term leaves.
const NEAR_LEAST: f64 = 2.0;
/// Part of what such a law leaves that one of two terms leaves at most.
const REST: f64 = 0.2;
/// What nearly every motor has.
const USUAL: [Kind; 2] = [Kind::Coulomb, Kind::OffsetVoltage];

/// A law that was proposed, and what became of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Proposed {
    /// Its text.
    pub text: String,
    /// Its name as an effect.
    pub name: String,
    /// Share of the missing volts on the held-out recording that it explains.
    pub explained: f64,
    /// The effect of the catalogue that is most like it, with the square of their correlation along the fitted recording.
    pub resembles: Option<(Kind, f64)>,
    /// Whether it was named, by the rules that every effect is named by.
    pub named: bool,
}

/// Diagnoses; where the catalogue leaves something and the options ask for it, laws are proposed for that, and the recordings
/// are diagnosed again with them beside the effects that came nearest. A law that simulation does not confirm is not named.
///
/// Returns the diagnosis and the laws, `None` where they were not looked for.
///
/// # Errors
/// As [`diagnose::search_catalogue`].
pub fn search_with_laws(
    data: &Data,
    held_out: &Data,
    options: &Options,
    budget: &Budget<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<(Diagnosis, Option<Vec<Proposed>>), Error> {
    for data in [data, held_out] {
        data.check_told(options.candidates.iter().chain(&options.effects).copied())?;
    }
    let diagnosis = diagnose::search_catalogue(data, held_out, options, budget, done)?;
    if !options.discover || !leaves_something(&diagnosis) {
        return Ok((diagnosis, None));
    }
    let again = budget.again();
    let (diagnosis, laws) = discover(diagnosis, data, held_out, options, &again, done)?;
    Ok((diagnosis, Some(laws)))
}

fn discover(
    before: Diagnosis,
    data: &Data,
    held_out: &Data,
    options: &Options,
    budget: &Budget<'_>,
    done: &(dyn Fn() + Sync),
) -> Result<(Diagnosis, Vec<Proposed>), Error> {
    let mut proposed: Vec<Proposed> = Vec::new();
    let mut kinds: Vec<Kind> = Vec::new();
    for law in laws(&before, data, held_out) {
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
            resembles: law.resembles,
            named: false,
        });
    }
    if kinds.is_empty() {
        return Ok((before, proposed));
    }
    let mut with = options.clone();
    with.candidates.extend(&kinds);
    with.catalogue = contenders(&before);
    let after = diagnose::search_catalogue(data, held_out, &with, budget, done)?;
    for (kind, law) in kinds.iter().zip(&mut proposed) {
        law.named = after.steps.iter().any(|step| step.added == *kind);
    }
    // Laws may lead to effects of the catalogue that say the same, and were not found without them.
    if is_better(&after, &before) {
        return Ok((after, proposed));
    }
    proposed.iter_mut().for_each(|law| law.named = false);
    Ok((before, proposed))
}

/// Whether the catalogue leaves something: an error that the encoder does not explain, or one that so many effects were needed for that
/// they may stand in for a law.
fn leaves_something(diagnosis: &Diagnosis) -> bool {
    let at_floor = diagnosis.last.free().at_floor();
    let stand_ins = diagnosis.steps.len() >= STAND_INS;
    diagnosis.verdict == Verdict::Unexplained
        || (!diagnosis.steps.is_empty() && (stand_ins || !at_floor))
}

/// Whether a diagnosis with laws explains more than the one without, or as much with fewer numbers: by the errors that models are
/// judged by, and no worse over whole runs.
fn is_better(after: &Diagnosis, before: &Diagnosis) -> bool {
    let gain = |errors: fn(&FittedModel) -> Errors| {
        errors(&before.last).score() - errors(&after.last).score()
    };
    let (judged, free) = (gain(FittedModel::judged), gain(FittedModel::free));
    let as_good = judged > -TIE && free > -TIE;
    let fewer = after.last.freedom() < before.last.freedom();
    as_good && (judged > GAIN || free > GAIN || fewer)
}

/// The effects that came nearest without laws: all others of the catalogue were tried, and gave less.
fn contenders(before: &Diagnosis) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = Vec::new();
    let mut add = |kind: Kind| {
        // Laws of the user's own stand among the candidates.
        if Kind::ALL.contains(&kind) && !kinds.contains(&kind) {
            kinds.push(kind);
        }
    };
    for step in &before.steps {
        add(step.added);
        step.indistinguishable_from
            .iter()
            .for_each(|kind| add(*kind));
        let nearest = step.candidates.iter().take(NEAREST);
        nearest
            .filter_map(|model| model.effects.last())
            .for_each(|kind| add(*kind));
    }
    before.not_named.into_iter().for_each(&mut add);
    let sets = before.hypotheses.iter().flat_map(|set| &set.effects);
    sets.for_each(|kind| add(*kind));
    USUAL.into_iter().for_each(add);
    kinds
}

/// Laws for what the linear motor lacks, for what it lacks beside the friction and the offset that nearly every motor has, and for what
/// the named effects leave: an effect that stands in for a law takes a part of it. Of those that differ by their numbers alone the first:
/// the fit finds its own.
fn laws(before: &Diagnosis, data: &Data, held_out: &Data) -> Vec<Law> {
    let linear = before.base.candidate;
    let mut models = vec![beside_usual(linear), linear];
    if !before.steps.is_empty() {
        models.push(before.last.candidate);
    }
    let mut laws: Vec<Law> = Vec::new();
    for law in models
        .iter()
        .flat_map(|model| propose(data, held_out, model))
    {
        if !law.is_in_the_catalogue() && !laws.iter().any(|other| other.is_alike(&law)) {
            laws.push(law);
        }
    }
    keep_simplest(&mut laws);
    // What is lost of the current, in the winding or on its way to the shaft, is told apart by simulation.
    let best = |terms: usize| {
        let laws = laws.iter().filter(|law| law.terms.len() == terms);
        laws.max_by(|a, b| a.explained.total_cmp(&b.explained))
    };
    let drops: Vec<Law> = [1, 2]
        .into_iter()
        .filter_map(|n| best(n)?.as_drop())
        .collect();
    laws.extend(drops);
    laws
}

/// Beside a law of one term that explains all, others could only say the same, or a part of it, but for one that explains the rest. What
/// is little beside a poor model may be explained by a law that leaves much: such a one is not meant.
pub(super) fn keep_simplest(laws: &mut Vec<Law>) {
    let of_one_term = |law: &&Law| law.terms.len() == 1;
    let least = laws.iter().filter(of_one_term).map(|law| law.left);
    let most = NEAR_LEAST * least.fold(f64::INFINITY, f64::min);
    let explains_all = |law: &&Law| of_one_term(law) && law.explained > ALL && law.left <= most;
    let explained = laws.iter().filter(explains_all).map(|law| law.explained);
    if let Some(explained) = explained.max_by(f64::total_cmp) {
        let explains_the_rest = |law: &Law| 1.0 - law.explained < REST * (1.0 - explained);
        laws.retain(|law| explains_all(&law) || explains_the_rest(law));
    }
}

/// A candidate with the usual effects, of no size: the regression finds theirs, as it is linear in them.
pub(super) fn beside_usual(mut candidate: Candidate) -> Candidate {
    for kind in USUAL {
        let nothing = [0.0; MAX_PARAMETERS];
        // Beside a linear motor there is room.
        let _ = candidate
            .effects
            .push(kind, &nothing[..kind.parameters().len()]);
    }
    candidate
}
