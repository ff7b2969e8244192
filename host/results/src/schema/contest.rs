//! `servoid.compare/1`, of `compare` and of `paper`.

use super::estimate::{Margins, PositionLoop};
use super::{finite, flattened};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use servoid_engine::compare;
use servoid_engine::compare::quantile;
use servoid_identify::fit::margins::Loop;
use servoid_identify::paper;
use std::collections::BTreeMap;

/// What a contest calls itself.
pub const SCHEMA: &str = "servoid.compare/1";

/// `servoid.compare/1`: search methods at an equal budget.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Contest {
    /// `servoid.compare/1`.
    #[serde(default)]
    pub schema: String,
    /// Model evaluations of each run.
    pub budget: usize,
    /// Seeds of the runs.
    pub seeds: Vec<u64>,
    /// Costs to compare with, of `paper` only.
    #[serde(flatten, deserialize_with = "flattened")]
    pub known: Option<KnownCosts>,
    /// Methods.
    pub rows: Vec<Row>,
    /// The other treatments, of `paper` only.
    #[serde(flatten, deserialize_with = "flattened")]
    pub rounds: Option<Rounds>,
}

/// Costs that the methods of the paper's contest are compared with.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct KnownCosts {
    /// Least cost that anything found.
    pub optimum_cost: Option<f64>,
    /// Cost of the true motor.
    pub truth_cost: Option<f64>,
}

/// The paper's contest under all treatments.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Rounds {
    /// All treatments of the quantiser and both steps; the first is `rows` again.
    pub variants: Vec<Variant>,
    /// Methods that need few evaluations.
    pub strong: Vec<Strong>,
}

/// One treatment of the paper's contest.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Variant {
    /// Its name.
    pub name: String,
    /// Cost of the true motor.
    pub truth_cost: Option<f64>,
    /// Methods.
    pub rows: Vec<Row>,
}

/// One method.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Row {
    /// Its name; `actual` for the paper's true motor.
    pub algorithm: String,
    /// Its runs; `actual` has none.
    #[serde(flatten, deserialize_with = "flattened")]
    pub runs: Option<Runs>,
    /// What the paper prints, of `paper` only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub paper: Option<Printed>,
}

/// The runs of one method.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Runs {
    /// Over the seeds.
    pub median_cost: Option<f64>,
    /// Of the best run.
    pub best_cost: Option<f64>,
    /// Of the worst run.
    pub worst_cost: Option<f64>,
    /// Width of the middle half.
    pub iqr_cost: Option<f64>,
    /// The middle half.
    pub quartiles_cost: Option<[f64; 2]>,
    /// Evaluations to within 1 % of the least cost that any run found.
    pub median_evaluations_to_1pct: Option<f64>,
    /// Computing time of all runs, s.
    pub wall_s: Option<f64>,
    /// Of the best run.
    pub parameters: BTreeMap<String, f64>,
    /// Of the best run's position loop.
    pub margins: Option<Margins>,
    /// Coefficients of the best run's position loop.
    #[serde(rename = "loop")]
    pub position_loop: Option<PositionLoop>,
    /// Evaluations and median best cost.
    pub curve: Vec<(usize, f64)>,
    /// Evaluations, and the quartiles of the best cost.
    pub curve_band: Vec<(usize, f64, f64)>,
}

/// A column of the paper's table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Printed {
    /// Cost, deg·s.
    pub cost: Option<f64>,
    /// The six parameters, SI.
    pub parameters: BTreeMap<String, f64>,
    /// As printed.
    pub margins_printed: Margins,
    /// From the printed parameters.
    pub margins_computed: Option<Margins>,
}

/// A method that needs few evaluations, on the paper's recording.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Strong {
    /// Its name.
    pub algorithm: String,
    /// Over the seeds.
    pub median_cost: Option<f64>,
    /// Of the worst run.
    pub worst_cost: Option<f64>,
    /// Evaluations to within 1 % of the least cost.
    pub median_evaluations_to_1pct: Option<f64>,
    /// The same of the worst run.
    pub worst_evaluations_to_1pct: Option<f64>,
}

