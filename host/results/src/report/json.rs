//! JSON of `fit` and `compare`, as the README documents it. Keys are only ever added.

use crate::kept::KeptModel;
use crate::report::paper::{Round, Strong, optimum};
use serde::Serialize;
use servoid_engine::compare::{Contest, Row, quantile};
use servoid_engine::problem::Data;
use servoid_identify::fit::margins::{Loop, Margins};
use servoid_identify::fit::{Fit, Parameter};
use servoid_identify::paper::{PRINTED, Printed};
use shared::motor::Response;
use std::collections::BTreeMap;

/// Margins.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct MarginsJson {
    /// dB; null where infinite.
    pub gain_db: Option<f64>,
    /// Degrees.
    pub phase_deg: f64,
}

impl From<Margins> for MarginsJson {
    fn from(margins: Margins) -> Self {
        MarginsJson {
            gain_db: Some(margins.gain_db).filter(|db| db.is_finite()),
            phase_deg: margins.phase_deg,
        }
    }
}

/// One parameter of a fitted model.
#[derive(Debug, Serialize)]
pub(super) struct ParameterJson {
    name: String,
    value: f64,
    unit: &'static str,
    std: Option<f64>,
    identifiable: bool,
}

impl From<&Parameter> for ParameterJson {
    fn from(p: &Parameter) -> Self {
        ParameterJson {
            name: p.name.clone(),
            value: p.value,
            unit: p.unit,
            std: p.std,
            identifiable: p.identifiable,
        }
    }
}

/// What voltage and angle determine.
#[derive(Debug, Serialize)]
pub(super) struct IdentifiableJson {
    gain_rad_s_v: Option<f64>,
    a1_s: Option<f64>,
    a2_s2: Option<f64>,
}

impl From<Response<f64>> for IdentifiableJson {
    fn from(response: Response<f64>) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        IdentifiableJson {
            gain_rad_s_v: finite(response.gain),
            a1_s: finite(response.a1),
            a2_s2: finite(response.a2),
        }
    }
}

#[derive(Debug, Serialize)]
struct WindowedJson {
    window_s: f64,
    rms_counts: f64,
    relative: f64,
}

/// `servoid.fit/1`.
#[derive(Debug, Serialize)]
pub struct FitJson {
    schema: &'static str,
    algorithm: String,
    seed: u64,
    evaluations: usize,
    cost: f64,
    cost_kind: &'static str,
    rms_counts: f64,
    validate_rms_counts: Option<f64>,
    quantization_floor_counts: f64,
    windowed: Option<WindowedJson>,
    equation_error_relative: Option<f64>,
    effects: Vec<&'static str>,
    parameters: Vec<ParameterJson>,
    identifiable: IdentifiableJson,
    margins: Option<MarginsJson>,
    converged: bool,
    effective_samples: f64,
    notes: Vec<String>,
    ladder: Vec<RungJson>,
    model: KeptModel,
    recording: String,
    validate: Option<String>,
    drive: &'static str,
    supply_v: f64,
    counts_per_rev: f64,
    sample_s: f64,
    interrupted: bool,
    version: &'static str,
}

#[derive(Debug, Serialize)]
struct RungJson {
    added: Option<&'static str>,
    rms_counts: Option<f64>,
    validate_rms_counts: Option<f64>,
}

