//! How often the diagnosis is right, over many cases.

use super::confusion::confusions;
use super::interval::Count;
use super::reliability::reliability;
use super::{Header, Laws, Outcome};
use servoid_engine::compare::quantile;
use servoid_identify::truth::ParameterError;
use servoid_results::schema::Proof;
use servoid_results::schema::proof::{Failure, Form, FormulaGroup, Group, SetUp, Share, Spread};
use std::collections::BTreeMap;

/// Name in JSON, words for people, and the test of a case.
type Question = (&'static str, &'static str, fn(&Outcome) -> bool);

/// Whether the model reaches [`COMPLETE_COUNTS`](super::judge::COMPLETE_COUNTS).
const COMPLETE: Question = ("complete", "held-out RMS <= 0.35 counts", Outcome::complete);

/// Whether the diagnosis made it worse.
const WORSE: Question = (
    "worse_than_base",
    "held-out RMS above the linear motor's",
    Outcome::worse_than_base,
);

/// Asked where nothing is hidden.
const OF_NONE: [Question; 2] = [
    ("any_name", "an effect is named", |o| !o.named.is_empty()),
    COMPLETE,
];

/// Asked where one effect is hidden.
const OF_ONE: [Question; 6] = [
    ("right_first", "right effect first", Outcome::right_first),
    (
        "right_in_set",
        "right effect in the printed set",
        Outcome::right_in_set,
    ),
    (
        "right_or_look_alike_first",
        "right effect or a declared look-alike first",
        Outcome::right_or_look_alike_first,
    ),
    ("nothing_named", "nothing named", |o| o.named.is_empty()),
    COMPLETE,
    WORSE,
];

/// Asked where two effects are hidden.
const OF_TWO: [Question; 7] = [
    ("both_named", "both named", Outcome::all_named),
    (
        "both_in_sets",
        "both named, in a set, or by a declared look-alike",
        Outcome::all_in_sets,
    ),
    ("at_least_one", "at least one named", Outcome::any_named),
    ("wrong_name", "any name that is not hidden", |o| {
        !o.wrong_names().is_empty()
    }),
    (
        "quite_wrong_name",
        "any that is no declared look-alike either",
        |o| !o.quite_wrong_names().is_empty(),
    ),
    COMPLETE,
    WORSE,
];

/// Asked where a law outside the catalogue is hidden.
const OF_FORMULA: [Question; 7] = [
    ("law_named", "a law is named", Outcome::names_law),
    (
        "right_variables",
        "with the variables of the hidden one",
        Outcome::right_variables,
    ),
    (
        "law_right_curve",
        "a law, and all named within 10 % of the hidden one",
        |o| o.names_law() && o.right_curve(),
    ),
    (
        "right_curve",
        "all named within 10 % of the hidden one",
        Outcome::right_curve,
    ),
    (
        "error_falls",
        "held-out RMS a tenth, or <= twice the encoder's",
        Outcome::error_falls,
    ),
    COMPLETE,
    WORSE,
];

/// Whether a law is named where none is hidden.
const FALSE_LAW: Question = (
    "false_law",
    "a law is named where none is hidden",
    Outcome::names_law,
);

/// Asked of the cases that hide one effect and have it named first.
const SPURIOUS: Question = (
    "spurious_after_right",
    "spurious further term after a right first",
    |o| !o.wrong_names().is_empty(),
);

/// A group's question in words.
pub(super) fn words(name: &str) -> &'static str {
    let all = OF_NONE.iter().chain(&OF_ONE).chain(&OF_TWO);
    let mut all = all.chain(&OF_FORMULA).chain([&SPURIOUS, &FALSE_LAW]);
    all.find(|(known, ..)| *known == name)
        .map_or("", |&(_, says, _)| says)
}

