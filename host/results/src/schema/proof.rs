//! `servoid.prove/1`: how often the diagnosis is right.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// `servoid.prove/1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Proof {
    /// `servoid.prove/1`.
    pub schema: String,
    /// Version of the program that proved the cases.
    pub version: String,
    /// What the cases follow from.
    pub set_up: SetUp,
    /// How many.
    pub cases: u64,
    /// The cases without a diagnosis; they count as detectable and not right.
    pub failures: Vec<Failure>,
    /// Over all cases: `quite_wrong_name` and `worse_than_base`.
    pub shares: Vec<Share>,
    /// The cases that hide nothing, one and two effects.
    pub groups: Vec<Group>,
    /// The cases that hide a law outside the catalogue; absent where there are none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<FormulaGroup>,
    /// Errors of parameters that are sizes of effects named rightly, per cent.
    pub size_errors_percent: Spread,
    /// Errors of those that are shapes, per cent.
    pub shape_errors_percent: Spread,
    /// What each hidden effect was called, worst first.
    pub confusions: Vec<Confusion>,
    /// Whether probabilities of sets of effects are as often right as they say, over the detectable cases; absent where no diagnosis
    /// has any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reliability: Option<Reliability>,
    /// Whether the user stopped the work.
    pub interrupted: bool,
}

/// What cases follow from, as on the command line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SetUp {
    /// Seed of everything random.
    pub seed: u64,
    /// How many effects a case hides: `none`, `one`, `two` or `mix`.
    pub hidden: String,
    /// How the motor is driven: `commissioning` or `mixed`.
    pub excite: String,
    /// Effects to choose from; empty for all.
    pub effects: Vec<String>,
    /// By which curves they act, where not by their own: `other` or `any`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub laws: Option<String>,
    /// Whether laws were proposed for what the catalogue leaves; absent where not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub discover: bool,
}

/// A case without a diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Failure {
    /// Its number.
    pub case: u64,
    /// Why.
    pub reason: String,
}

/// The cases that hide so many effects.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Group {
    /// How many effects they hide.
    pub hidden: usize,
    /// How many cases.
    pub cases: u64,
    /// Of these, with each hidden effect alone leaving more than one count RMS to the linear motor.
    pub detectable: u64,
    /// Over the detectable cases.
    pub shares: Vec<Share>,
    /// Time of the diagnosis in one thread, s.
    pub seconds: Spread,
    /// Candidates refitted.
    pub refits: Spread,
}

/// The cases that hide a law outside the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FormulaGroup {
    /// How many cases.
    pub cases: u64,
    /// Of these, with more than one count RMS left to the linear motor.
    pub detectable: u64,
    /// Over the detectable cases.
    pub shares: Vec<Share>,
    /// RMS of what is named less the hidden law along the held-out recording, per cent of the law.
    pub departure_percent: Spread,
    /// Time of the diagnosis in one thread, s.
    pub seconds: Spread,
    /// The forms of law, over the detectable cases.
    pub forms: Vec<Form>,
}

/// One form of law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Form {
    /// Its name on the bench.
    pub form: String,
    /// Detectable cases that hide it.
    pub cases: u64,
    /// Of these, with a law named.
    pub law_named: u64,
    /// Of these, with everything that is named within a tenth of the hidden law.
    pub right_curve: u64,
    /// As for all forms, of this one.
    pub departure_percent: Spread,
    /// Numbers of the cases in which it is not.
    pub missed_cases: Vec<u64>,
}

/// How often the answer to one question is yes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Share {
    /// The question's name.
    pub name: String,
    /// How often.
    pub count: u64,
    /// Of how many.
    pub of: u64,
    /// The rate; null of nothing.
    pub rate: Option<Rate>,
}

/// A rate with its exact interval of 95 % (Clopper and Pearson, Biometrika 26, 1934), as parts of one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Rate {
    /// The count over its total.
    pub part: f64,
    /// Lower end.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

/// Middle and upper end of many numbers; null of no numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Spread {
    /// How many.
    pub count: usize,
    /// Half are below.
    pub median: Option<f64>,
    /// Nine of ten are below.
    pub p90: Option<f64>,
    /// The largest.
    pub max: Option<f64>,
}

/// One hidden effect, over the cases in which it could be found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Confusion {
    /// The effect.
    pub effect: String,
    /// Cases that hide it alone.
    pub alone: u64,
    /// Of these, with it named first.
    pub right: u64,
    /// Of these, with it in the first printed set.
    pub in_set: u64,
    /// What it was called where it was not named first, with how often, the most frequent first.
    pub called: Vec<(String, u64)>,
    /// Cases that hide it with another.
    pub paired: u64,
    /// Of these, with it named.
    pub paired_named: u64,
    /// Numbers of the cases in which it is not named.
    pub missed_cases: Vec<u64>,
}

/// Whether stated probabilities are as often right as they say.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Reliability {
    /// Mean square of probability less truth (0 or 1), of the most probable set of each diagnosis: 0 is perfect, 0.25 says nothing.
    pub brier: f64,
    /// How many diagnoses.
    pub diagnoses: u64,
    /// All sets by their probability, where there are any.
    pub bins: Vec<Bin>,
}

/// Sets whose probability is within a range.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Bin {
    /// Least probability.
    pub low: f64,
    /// Greatest probability.
    pub high: f64,
    /// Mean probability.
    pub probability: f64,
    /// How many of them are what is hidden.
    pub right: Share,
}