impl FitJson {
    /// From a fit of `data`, judged also on the recording called `validate`.
    pub fn new(fit: &Fit, data: &Data, validate: Option<&str>) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        FitJson {
            schema: "servoid.fit/1",
            algorithm: fit.algorithm.clone(),
            seed: fit.seed,
            evaluations: fit.evaluations,
            cost: fit.cost,
            cost_kind: fit.cost_kind,
            rms_counts: fit.rms_counts,
            validate_rms_counts: fit.validate_rms_counts,
            quantization_floor_counts: shared::encoder::FLOOR_RMS_COUNTS,
            windowed: fit.windowed.map(|w| WindowedJson {
                window_s: w.window_s,
                rms_counts: w.rms_counts,
                relative: w.relative,
            }),
            equation_error_relative: fit.equation_error,
            effects: fit.effects.clone(),
            parameters: fit.parameters.iter().map(ParameterJson::from).collect(),
            identifiable: fit.response.into(),
            margins: fit.margins.map(MarginsJson::from),
            converged: fit.converged,
            effective_samples: fit.effective_samples,
            notes: fit.notes.clone(),
            ladder: (fit.error_ladder.iter())
                .map(|rung| RungJson {
                    added: rung.added,
                    rms_counts: finite(rung.rms_counts),
                    validate_rms_counts: rung.validate_rms_counts.and_then(finite),
                })
                .collect(),
            model: KeptModel::of(&fit.candidate, fit.method),
            recording: data.source.clone(),
            validate: validate.map(str::to_owned),
            drive: data.drive.name(),
            supply_v: data.supply,
            counts_per_rev: data.units.counts_per_rev,
            sample_s: data.units.interval,
            interrupted: fit.interrupted,
            version: env!("CARGO_PKG_VERSION"),
        }
    }
}

/// `servoid.compare/1`.
#[derive(Debug, Serialize)]
pub struct CompareJson {
    schema: &'static str,
    budget: usize,
    seeds: Vec<u64>,
    rows: Vec<CompareRowJson>,
}

/// One method.
#[derive(Debug, Serialize)]
pub struct CompareRowJson {
    algorithm: String,
    median_cost: Option<f64>,
    best_cost: Option<f64>,
    worst_cost: Option<f64>,
    /// Width of the middle half.
    iqr_cost: Option<f64>,
    quartiles_cost: Option<[f64; 2]>,
    median_evaluations_to_1pct: Option<f64>,
    wall_s: f64,
    /// Of the best run.
    parameters: BTreeMap<String, f64>,
    margins: Option<MarginsJson>,
    /// Of the best run.
    #[serde(rename = "loop")]
    position_loop: Option<LoopJson>,
    curve: Vec<(usize, f64)>,
    /// The quartiles beside it.
    curve_band: Vec<(usize, f64, f64)>,
}

#[derive(Debug, Serialize)]
struct LoopJson {
    a3: f64,
    a2: f64,
    a1: f64,
}

impl From<Loop> for LoopJson {
    fn from(Loop { a3, a2, a1 }: Loop) -> Self {
        LoopJson { a3, a2, a1 }
    }
}

impl CompareJson {
    /// From the rows of a contest. "To 1 %" is measured against the least cost that any run found.
    pub fn new(contest: &Contest<'_>, rows: &[Row]) -> Self {
        let least = least_cost(rows);
        CompareJson {
            schema: "servoid.compare/1",
            budget: contest.budget,
            seeds: contest.seeds.clone(),
            rows: rows
                .iter()
                .map(|row| CompareRowJson::new(contest, row, least))
                .collect(),
        }
    }
}

/// Least cost of all runs of all methods.
pub fn least_cost(rows: &[Row]) -> f64 {
    rows.iter()
        .flat_map(|row| &row.runs)
        .fold(f64::INFINITY, |m, run| m.min(run.cost))
}

impl CompareRowJson {
    /// One method's row, measured against `least`, the least cost that is known.
    pub fn new(contest: &Contest<'_>, row: &Row, least: f64) -> Self {
        let costs = row.costs();
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
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
        CompareRowJson {
            algorithm: row.algorithm.clone(),
            median_cost: finite(quantile(&costs, 0.5)),
            best_cost: costs.first().copied().and_then(finite),
            worst_cost: costs.last().copied().and_then(finite),
            iqr_cost: finite(quartiles[1] - quartiles[0]),
            quartiles_cost: quartiles.iter().all(|q| q.is_finite()).then_some(quartiles),
            median_evaluations_to_1pct: row.median_evaluations_to(1.01 * least),
            wall_s: row.wall_s,
            margins: position_loop
                .and_then(|l| l.margins())
                .map(MarginsJson::from),
            position_loop: position_loop.map(LoopJson::from),
            parameters: names.zip(values.unwrap_or_default()).collect(),
            curve: curve(0.5).filter(|p| p.1.is_finite()).collect(),
            curve_band: band.filter(|p| p.2.is_finite()).collect(),
        }
    }
}