impl Contest {
    /// Of `compare`. "To 1 %" is measured against the least cost that any run found.
    pub fn new(contest: &compare::Contest<'_>, rows: &[compare::Row]) -> Self {
        Contest {
            schema: SCHEMA.to_owned(),
            budget: contest.budget,
            seeds: contest.seeds.clone(),
            known: None,
            rows: Row::all(contest, rows, least_cost(rows)),
            rounds: None,
        }
    }

    /// Its treatments, of `paper` only.
    pub fn variants(&self) -> &[Variant] {
        self.rounds.as_ref().map_or(&[], |rounds| &rounds.variants)
    }
}

/// Least cost of all runs of all methods.
pub fn least_cost(rows: &[compare::Row]) -> f64 {
    rows.iter()
        .flat_map(|row| &row.runs)
        .fold(f64::INFINITY, |m, run| m.min(run.cost))
}

impl Row {
    /// The rows of all methods, measured against `least`, the least cost that is known.
    pub fn all(contest: &compare::Contest<'_>, rows: &[compare::Row], least: f64) -> Vec<Row> {
        let row = |row: &compare::Row| Row {
            algorithm: row.algorithm.clone(),
            runs: Some(Runs::new(contest, row, least)),
            paper: None,
        };
        rows.iter().map(row).collect()
    }
}

impl Runs {
    /// Of one method, measured against `least`, the least cost that is known.
    pub fn new(contest: &compare::Contest<'_>, row: &compare::Row, least: f64) -> Self {
        let costs = row.costs();
        let structure = &contest.problem.structure;
        // A method that found nothing has no parameters, whatever point it began from.
        let best = row.best().filter(|best| best.cost.is_finite());
        let values = best.map(|best| structure.values(&best.x));
        let names = structure
            .unknowns
            .iter()
            .map(|unknown| unknown.name.clone());
        let position_loop = values
            .as_ref()
            .map(|v| Loop::from(&structure.candidate(v).machine));
        let curve = |q: f64| row.curve(contest.budget, q).into_iter();
        let band = curve(0.25)
            .zip(curve(0.75))
            .map(|(low, high)| (low.0, low.1, high.1));
        let quartiles = [quantile(&costs, 0.25), quantile(&costs, 0.75)];
        Runs {
            median_cost: finite(quantile(&costs, 0.5)),
            best_cost: costs.first().copied().and_then(finite),
            worst_cost: costs.last().copied().and_then(finite),
            iqr_cost: finite(quartiles[1] - quartiles[0]),
            quartiles_cost: quartiles.iter().all(|q| q.is_finite()).then_some(quartiles),
            median_evaluations_to_1pct: row.median_evaluations_to(1.01 * least),
            wall_s: finite(row.wall_s),
            margins: position_loop.and_then(|l| l.margins()).map(Margins::from),
            position_loop: position_loop.map(PositionLoop::from),
            parameters: names.zip(values.unwrap_or_default()).collect(),
            curve: curve(0.5).filter(|p| p.1.is_finite()).collect(),
            curve_band: band.filter(|p| p.2.is_finite()).collect(),
        }
    }
}

impl From<&paper::Printed> for Printed {
    fn from(column: &paper::Printed) -> Self {
        let p = &column.physical;
        let parameters = [
            ("inductance", p.inductance),
            ("resistance", p.resistance),
            ("kt", p.kt),
            ("inertia", p.inertia),
            ("viscous", p.viscous),
            ("kb", p.kb),
        ];
        Printed {
            cost: column.cost,
            parameters: parameters
                .map(|(name, value)| (name.to_owned(), value))
                .into(),
            margins_printed: column.margins.into(),
            margins_computed: column.computed_margins().map(Margins::from),
        }
    }
}

impl Strong {
    /// Measured against the least cost that is known.
    pub fn new(row: &compare::Row, optimum: f64) -> Self {
        let costs = row.costs();
        let evaluations = row.evaluations_to(1.01 * optimum);
        Strong {
            algorithm: row.algorithm.clone(),
            median_cost: finite(quantile(&costs, 0.5)),
            worst_cost: finite(quantile(&costs, 1.0)),
            median_evaluations_to_1pct: finite(quantile(&evaluations, 0.5)),
            worst_evaluations_to_1pct: finite(quantile(&evaluations, 1.0)),
        }
    }
}
