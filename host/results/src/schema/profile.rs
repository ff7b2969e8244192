//! How much worse a fit becomes as one parameter is held away from its best value.

use super::finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_identify::fit;

/// The profile likelihood of one unknown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Profile {
    /// Name, as among the parameters.
    pub name: String,
    /// Unit symbol.
    pub unit: String,
    /// Where the fit ended.
    pub best: f64,
    /// Its standard error; null where it has none.
    pub std: Option<f64>,
    /// Lower end of the 95 % interval; null where the search range ends before.
    pub low: Option<f64>,
    /// Upper end, likewise.
    pub high: Option<f64>,
    /// Values, in their order, with the rise of the deviance there: 1 at one standard error, 3.84 at the ends of the interval.
    pub points: Vec<Point>,
}

/// A point of a profile.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Point {
    /// Value of the parameter.
    pub value: f64,
    /// Rise of the deviance.
    pub deviance: f64,
}

impl From<&fit::Profile> for Profile {
    fn from(profile: &fit::Profile) -> Self {
        let [low, high] = profile.interval;
        let point = |&(value, deviance): &(f64, f64)| Point { value, deviance };
        Profile {
            name: profile.name.clone(),
            unit: profile.unit.to_owned(),
            best: profile.best,
            std: profile.std,
            low: low.and_then(finite),
            high: high.and_then(finite),
            points: profile.points.iter().map(point).collect(),
        }
    }
}