/// `servoid.compare/1` with the paper's columns.
#[derive(Debug, Serialize)]
pub struct PaperJson {
    schema: &'static str,
    budget: usize,
    seeds: Vec<u64>,
    optimum_cost: Option<f64>,
    truth_cost: Option<f64>,
    rows: Vec<PaperRowJson>,
    /// All treatments of the quantiser and both steps; the first is `rows` again.
    variants: Vec<VariantJson>,
    strong: Vec<StrongJson>,
}

#[derive(Debug, Serialize)]
struct PaperRowJson {
    algorithm: String,
    #[serde(flatten)]
    ours: Option<CompareRowJson>,
    paper: PaperColumnJson,
}

#[derive(Debug, Serialize)]
struct PaperColumnJson {
    cost: Option<f64>,
    parameters: BTreeMap<&'static str, f64>,
    margins_printed: MarginsJson,
    margins_computed: Option<MarginsJson>,
}

#[derive(Debug, Serialize)]
struct VariantJson {
    name: String,
    truth_cost: Option<f64>,
    rows: Vec<CompareRowJson>,
}

#[derive(Debug, Serialize)]
struct StrongJson {
    algorithm: String,
    median_cost: Option<f64>,
    worst_cost: Option<f64>,
    median_evaluations_to_1pct: Option<f64>,
    worst_evaluations_to_1pct: Option<f64>,
}

impl PaperJson {
    /// From the rounds of the paper's contest.
    pub fn new(rounds: &[Round<'_>], strong: &Strong) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let optimum = optimum(rounds, strong);
        let row = |round: &Round<'_>, name: &str, least: f64| {
            let row = round.rows.iter().find(|row| row.algorithm == name)?;
            Some(CompareRowJson::new(round.contest, row, least))
        };
        let rows = PRINTED
            .iter()
            .map(|column| PaperRowJson {
                algorithm: column.algorithm.to_owned(),
                ours: rounds
                    .first()
                    .and_then(|round| row(round, column.algorithm, optimum)),
                paper: PaperColumnJson::from(column),
            })
            .collect();
        let variants = rounds
            .iter()
            .map(|round| {
                let least = least_cost(&round.rows);
                VariantJson {
                    name: round.variant.name(),
                    truth_cost: finite(round.truth_cost),
                    rows: round
                        .rows
                        .iter()
                        .map(|r| CompareRowJson::new(round.contest, r, least))
                        .collect(),
                }
            })
            .collect();
        PaperJson {
            schema: "servoid.compare/1",
            budget: rounds.first().map_or(0, |round| round.contest.budget),
            seeds: rounds
                .first()
                .map_or(Vec::new(), |round| round.contest.seeds.clone()),
            optimum_cost: finite(optimum),
            truth_cost: rounds.first().and_then(|round| finite(round.truth_cost)),
            rows,
            variants,
            strong: strong
                .rows
                .iter()
                .map(|row| StrongJson::new(row, optimum))
                .collect(),
        }
    }
}

impl From<&Printed> for PaperColumnJson {
    fn from(column: &Printed) -> Self {
        let p = &column.physical;
        PaperColumnJson {
            cost: column.cost,
            parameters: BTreeMap::from([
                ("inductance", p.inductance),
                ("resistance", p.resistance),
                ("kt", p.kt),
                ("inertia", p.inertia),
                ("viscous", p.viscous),
                ("kb", p.kb),
            ]),
            margins_printed: column.margins.into(),
            margins_computed: column.computed_margins().map(MarginsJson::from),
        }
    }
}

impl StrongJson {
    fn new(row: &Row, optimum: f64) -> Self {
        let finite = |x: f64| Some(x).filter(|x| x.is_finite());
        let costs = row.costs();
        let evaluations = row.evaluations_to(1.01 * optimum);
        StrongJson {
            algorithm: row.algorithm.clone(),
            median_cost: finite(quantile(&costs, 0.5)),
            worst_cost: finite(quantile(&costs, 1.0)),
            median_evaluations_to_1pct: finite(quantile(&evaluations, 0.5)),
            worst_evaluations_to_1pct: finite(quantile(&evaluations, 1.0)),
        }
    }
}