/// Counts the outcomes of cases of `header`; `interrupted` where the user stopped the work.
pub fn tally(header: &Header, outcomes: &[Outcome], interrupted: bool) -> Proof {
    let set_up = &header.set_up;
    let failure = |o: &Outcome| {
        o.failure.clone().map(|reason| Failure {
            case: o.case,
            reason,
        })
    };
    let errors = |size: bool| {
        let all = outcomes.iter().flat_map(|outcome| &outcome.parameters);
        spread(
            all.filter(|error| error.size == size)
                .map(|error: &ParameterError| error.percent),
        )
    };
    let diagnosed = outcomes.iter().filter(|o| o.failure.is_none());
    let catalogue = outcomes.iter().filter(|o| o.drawn.law.is_none());
    let mut shares = vec![
        Count::of(catalogue.clone(), |o| !o.quite_wrong_names().is_empty())
            .share("quite_wrong_name"),
        Count::of(diagnosed, Outcome::worse_than_base).share("worse_than_base"),
    ];
    if set_up.discover {
        let (name, _, test) = FALSE_LAW;
        shares.push(Count::of(catalogue, test).share(name));
    }
    Proof {
        schema: "servoid.prove/1".to_owned(),
        version: header.version.clone(),
        set_up: SetUp {
            seed: set_up.seed,
            hidden: set_up.hidden.name(),
            excite: set_up.excite.name(),
            effects: set_up.effects.clone(),
            discover: set_up.discover,
            laws: (set_up.laws != Laws::Own).then(|| set_up.laws.name()),
        },
        cases: outcomes.len() as u64,
        failures: outcomes.iter().filter_map(failure).collect(),
        shares,
        groups: (0..=2)
            .filter_map(|hidden| group(hidden, outcomes))
            .collect(),
        formula: formula_group(outcomes),
        size_errors_percent: errors(true),
        shape_errors_percent: errors(false),
        confusions: confusions(outcomes),
        // A law outside the catalogue is no set of its effects, so that none could be said to be right.
        reliability: reliability(
            outcomes
                .iter()
                .filter(|o| o.detectable && o.drawn.law.is_none()),
        ),
        interrupted,
    }
}

/// The cases that hide so many effects, if there are any.
fn group(hidden: usize, outcomes: &[Outcome]) -> Option<Group> {
    let of = |o: &&Outcome| o.drawn.law.is_none() && o.drawn.hidden.len() == hidden;
    let cases: Vec<&Outcome> = outcomes.iter().filter(of).collect();
    if cases.is_empty() {
        return None;
    }
    let seen: Vec<&Outcome> = cases.iter().copied().filter(|o| o.detectable).collect();
    let questions: &[Question] = match hidden {
        0 => &OF_NONE,
        1 => &OF_ONE,
        _ => &OF_TWO,
    };
    let mut shares: Vec<Share> = questions
        .iter()
        .map(|&(name, _, test)| Count::of(seen.iter().copied(), test).share(name))
        .collect();
    if hidden == 1 {
        let right = seen.iter().copied().filter(|o| o.right_first());
        let (name, _, test) = SPURIOUS;
        shares.insert(3, Count::of(right, test).share(name));
    }
    Some(Group {
        hidden,
        cases: cases.len() as u64,
        detectable: seen.len() as u64,
        shares,
        seconds: spread(seen.iter().map(|o| o.seconds)),
        refits: spread(seen.iter().map(|o| o.refits as f64)),
    })
}

/// The cases that hide a law outside the catalogue, if there are any.
fn formula_group(outcomes: &[Outcome]) -> Option<FormulaGroup> {
    let cases = outcomes.iter().filter(|o| o.drawn.law.is_some());
    let cases: Vec<&Outcome> = cases.collect();
    if cases.is_empty() {
        return None;
    }
    let seen: Vec<&Outcome> = cases.iter().copied().filter(|o| o.detectable).collect();
    let shares = OF_FORMULA.iter();
    let share = |&(name, _, test): &Question| Count::of(seen.iter().copied(), test).share(name);
    let mut forms: BTreeMap<&str, Vec<&Outcome>> = BTreeMap::new();
    for outcome in &seen {
        let form = outcome.drawn.law.as_ref().map_or("", |law| &law.form);
        forms.entry(form).or_default().push(outcome);
    }
    let form = |(form, cases): (&str, Vec<&Outcome>)| Form {
        form: form.to_owned(),
        cases: cases.len() as u64,
        law_named: cases.iter().filter(|o| o.names_law()).count() as u64,
        right_curve: cases.iter().filter(|o| o.right_curve()).count() as u64,
        departure_percent: departures(&cases),
        missed_cases: cases
            .iter()
            .filter(|o| !o.right_curve())
            .map(|o| o.case)
            .collect(),
    };
    Some(FormulaGroup {
        cases: cases.len() as u64,
        detectable: seen.len() as u64,
        shares: shares.map(share).collect(),
        departure_percent: departures(&seen),
        seconds: spread(seen.iter().map(|o| o.seconds)),
        forms: forms.into_iter().map(form).collect(),
    })
}

fn departures(outcomes: &[&Outcome]) -> Spread {
    spread(
        outcomes
            .iter()
            .filter_map(|o| o.departure())
            .map(|part| 100.0 * part),
    )
}

fn spread(values: impl Iterator<Item = f64>) -> Spread {
    let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
    sorted.sort_by(f64::total_cmp);
    let at = |q| Some(quantile(&sorted, q)).filter(|value| value.is_finite());
    Spread {
        count: sorted.len(),
        median: at(0.5),
        p90: at(0.9),
        max: at(1.0),
    }
}
