//! How often the diagnosis is right, over many cases.

use super::confusion::confusions;
use super::interval::Count;
use super::{Header, Outcome, SetUp};
use servoid_engine::compare::quantile;
use servoid_identify::truth::ParameterError;
use servoid_results::schema::proof::{Confusion, Spread};

/// The whole table.
#[derive(Clone, Debug, PartialEq)]
pub struct Tally {
    /// What the cases follow from.
    pub set_up: SetUp,
    /// Version of the program that proved them.
    pub version: String,
    /// Number of cases.
    pub cases: u64,
    /// Cases without a diagnosis: number and reason.
    pub failures: Vec<(u64, String)>,
    /// A name that is neither hidden nor a declared look-alike, over all cases, detectable or not.
    pub invented: Count,
    /// Held-out error above that of the linear motor, over all cases with a diagnosis.
    pub worse_than_base: Count,
    /// The cases that hide nothing, one and two effects, as far as there are any.
    pub groups: Vec<Group>,
    /// Errors of parameters that are sizes of effects named rightly, per cent.
    pub size_errors: Spread,
    /// Those of parameters that are shapes.
    pub shape_errors: Spread,
    /// What each effect was called.
    pub confusions: Vec<Confusion>,
}

/// The cases that hide so many effects.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// How many effects they hide.
    pub hidden: usize,
    /// Number of cases.
    pub cases: u64,
    /// Of these, with every hidden effect detectable. The questions are asked of these.
    pub detectable: u64,
    /// The questions, with their counts.
    pub shares: Vec<Share>,
    /// Time of the diagnosis in one thread, s.
    pub seconds: Spread,
    /// Candidates refitted.
    pub refits: Spread,
}

/// One question to a group.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Its name in JSON.
    pub name: &'static str,
    /// The question, for people.
    pub says: &'static str,
    /// How often the answer is yes.
    pub count: Count,
}

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

impl Tally {
    /// Counts the outcomes of cases of `header`.
    pub fn new(header: &Header, outcomes: &[Outcome]) -> Tally {
        let failure = |o: &Outcome| Some((o.case, o.failure.clone()?));
        let errors = |size: bool| {
            let all = outcomes.iter().flat_map(|outcome| &outcome.parameters);
            spread(
                all.filter(|error| error.size == size)
                    .map(|error: &ParameterError| error.percent),
            )
        };
        let diagnosed = outcomes.iter().filter(|o| o.failure.is_none());
        Tally {
            set_up: header.set_up.clone(),
            version: header.version.clone(),
            cases: outcomes.len() as u64,
            failures: outcomes.iter().filter_map(failure).collect(),
            invented: Count::of(outcomes, |o| !o.quite_wrong_names().is_empty()),
            worse_than_base: Count::of(diagnosed, Outcome::worse_than_base),
            groups: (0..=2)
                .filter_map(|many| Group::new(many, outcomes))
                .collect(),
            size_errors: errors(true),
            shape_errors: errors(false),
            confusions: confusions(outcomes),
        }
    }
}

impl Group {
    fn new(hidden: usize, outcomes: &[Outcome]) -> Option<Group> {
        let of = |o: &&Outcome| o.drawn.hidden.len() == hidden;
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
            .map(|&(name, says, test)| Share {
                name,
                says,
                count: Count::of(seen.iter().copied(), test),
            })
            .collect();
        if hidden == 1 {
            let right = seen.iter().copied().filter(|o| o.right_first());
            let further = Share {
                name: "spurious_after_right",
                says: "spurious further term after a right first",
                count: Count::of(right, |o| !o.wrong_names().is_empty()),
            };
            shares.insert(3, further);
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
